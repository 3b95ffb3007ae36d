"""Every sample of a compiled move, checked as a step from the last one.

A reference may be taken over exactly when a legal step ends on it. Three equal spans of constant jerk have just the
freedom to connect any two states, so they are solved for in closed form: when their jerks, and the velocity and
acceleration between them, are within the limits, the step is legal by construction and the stream equals the move bit
for bit. Ruckig is asked only when they are not (it may still find one, with jerk at its limit), because its position
interface costs eight times as much.

A reference out of reach is met further on, by rendezvous. Aiming at where it is now would lag, and oscillate about it;
in the frame that moves along with it, it stands still, and one plan to rest there is the fastest way to meet it.
"""

from __future__ import annotations

from ruckig import Trajectory

from teleop.motion import Follow, State
from teleop.planner.drive import ROUNDING, Drive
from teleop.planner.solver import PositionSolver
from teleop.planner.stop import inevitable_velocity

NEAR = 20  # ticks within which a reference is expected to keep its acceleration
CATCHABLE = 0.999  # share of V: a faster reference is chased at V


def step_is_legal(start: State, end: State, seconds: float, velocity: float, acceleration: float, jerk: float) -> bool:
    """Whether three equal spans of constant jerk lead from `start` to `end` within the magnitudes given."""
    p_0, v_0, a_0 = start
    p_1, v_1, a_1 = end
    span = seconds / 3
    x = (a_1 - a_0) / span
    y = 2 * (v_1 - v_0 - a_0 * seconds) / (span * span) - x
    z = 6 * (p_1 - p_0 - seconds * (v_0 + a_0 * seconds / 2)) / (span * span * span) - x
    jerk_1 = z / 6 - y / 2
    jerk_2 = y / 2 - 2 * jerk_1
    jerk_3 = x - jerk_1 - jerk_2
    limit = jerk * (1 + ROUNDING)
    if not (-limit <= jerk_1 <= limit and -limit <= jerk_2 <= limit and -limit <= jerk_3 <= limit):
        return False
    a_13, a_23 = a_0 + jerk_1 * span, a_1 - jerk_3 * span  # after a third and two thirds
    limit = acceleration * (1 + ROUNDING)
    if not (-limit <= a_13 <= limit and -limit <= a_23 <= limit and -limit <= a_1 <= limit):
        return False
    limit = velocity * (1 + ROUNDING)
    if not ((a_0 >= 0 <= a_13 and a_23 >= 0 <= a_1) or (a_0 <= 0 >= a_13 and a_23 <= 0 >= a_1)):
        limit -= acceleration * seconds  # the velocity may peak in between
    return -limit <= v_0 <= limit and -limit <= v_1 <= limit


class Tracker:
    """Takes the axes along their references."""

    def __init__(self) -> None:
        self._solver = PositionSolver()

    def step(self, drive: Drive, wish: Follow, seconds: float) -> State | None:
        """The legal state after `seconds`: the reference itself where a step ends on it, else on the way to it.

        None when no way is found.
        """
        goal = State._make(wish)
        if self._reaches(drive, goal, seconds):
            return goal
        state = self._rendezvous(drive, goal, seconds)
        return None if state is None or drive.trips(state) else state

    def _reaches(self, drive: Drive, goal: State, seconds: float) -> bool:
        acceleration, jerk = drive.guard
        limit = drive.limits.velocity * (1 + ROUNDING)
        position, velocity, rate = goal
        if abs(velocity) + rate * rate / (2 * jerk) > limit or abs(rate) > acceleration:
            return False  # the velocity before or after, when acceleration is 0, would be too high
        if not drive.clear_low < position < drive.clear_high and drive.trips(goal) and not self._turns(drive, goal):
            return False
        if step_is_legal(drive.state, goal, seconds, drive.velocity, acceleration, jerk):
            return True
        answer = self._solve(drive, goal, seconds)
        return answer is not None and answer.duration <= seconds * (1 + ROUNDING)

    @staticmethod
    def _turns(drive: Drive, goal: State) -> bool:
        return not drive.outside and drive.turns_inside(goal)

    def _rendezvous(self, drive: Drive, goal: State, seconds: float) -> State | None:
        """Towards where the reference will be: with its acceleration when near, with its velocity when far."""
        fastest = drive.limits.velocity
        acceleration, jerk = drive.guard
        spare = fastest - acceleration * seconds  # an accelerating frame does not know V: stay well below it
        if max(abs(goal.velocity), abs(drive.state.velocity)) < spare and abs(goal.acceleration) < acceleration:
            state, duration = self._meet(drive, goal, seconds)
            if state is not None and duration <= NEAR * seconds:
                later = inevitable_velocity(state.velocity, state.acceleration, jerk)
                if abs(later) <= fastest:
                    return state
        speed = min(max(goal.velocity, -CATCHABLE * fastest), CATCHABLE * fastest)
        state, duration = self._meet(drive, State(goal.position, speed), seconds)
        low, high = drive.limits.minimum, drive.limits.maximum
        if low <= goal.position <= high and low <= goal.position + speed * (duration - seconds) <= high:
            return state
        return self._wait(drive, min(max(goal.position + speed * (duration - seconds), low), high), seconds)

    def _meet(self, drive: Drive, goal: State, seconds: float) -> tuple[State | None, float]:
        """The next state on the fastest way to come to rest relative to the reference, and how long that takes.

        In the frame that moves with it the reference stands still, and the limits are shifted.
        """
        position, velocity, acceleration = drive.state
        speed = goal.velocity - goal.acceleration * seconds
        relative = State(
            position - goal.position + seconds * (goal.velocity - goal.acceleration * seconds / 2),
            velocity - speed,
            acceleration - goal.acceleration,
        )
        answer = self._solver.solve(
            [relative],
            [State(0.0)],
            [drive.velocity - speed],
            [drive.guard[0] - goal.acceleration],
            [drive.guard[1]],
            lowest_velocity=[-drive.velocity - speed],
            lowest_acceleration=[-drive.guard[0] - goal.acceleration],
        )
        if answer is None:
            return None, 0.0
        (p,), (v,), (a,) = answer.at_time(seconds)
        return State(goal.position + p, goal.velocity + v, goal.acceleration + a), answer.duration

    def _wait(self, drive: Drive, position: float, seconds: float) -> State | None:
        """Towards rest at `position`, for a reference that is or goes beyond it."""
        if drive.state == State(position):
            return drive.state
        answer = self._solve(drive, State(position), None)
        if answer is None:
            return None
        if answer.duration <= seconds:
            return State(position)
        (p,), (v,), (a,) = answer.at_time(seconds)
        return State(p, v, a)

    def _solve(self, drive: Drive, goal: State, seconds: float | None) -> Trajectory | None:
        acceleration, jerk = drive.guard
        return self._solver.solve(
            [drive.state], [goal], [drive.velocity], [acceleration], [jerk], minimum_duration=seconds
        )

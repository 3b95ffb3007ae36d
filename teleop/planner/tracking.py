"""Take each axis along its reference: every sample of a compiled move is checked as a step from the last one.

A reference may be taken over exactly when a legal step ends on it. Three equal spans of constant jerk have just the
freedom to connect any two states, so they are solved for in closed form: when their jerks, and the velocity and
acceleration between them, are within the limits, the step is legal by construction and the stream equals the move bit
for bit. Ruckig is asked only when they are not (it may still find one, with jerk at its limit), because its position
interface costs eight times as much.

A reference out of reach is met further on, by rendezvous. Aiming at where it is now would lag, and oscillate about it;
in the frame that moves along with it, it rests, and one plan to rest there is the fastest way to meet it.
"""

from __future__ import annotations

from ruckig import Trajectory

from teleop.core.axes import State
from teleop.core.guard_stop import inevitable_velocity
from teleop.core.setpoints import StateTarget
from teleop.planner.axis_planner import ROUNDED, AxisPlanner
from teleop.planner.ruckig_solver import PositionSolver, new_state

NEAR = 20  # ticks within which a reference is expected to keep its acceleration
CATCHABLE = 0.999  # share of V: a faster reference is chased at V


def step_is_legal(start: State, end: State, seconds: float, bounds: tuple[float, float, float]) -> bool:
    """Whether three equal spans of constant jerk lead from `start` to `end` within `bounds`, exactly.

    `bounds` are the magnitudes of velocity, acceleration and jerk. The jerks are reckoned times the square of a span.
    """
    p_0, v_0, a_0 = start
    p_1, v_1, a_1 = end
    velocity, acceleration, jerk = bounds
    span = seconds / 3
    gained = a_0 * seconds
    x = (a_1 - a_0) * span
    y = v_1 - v_0 - gained
    z = (p_1 - p_0) / span - 3 * v_0 - 1.5 * gained
    jerk_1 = z - y + x / 3
    jerk_3 = z - 2 * y + x * (11 / 6)
    most = jerk * span * span
    if not (-most <= jerk_1 <= most and -most <= x - jerk_1 - jerk_3 <= most and -most <= jerk_3 <= most):
        return False
    a_13, a_23 = a_0 + jerk_1 / span, a_1 - jerk_3 / span  # after a third and two thirds
    lowest = -acceleration
    if not (lowest <= a_13 <= acceleration and lowest <= a_23 <= acceleration and lowest <= a_1 <= acceleration):
        return False
    clear = velocity - acceleration * seconds  # from where it cannot pass its limit in between
    if -clear <= v_0 <= clear and -clear <= v_1 <= clear:
        return True
    steady = (a_0 >= 0 <= a_13 and a_23 >= 0 <= a_1) or (a_0 <= 0 >= a_13 and a_23 <= 0 >= a_1)
    return steady and -velocity <= v_0 <= velocity and -velocity <= v_1 <= velocity


class Tracker:
    """Takes the axes along their references."""

    def __init__(self) -> None:
        self._solver = PositionSolver()

    def step(self, planner: AxisPlanner, setpoint: StateTarget, seconds: float) -> State | None:
        """The legal state after `seconds`: the reference itself where a step ends on it, else on the way to it.

        None when no way is found.
        """
        goal = new_state(State, setpoint)
        position, velocity, rate = setpoint
        highest, jerk = planner.guard
        # The velocity before or after, when the acceleration is 0, is higher still.
        fastest = planner.fastest * ROUNDED - rate * rate / (2 * jerk)
        if -fastest <= velocity <= fastest and (
            planner.clear_low < position < planner.clear_high
            or not planner.trips(goal)
            or (not planner.outside and planner.turns_inside(goal))
        ):
            if step_is_legal(planner.state, goal, seconds, planner.bounds):
                return goal
            answer = self._solve(planner, goal, seconds)
            if answer is not None and answer.duration <= seconds * ROUNDED and -highest <= rate <= highest:
                return goal
        state = self._rendezvous(planner, goal, seconds)
        return None if state is None or planner.trips(state) else state

    def _rendezvous(self, planner: AxisPlanner, goal: State, seconds: float) -> State | None:
        """Towards where the reference will be: with its acceleration when near, with its velocity when far."""
        fastest = planner.limits.velocity
        acceleration, jerk = planner.guard
        spare = fastest - acceleration * seconds  # an accelerating frame does not know V: stay well below it
        if max(abs(goal.velocity), abs(planner.state.velocity)) < spare and abs(goal.acceleration) < acceleration:
            state, duration = self._meet(planner, goal, seconds)
            if state is not None and duration <= NEAR * seconds:
                later = inevitable_velocity(state.velocity, state.acceleration, jerk)
                if abs(later) <= fastest:
                    return state
        speed = min(max(goal.velocity, -CATCHABLE * fastest), CATCHABLE * fastest)
        state, duration = self._meet(planner, State(goal.position, speed), seconds)
        low, high = planner.limits.minimum, planner.limits.maximum
        if low <= goal.position <= high and low <= goal.position + speed * (duration - seconds) <= high:
            return state
        return self._wait(planner, min(max(goal.position + speed * (duration - seconds), low), high), seconds)

    def _meet(self, planner: AxisPlanner, goal: State, seconds: float) -> tuple[State | None, float]:
        """The next state on the fastest way to come to rest relative to the reference, and how long that takes.

        In the frame that moves with it the reference rests, and the limits are shifted.
        """
        position, velocity, acceleration = planner.state
        speed = goal.velocity - goal.acceleration * seconds
        relative = State(
            position - goal.position + seconds * (goal.velocity - goal.acceleration * seconds / 2),
            velocity - speed,
            acceleration - goal.acceleration,
        )
        answer = self._solver.solve(
            [relative],
            [State(0.0)],
            [planner.velocity - speed],
            [planner.guard[0] - goal.acceleration],
            [planner.guard[1]],
            lowest_velocity=[-planner.velocity - speed],
            lowest_acceleration=[-planner.guard[0] - goal.acceleration],
        )
        if answer is None:
            return None, 0.0
        (p,), (v,), (a,) = answer.at_time(seconds)
        return State(goal.position + p, goal.velocity + v, goal.acceleration + a), answer.duration

    def _wait(self, planner: AxisPlanner, position: float, seconds: float) -> State | None:
        """Towards rest at `position`, for a reference that is or goes beyond it."""
        if planner.state == State(position):
            return planner.state
        answer = self._solve(planner, State(position), None)
        if answer is None:
            return None
        if answer.duration <= seconds:
            return State(position)
        (p,), (v,), (a,) = answer.at_time(seconds)
        return State(p, v, a)

    def _solve(self, planner: AxisPlanner, goal: State, seconds: float | None) -> Trajectory | None:
        acceleration, jerk = planner.guard
        return self._solver.solve(
            [planner.state], [goal], [planner.velocity], [acceleration], [jerk], minimum_duration=seconds
        )

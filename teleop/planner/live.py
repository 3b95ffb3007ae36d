"""From demands to the next tick's motion, legal whatever is asked and whenever it changes.

Each axis tries a short ladder of plans, and the first whose next state can still be stopped inside the soft limits
wins (planning.md, section A): for a stick, Ruckig's velocity interface under the operator's limits, then its position
interface exactly onto the soft limit, then the guard stop. A preset and a compiled move have ladders of their own,
which end in the same guard stop. Since every committed state can be stopped, the guard stop is legal by induction, and
since a plan is only ever a proposal for one tick, demands may change kind at any tick without a bump. An axis with a
spring (a drone's stick) goes to its centre when nothing is asked of it, as the stick of a remote control does.

All velocities go through one solver call because that costs half of four; whatever needs more is an axis's own affair.
What every axis does every tick is written out in `step` and `_cruise`, where a call, a `zip` or a comprehension would
be seen in the figures of tests/benchmarks/test_planner.py: there a step may cost four bare updates of Ruckig, half of
it in Ruckig.
"""

from __future__ import annotations

from collections.abc import Mapping

from teleop.core.axes import Axis, Limits, Motion, State
from teleop.core.guard_stop import inevitable_velocity
from teleop.core.setpoints import Demand, PositionTarget, StateTarget, VelocityTarget
from teleop.planner.axis_planner import INSET, AxisPlanner
from teleop.planner.point_to_point import Recall, plan_recalls
from teleop.planner.ruckig_solver import PositionSolver, VelocitySolver, new_state
from teleop.planner.tracking import Tracker

SLOWEST = 1e-3  # share of V with which a soft limit is approached at least: Ruckig needs more than 0
RESIDUE = 1e-10  # unit/s and unit/s2 left by rounding when Ruckig's plan has come to rest
STILL = VelocityTarget(0.0)  # what a halt is, and an axis of which nothing is asked
HOME = PositionTarget(0.0)  # what they are of an axis with a spring


class Live:
    """The live planner of all axes. `limits` are the axes' own, `dt` is the tick in seconds.

    An axis takes part once `reset` has placed it.
    """

    def __init__(self, limits: Mapping[Axis, Limits], dt: float) -> None:
        self._limits = dict(limits)
        self._dt = dt
        self._drives: list[AxisPlanner] = []
        self._position = PositionSolver()
        self._velocity = [VelocitySolver(max(1, count)) for count in range(len(limits) + 1)]  # by number of axes
        self._recalls: dict[Axis, Recall] = {}
        self._tracker = Tracker()
        self._carried: list[AxisPlanner] = []  # whose states the velocity solver of so many axes knows
        self._before: Motion = {}
        self._after: Motion = {}

    def reset(self, motion: Motion) -> None:
        """The axes of `motion` are here now, outside their limits too: then only inward motion is allowed.

        Raises KeyError for an axis without limits.
        """
        drives = {drive.axis: drive for drive in self._drives}
        drives |= {axis: AxisPlanner(axis, self._limits[axis], state) for axis, state in motion.items()}
        self._drives = list(drives.values())
        for axis in motion:
            self._recalls.pop(axis, None)
        self._before, self._after = {}, self.motion

    def limit(self, limits: Mapping[Axis, Limits]) -> None:
        """Change the limits of the axes named, at any time. One that is now beyond them comes back inside first."""
        self._limits |= limits
        self.reset({drive.axis: drive.state for drive in self._drives if drive.axis in limits})

    @property
    def motion(self) -> dict[Axis, State]:
        """Where each axis is commanded to be."""
        return {drive.axis: drive.state for drive in self._drives}

    @property
    def at_rest(self) -> bool:
        """Whether the last step left every axis where it was, at rest: the same demand will do so again."""
        return self._after == self._before and all(drive.rests for drive in self._drives)

    def step(self, demand: Demand, dt_steps: int = 1) -> dict[Axis, State]:
        """The motion `dt_steps` ticks on. An axis absent from `demand` comes to rest and stays.

        One with a spring comes to rest in its centre.
        """
        seconds, asked = self._dt * dt_steps, demand.get
        sticks: list[AxisPlanner] = []
        velocities: list[float] = []
        limits: list[tuple[float, float]] = []
        presets: list[tuple[AxisPlanner, PositionTarget]] = []
        for drive in self._drives:
            wish = asked(drive.axis)
            if not isinstance(wish, VelocityTarget):
                if isinstance(wish, StateTarget):
                    state = self._tracker.step(drive, wish, seconds)
                    if state is None or drive.outside:
                        self._commit(drive, state, seconds)
                    else:
                        drive.state = state
                    continue
                if drive.axis.is_stick and not isinstance(wish, PositionTarget):
                    wish = HOME
                if isinstance(wish, PositionTarget):
                    presets.append((drive, wish))
                    continue
                wish = STILL
            velocity, acceleration, jerk = wish
            drive.now = drive.guard
            if acceleration is not None or jerk is not None:
                drive.soften(acceleration, jerk)
            if drive.state[1] != 0.0 or not drive.holds(velocity):
                limit = drive.fastest
                sticks.append(drive)
                velocities.append(limit if velocity > limit else -limit if velocity < -limit else velocity)
                limits.append(drive.now)
        self._carried = self._cruise(sticks, velocities, limits, seconds) if sticks else []
        if presets or self._recalls:
            self._recall(presets, seconds)
        motion: dict[Axis, State] = {}
        for drive in self._drives:
            motion[drive.axis] = drive.state
        self._before, self._after = self._after, motion
        return motion

    def _commit(self, drive: AxisPlanner, state: State | None, seconds: float) -> None:
        """Take a proposed state, or the guard stop in its place."""
        if state is None:
            state = drive.guard_stop(seconds)
        drive.state = state
        if drive.outside:
            drive.narrow()

    def _cruise(
        self, drives: list[AxisPlanner], velocities: list[float], limits: list[tuple[float, float]], seconds: float
    ) -> list[AxisPlanner]:
        """Each of `drives` a step towards its velocity, as far as its soft limits let it.

        Returns them if all went where the solver took them, so that it need not be told next time; else none.
        """
        solver = self._velocity[len(drives)]
        if drives != self._carried:
            solver.place([drive.state for drive in drives])
        answer = solver.step(velocities, limits, seconds)
        if answer is None:
            for drive in drives:
                self._commit(drive, None, seconds)
            return []
        carried = drives
        positions, rates, accelerations = answer
        for i, drive in enumerate(drives):
            position = positions[i]
            state = new_state(State, (position, rates[i], accelerations[i]))
            if velocities[i] == 0.0 and -RESIDUE < rates[i] < RESIDUE and -RESIDUE < accelerations[i] < RESIDUE:
                state, carried = State(position), []
            if drive.clear_low < position < drive.clear_high:
                drive.state = state
                continue
            side = drive.trips(state, gently=True)
            self._commit(drive, self._approach_limit(drive, side, velocities[i], seconds) if side else state, seconds)
            if drive.state is not state:
                carried = []
        return carried

    def _approach_limit(self, drive: AxisPlanner, side: int, wanted: float, seconds: float) -> State | None:
        """Onto the soft limit on `side` (1 upper, -1 lower: planned in a mirror), to rest there; None if not legal."""
        position, velocity, acceleration = (side * x for x in drive.state)
        target = (drive.high if side > 0 else -drive.low) - INSET
        max_acceleration, max_jerk = drive.now
        fastest = max(
            inevitable_velocity(velocity, acceleration, max_jerk), side * wanted, SLOWEST * drive.limits.velocity
        )
        answer = self._position.solve(
            [State(position, velocity, acceleration)], [State(target)], [fastest], [max_acceleration], [max_jerk]
        )
        if answer is None:
            return None
        if answer.duration <= seconds:
            return State(side * target)
        (position,), (velocity,), (acceleration,) = answer.at_time(seconds)
        state = State(side * position, side * velocity, side * acceleration)
        return None if drive.trips(state) else state

    def _recall(self, presets: list[tuple[AxisPlanner, PositionTarget]], seconds: float) -> None:
        """Go on with the recalls still wanted, plan those just asked for, drop the others."""
        going: dict[Axis, Recall] = {}
        asked: list[tuple[AxisPlanner, PositionTarget]] = []
        for drive, wish in presets:
            recall = self._recalls.get(drive.axis)
            if recall is not None and recall.goes_on(wish, seconds):
                going[drive.axis] = recall
            else:
                asked.append((drive, wish))
        self._recalls = {**going, **plan_recalls(asked)}
        for drive, _ in presets:
            recall = self._recalls.get(drive.axis)
            state = None if recall is None else recall.step(seconds)
            if state is not None and drive.trips(state):
                del self._recalls[drive.axis]
                state = None
            self._commit(drive, state, seconds)

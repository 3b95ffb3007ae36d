"""From demands to the next tick's motion: always legal, whatever is demanded and whenever it changes.

Each axis tries a short ladder of plans, and takes the first whose next state can still be stopped inside the soft
limits. For a stick: Ruckig's velocity interface with the operator's limits, then its position interface exactly onto
the soft limit, then the guard stop. A preset and a compiled move have ladders of their own, which end in the same guard
stop. Every committed state can be stopped, so the guard stop is legal by induction (docs/explanation/planning.md,
"A. Live"). A plan is only a proposal for one tick, so a demand may change its kind at any tick without a bump. An axis
with a spring (a drone's stick) goes to its center when nothing is demanded of it, as on a remote control.

All velocities go through one solver call, because that costs half of four. What every axis does every tick is written
out in `step` and `_cruise`: tests/benchmarks/test_planner.py allows a step four bare updates of Ruckig, half of which
Ruckig itself takes, and a call, a `zip` or a comprehension more per axis would show there.
"""

from __future__ import annotations

from collections.abc import Mapping

from teleop.core.axes import Axis, Limits, Motion, State
from teleop.core.guard_stop import inevitable_velocity
from teleop.core.setpoints import Demand, PositionTarget, StateTarget, VelocityTarget
from teleop.planner.axis_planner import INSET, AxisPlanner
from teleop.planner.point_to_point import PointToPoint, plan_point_to_point
from teleop.planner.ruckig_solver import PositionSolver, VelocitySolver, new_state
from teleop.planner.tracking import Tracker

SLOWEST = 1e-3  # share of V with which a soft limit is approached at least: Ruckig needs more than 0
RESIDUE = 1e-10  # unit/s and unit/s2 left by rounding when Ruckig's plan has come to rest
NO_VELOCITY = VelocityTarget(0.0)  # what a halt is, and an axis of which nothing is asked
HOME = PositionTarget(0.0)  # what they are of an axis with a spring


class Live:
    """The live planner of all axes. `limits` are the axes' own, `dt` is the tick in seconds.

    An axis takes part once `reset` has placed it.
    """

    def __init__(self, limits: Mapping[Axis, Limits], dt: float) -> None:
        self._limits = dict(limits)
        self._dt = dt
        self._planners: list[AxisPlanner] = []
        self._position = PositionSolver()
        self._velocity = [VelocitySolver(max(1, count)) for count in range(len(limits) + 1)]  # by number of axes
        self._moves: dict[Axis, PointToPoint] = {}
        self._tracker = Tracker()
        self._carried: list[AxisPlanner] = []  # whose states the velocity solver of so many axes knows
        self._before: Motion = {}
        self._after: Motion = {}

    def reset(self, motion: Motion) -> None:
        """The axes of `motion` are here now, outside their limits too: then only inward motion is allowed.

        Raises KeyError for an axis without limits.
        """
        planners = {planner.axis: planner for planner in self._planners}
        planners |= {axis: AxisPlanner(axis, self._limits[axis], state) for axis, state in motion.items()}
        self._planners = list(planners.values())
        for axis in motion:
            self._moves.pop(axis, None)
        self._before, self._after = {}, self.motion

    def limit(self, limits: Mapping[Axis, Limits]) -> None:
        """Change the limits of the axes named, at any time. One that is now beyond them comes back inside first."""
        self._limits |= limits
        self.reset({planner.axis: planner.state for planner in self._planners if planner.axis in limits})

    @property
    def motion(self) -> dict[Axis, State]:
        """Where each axis is commanded to be."""
        return {planner.axis: planner.state for planner in self._planners}

    @property
    def at_rest(self) -> bool:
        """Whether the last step left every axis where it was, at rest: the same demand will do so again."""
        return self._after == self._before and all(planner.rests for planner in self._planners)

    def step(self, demand: Demand, dt_steps: int = 1) -> dict[Axis, State]:
        """The motion `dt_steps` ticks on. An axis absent from `demand` comes to rest and stays.

        One with a spring comes to rest in its center.
        """
        seconds, asked = self._dt * dt_steps, demand.get
        sticks: list[AxisPlanner] = []
        velocities: list[float] = []
        limits: list[tuple[float, float]] = []
        presets: list[tuple[AxisPlanner, PositionTarget]] = []
        for planner in self._planners:
            setpoint = asked(planner.axis)
            if not isinstance(setpoint, VelocityTarget):
                if isinstance(setpoint, StateTarget):
                    state = self._tracker.step(planner, setpoint, seconds)
                    if state is None or planner.outside:
                        self._commit(planner, state, seconds)
                    else:
                        planner.state = state
                    continue
                if planner.axis.is_stick and not isinstance(setpoint, PositionTarget):
                    setpoint = HOME
                if isinstance(setpoint, PositionTarget):
                    presets.append((planner, setpoint))
                    continue
                setpoint = NO_VELOCITY
            velocity, acceleration, jerk = setpoint
            planner.now = planner.guard
            if acceleration is not None or jerk is not None:
                planner.soften(acceleration, jerk)
            if planner.state[1] != 0.0 or not planner.holds(velocity):
                limit = planner.fastest
                sticks.append(planner)
                velocities.append(limit if velocity > limit else -limit if velocity < -limit else velocity)
                limits.append(planner.now)
        self._carried = self._cruise(sticks, velocities, limits, seconds) if sticks else []
        if presets or self._moves:
            self._move_to(presets, seconds)
        motion: dict[Axis, State] = {}
        for planner in self._planners:
            motion[planner.axis] = planner.state
        self._before, self._after = self._after, motion
        return motion

    def _commit(self, planner: AxisPlanner, state: State | None, seconds: float) -> None:
        """Take a proposed state, or the guard stop in its place."""
        if state is None:
            state = planner.guard_stop(seconds)
        planner.state = state
        if planner.outside:
            planner.narrow()

    def _cruise(
        self, planners: list[AxisPlanner], velocities: list[float], limits: list[tuple[float, float]], seconds: float
    ) -> list[AxisPlanner]:
        """Each of `planners` a step towards its velocity, as far as its soft limits let it.

        Returns them if all went where the solver took them (their states need not be set again next time); else none.
        """
        solver = self._velocity[len(planners)]
        if planners != self._carried:
            solver.place([planner.state for planner in planners])
        answer = solver.step(velocities, limits, seconds)
        if answer is None:
            for planner in planners:
                self._commit(planner, None, seconds)
            return []
        carried = planners
        positions, rates, accelerations = answer
        for i, planner in enumerate(planners):
            position = positions[i]
            state = new_state(State, (position, rates[i], accelerations[i]))
            if velocities[i] == 0.0 and -RESIDUE < rates[i] < RESIDUE and -RESIDUE < accelerations[i] < RESIDUE:
                state, carried = State(position), []
            if planner.clear_low < position < planner.clear_high:
                planner.state = state
                continue
            side = planner.trips(state, gently=True)
            self._commit(
                planner, self._approach_limit(planner, side, velocities[i], seconds) if side else state, seconds
            )
            if planner.state is not state:
                carried = []
        return carried

    def _approach_limit(self, planner: AxisPlanner, side: int, wanted: float, seconds: float) -> State | None:
        """Onto the soft limit on `side` (1 upper, -1 lower: planned in a mirror), to rest there; None if not legal."""
        position, velocity, acceleration = (side * x for x in planner.state)
        target = (planner.high if side > 0 else -planner.low) - INSET
        max_acceleration, max_jerk = planner.now
        fastest = max(
            inevitable_velocity(velocity, acceleration, max_jerk), side * wanted, SLOWEST * planner.limits.velocity
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
        return None if planner.trips(state) else state

    def _move_to(self, presets: list[tuple[AxisPlanner, PositionTarget]], seconds: float) -> None:
        """Go on with the moves still wanted, plan those just asked for, drop the others."""
        going: dict[Axis, PointToPoint] = {}
        asked: list[tuple[AxisPlanner, PositionTarget]] = []
        for planner, setpoint in presets:
            move = self._moves.get(planner.axis)
            if move is not None and move.continues(setpoint, seconds):
                going[planner.axis] = move
            else:
                asked.append((planner, setpoint))
        self._moves = {**going, **plan_point_to_point(asked)}
        for planner, _ in presets:
            move = self._moves.get(planner.axis)
            state = None if move is None else move.step(seconds)
            if state is not None and planner.trips(state):
                del self._moves[planner.axis]
                state = None
            self._commit(planner, state, seconds)

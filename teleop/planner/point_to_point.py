"""Goto: to a position and rest, with every axis of the same arrival time getting there together.

Planned once, when it is asked for, and then only evaluated: Ruckig asked again each tick for exactly the time that
remains would now and then find that time in a gap between its feasible durations and come back longer. The whole
trajectory is checked against the soft limits before it is taken: a slow one may back away before it comes, so when
the common trajectory leaves the limits the axes go separately, and if even that fails the axis first comes to rest.

Ruckig knows no trajectory of more than two hours. So slow a way needs no solver: once at rest, it is a quintic.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from ruckig import Trajectory

from teleop.core.axes import Axis, State
from teleop.core.setpoints import PositionTarget
from teleop.planner.axis_planner import SLACK, AxisPlanner
from teleop.planner.ruckig_solver import PositionSolver

LONGEST = 5000.0  # s that Ruckig is asked for; it fails from 7600 on (docs/explanation/planning.md, "Ruckig traps")
SLOWEST = 1e-3  # share of V: Ruckig needs more than 0
LATE = 1e-9  # s, of ticks added up


class QuinticTrajectory:
    """From rest to rest in `duration` s, in the shape of Ruckig's trajectories."""

    def __init__(self, starts: Sequence[float], targets: Sequence[float], duration: float) -> None:
        self._starts, self._distances = starts, [t - s for s, t in zip(starts, targets, strict=True)]
        self.duration = duration

    def at_time(self, time: float) -> tuple[list[float], list[float], list[float]]:
        u = time / self.duration
        along = u * u * u * (10 - u * (15 - 6 * u))
        rate = 30 * u * u * (1 - u) ** 2 / self.duration
        change = 60 * u * (1 - u) * (1 - 2 * u) / self.duration**2
        return (
            [start + along * distance for start, distance in zip(self._starts, self._distances, strict=True)],
            [rate * distance for distance in self._distances],
            [change * distance for distance in self._distances],
        )


@dataclass(slots=True)
class PointToPoint:
    """One axis' share of a trajectory in progress."""

    setpoint: PositionTarget
    trajectory: Trajectory | QuinticTrajectory
    index: int
    target: float
    elapsed: float = 0.0

    def continues(self, setpoint: PositionTarget, seconds: float) -> bool:
        """Whether `setpoint` is this move, a tick older: arrival repeated unchanged, or counted down with the clock."""
        if setpoint.position != self.setpoint.position or setpoint.velocity != self.setpoint.velocity:
            return False
        if setpoint.arrive is None or self.setpoint.arrive is None:
            return setpoint.arrive is self.setpoint.arrive
        return (
            setpoint.arrive == self.setpoint.arrive
            or abs(self.setpoint.arrive - self.elapsed - setpoint.arrive) <= 2 * seconds
        )

    def step(self, seconds: float) -> State:
        self.elapsed += seconds
        if self.elapsed >= self.trajectory.duration - LATE:
            return State(self.target)
        position, velocity, acceleration = self.trajectory.at_time(self.elapsed)
        return State(position[self.index], velocity[self.index], acceleration[self.index])


def _within(trajectory: Trajectory, planners: Sequence[AxisPlanner]) -> bool:
    return all(
        extremes.min >= planner.low - SLACK and extremes.max <= planner.high + SLACK
        for extremes, planner in zip(trajectory.position_extrema, planners, strict=True)
    )


def _plan(asked: Sequence[tuple[AxisPlanner, PositionTarget]], arrive: float | None) -> dict[Axis, PointToPoint]:
    """A trajectory for all of `asked`, or nothing when there is none within the soft limits."""
    planners = [planner for planner, _ in asked]
    targets = [
        min(max(setpoint.position, planner.limits.minimum), planner.limits.maximum) for planner, setpoint in asked
    ]
    if arrive is not None and arrive > LONGEST:
        return _quintic_moves(asked, targets, arrive)
    trajectory = PositionSolver(len(planners)).solve(
        [planner.state for planner in planners],
        [State(target) for target in targets],
        [_fastest(planner, setpoint) for planner, setpoint in asked],
        [planner.guard[0] for planner in planners],
        [planner.guard[1] for planner in planners],
        minimum_duration=arrive,
    )
    if trajectory is None or not _within(trajectory, planners):
        return {}
    return {
        planner.axis: PointToPoint(setpoint, trajectory, i, targets[i]) for i, (planner, setpoint) in enumerate(asked)
    }


def _fastest(planner: AxisPlanner, setpoint: PositionTarget) -> float:
    """What it may go, unit/s; one that is faster than was asked for is braked to that first."""
    if setpoint.velocity is None or planner.outside:
        return planner.velocity
    return min(planner.velocity, max(setpoint.velocity, SLOWEST * planner.velocity))


def _quintic_moves(
    asked: Sequence[tuple[AxisPlanner, PositionTarget]], targets: Sequence[float], arrive: float
) -> dict[Axis, PointToPoint]:
    """All of them from rest, or nothing: those that move are first to stop, and those outside to come in."""
    if not all(planner.rests and not planner.outside for planner, _ in asked):
        return {}
    trajectory = QuinticTrajectory([planner.state.position for planner, _ in asked], targets, arrive)
    return {
        planner.axis: PointToPoint(setpoint, trajectory, i, targets[i]) for i, (planner, setpoint) in enumerate(asked)
    }


def plan_point_to_point(asked: Sequence[tuple[AxisPlanner, PositionTarget]]) -> Mapping[Axis, PointToPoint]:
    """A move for each planner that one can be found for now.

    Axes with the same `arrive` share a trajectory; those without go as soon as each can.
    """
    moves: dict[Axis, PointToPoint] = {}
    together: dict[float, list[tuple[AxisPlanner, PositionTarget]]] = {}
    alone: list[tuple[AxisPlanner, PositionTarget]] = []
    for planner, setpoint in asked:
        (alone if setpoint.arrive is None else together.setdefault(setpoint.arrive, [])).append((planner, setpoint))
    for arrive, members in together.items():
        found = _plan(members, max(arrive, 0.0))
        moves |= found
        if not found:
            alone += [(planner, setpoint) for planner, setpoint in members if arrive <= LONGEST or planner.outside]
    for single in alone:
        moves |= _plan([single], None)
    return moves

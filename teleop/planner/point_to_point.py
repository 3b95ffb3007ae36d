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

LONGEST = 5000.0  # s that Ruckig is asked for; it fails from 7600 on (planning.md, "Ruckig traps")
SLOWEST = 1e-3  # share of V: Ruckig needs more than 0
LATE = 1e-9  # s, of ticks added up


class Drift:
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
class Recall:
    """One axis' share of a trajectory in progress."""

    wish: PositionTarget
    trajectory: Trajectory | Drift
    index: int
    target: float
    elapsed: float = 0.0

    def goes_on(self, wish: PositionTarget, seconds: float) -> bool:
        """Whether `wish` is this recall, a tick older: arrival repeated unchanged, or counted down with the clock."""
        if wish.position != self.wish.position or wish.velocity != self.wish.velocity:
            return False
        if wish.arrive is None or self.wish.arrive is None:
            return wish.arrive is self.wish.arrive
        return wish.arrive == self.wish.arrive or abs(self.wish.arrive - self.elapsed - wish.arrive) <= 2 * seconds

    def step(self, seconds: float) -> State:
        self.elapsed += seconds
        if self.elapsed >= self.trajectory.duration - LATE:
            return State(self.target)
        position, velocity, acceleration = self.trajectory.at_time(self.elapsed)
        return State(position[self.index], velocity[self.index], acceleration[self.index])


def _within(trajectory: Trajectory, drives: Sequence[AxisPlanner]) -> bool:
    return all(
        extremes.min >= drive.low - SLACK and extremes.max <= drive.high + SLACK
        for extremes, drive in zip(trajectory.position_extrema, drives, strict=True)
    )


def _plan(asked: Sequence[tuple[AxisPlanner, PositionTarget]], arrive: float | None) -> dict[Axis, Recall]:
    """A trajectory for all of `asked`, or nothing when there is none within the soft limits."""
    drives = [drive for drive, _ in asked]
    targets = [min(max(wish.position, drive.limits.minimum), drive.limits.maximum) for drive, wish in asked]
    if arrive is not None and arrive > LONGEST:
        return _drift(asked, targets, arrive)
    trajectory = PositionSolver(len(drives)).solve(
        [drive.state for drive in drives],
        [State(target) for target in targets],
        [_fastest(drive, wish) for drive, wish in asked],
        [drive.guard[0] for drive in drives],
        [drive.guard[1] for drive in drives],
        minimum_duration=arrive,
    )
    if trajectory is None or not _within(trajectory, drives):
        return {}
    return {drive.axis: Recall(wish, trajectory, i, targets[i]) for i, (drive, wish) in enumerate(asked)}


def _fastest(drive: AxisPlanner, wish: PositionTarget) -> float:
    """What it may go, unit/s; one that is faster than was asked for is braked to that first."""
    if wish.velocity is None or drive.outside:
        return drive.velocity
    return min(drive.velocity, max(wish.velocity, SLOWEST * drive.velocity))


def _drift(
    asked: Sequence[tuple[AxisPlanner, PositionTarget]], targets: Sequence[float], arrive: float
) -> dict[Axis, Recall]:
    """All of them from rest, or nothing: those that move are first to stop, and those outside to come in."""
    if not all(drive.rests and not drive.outside for drive, _ in asked):
        return {}
    trajectory = Drift([drive.state.position for drive, _ in asked], targets, arrive)
    return {drive.axis: Recall(wish, trajectory, i, targets[i]) for i, (drive, wish) in enumerate(asked)}


def plan_recalls(asked: Sequence[tuple[AxisPlanner, PositionTarget]]) -> Mapping[Axis, Recall]:
    """A recall for each drive that one can be found for now.

    Axes with the same `arrive` share a trajectory; those without go as soon as each can.
    """
    recalls: dict[Axis, Recall] = {}
    together: dict[float, list[tuple[AxisPlanner, PositionTarget]]] = {}
    alone: list[tuple[AxisPlanner, PositionTarget]] = []
    for drive, wish in asked:
        (alone if wish.arrive is None else together.setdefault(wish.arrive, [])).append((drive, wish))
    for arrive, members in together.items():
        found = _plan(members, max(arrive, 0.0))
        recalls |= found
        if not found:
            alone += [(drive, wish) for drive, wish in members if arrive <= LONGEST or drive.outside]
    for single in alone:
        recalls |= _plan([single], None)
    return recalls

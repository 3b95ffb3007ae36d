"""Goto: to a position and rest, with every axis of the same arrival time getting there together.

Planned once, when it is asked for, and then only evaluated: Ruckig asked again each tick for exactly the time that
remains would now and then find that time in a gap between its feasible durations and come back longer. The whole
trajectory is checked against the soft limits before it is taken: a slow one may back away before it comes, so when
the common trajectory leaves the limits the axes go separately, and if even that fails the axis first comes to rest.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from ruckig import Trajectory

from teleop.motion import Axis, Goto, State
from teleop.planner.drive import SLACK, Drive
from teleop.planner.solver import PositionSolver

LATE = 1e-9  # s, of ticks added up


@dataclass(slots=True)
class Recall:
    """One axis' share of a trajectory in progress."""

    wish: Goto
    trajectory: Trajectory
    index: int
    target: float
    elapsed: float = 0.0

    def goes_on(self, wish: Goto, seconds: float) -> bool:
        """Whether `wish` is this recall, a tick older: arrival repeated unchanged, or counted down with the clock."""
        if wish.position != self.wish.position:
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


def _within(trajectory: Trajectory, drives: Sequence[Drive]) -> bool:
    return all(
        extremes.min >= drive.low - SLACK and extremes.max <= drive.high + SLACK
        for extremes, drive in zip(trajectory.position_extrema, drives, strict=True)
    )


def _plan(asked: Sequence[tuple[Drive, Goto]], arrive: float | None) -> dict[Axis, Recall]:
    """A trajectory for all of `asked`, or nothing when there is none within the soft limits."""
    drives = [drive for drive, _ in asked]
    targets = [min(max(wish.position, drive.limits.minimum), drive.limits.maximum) for drive, wish in asked]
    trajectory = PositionSolver(len(drives)).solve(
        [drive.state for drive in drives],
        [State(target) for target in targets],
        [drive.velocity for drive in drives],
        [drive.guard[0] for drive in drives],
        [drive.guard[1] for drive in drives],
        minimum_duration=arrive,
    )
    if trajectory is None or not _within(trajectory, drives):
        return {}
    return {drive.axis: Recall(wish, trajectory, i, targets[i]) for i, (drive, wish) in enumerate(asked)}


def plan_recalls(asked: Sequence[tuple[Drive, Goto]]) -> Mapping[Axis, Recall]:
    """A recall for each drive that one can be found for now.

    Axes with the same `arrive` share a trajectory; those without go as soon as each can.
    """
    recalls: dict[Axis, Recall] = {}
    together: dict[float, list[tuple[Drive, Goto]]] = {}
    alone: list[tuple[Drive, Goto]] = []
    for drive, wish in asked:
        (alone if wish.arrive is None else together.setdefault(wish.arrive, [])).append((drive, wish))
    for arrive, members in together.items():
        found = _plan(members, max(arrive, 0.0))
        recalls |= found
        if not found:
            alone += members
    for single in alone:
        recalls |= _plan([single], None)
    return recalls

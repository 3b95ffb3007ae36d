"""The least time for a way from where the axes are to rest at their targets, all together, within their limits."""

from __future__ import annotations

from collections.abc import Mapping

from teleop.core.axes import Axis, Limits, Motion, State
from teleop.planner.ruckig_solver import PositionSolver


def shortest_seconds(motion: Motion, targets: Mapping[Axis, float], limits: Mapping[Axis, Limits]) -> float:
    """In s, by the jerk-limited planner; 0 where it finds none."""
    of_axes = [limits[axis] for axis in targets]
    trajectory = PositionSolver(len(targets)).solve(
        [motion[axis] for axis in targets],
        [State(target) for target in targets.values()],
        [of.velocity for of in of_axes],
        [of.acceleration for of in of_axes],
        [of.jerk for of in of_axes],
    )
    return 0.0 if trajectory is None else trajectory.duration

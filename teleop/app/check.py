"""How much of a rig's limits a planned move uses."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from teleop.app.planning import Plan
from teleop.core.axes import Axis, Limits
from teleop.planner.trajectory import Peaks
from teleop.sequence.playback import fastest


@dataclass(frozen=True)
class AxisUse:
    """Peak shares of an axis's limits, and the least room to a soft limit in units, None where there is none."""

    velocity: float
    acceleration: float
    jerk: float
    room: float | None


@dataclass(frozen=True)
class MoveCheck:
    """What the move asks of each axis; it can be played at most at `fastest` times its speed."""

    axes: Mapping[Axis, AxisUse]
    fastest: float


def check(plan: Plan) -> MoveCheck:
    """A drone's move has one speed: held for longer or shorter, its sticks would fly it elsewhere."""
    move, limits = plan.sequence.move, plan.profile.limits
    most = 1.0 if plan.is_flown else fastest(move, limits)
    return MoveCheck({axis: _use(peaks, limits[axis]) for axis, peaks in move.peaks().items()}, most)


def _use(peaks: Peaks, limits: Limits) -> AxisUse:
    room = min(peaks.minimum - limits.minimum, limits.maximum - peaks.maximum)
    return AxisUse(
        peaks.velocity / limits.velocity,
        peaks.acceleration / limits.acceleration,
        peaks.jerk / limits.jerk,
        None if limits.continuous else room,
    )

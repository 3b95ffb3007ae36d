"""How much of a rig's limits a planned move uses."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from teleop.app.planning import Plan
from teleop.app.slow_moves import slow_moves
from teleop.core.axes import Axis, Limits
from teleop.planner.trajectory import Track
from teleop.sequence.compile import CompiledSequence
from teleop.sequence.playback import fastest


@dataclass(frozen=True)
class AxisUse:
    """Peak shares of an axis's limits, and the least room to a soft limit in units, None where there is none.

    `peak_velocity` (unit/s) is reached at `peak_at` (s).
    """

    velocity: float
    acceleration: float
    jerk: float
    room: float | None
    peak_velocity: float
    peak_at: float


@dataclass(frozen=True)
class MoveCheck:
    """What the move asks of each axis; it can be played at most at `fastest` times its speed.

    `frames` are how far the plan is off a table's, by axis, the worst of each. `remarks` are lines for the user.
    """

    axes: Mapping[Axis, AxisUse]
    fastest: float
    frames: Mapping[Axis, FramesCheck]
    remarks: Sequence[str]


@dataclass(frozen=True)
class FramesCheck:
    """The most that a plan is `off` a table at one of its frames, and may be (units); and from how many keys."""

    table: str
    off: float
    tolerance: float
    frame: int
    frames: int
    keys: int


def check(plan: Plan) -> MoveCheck:
    """A drone's move has one speed: held for longer or shorter, its sticks would fly it elsewhere."""
    move, limits = plan.sequence.move, plan.profile.limits
    most = 1.0 if plan.is_flown else fastest(move, limits)
    uses = {axis: _use(track, limits[axis]) for axis, track in move.tracks.items()}
    return MoveCheck(uses, most, _frames(plan.sequence), list(slow_moves(plan)))


def _frames(sequence: CompiledSequence) -> Mapping[Axis, FramesCheck]:
    found = {}
    for axis, tables in sequence.frames.items():
        offs = [(table.deviation(sequence.move.tracks[axis]), table) for table in tables]
        worst, table = max(offs, key=lambda each: each[0].size / each[1].tolerance)
        keys, frames = len(sequence.keys[axis]), len(table.times)
        found[axis] = FramesCheck(table.table, worst.size, table.tolerance, worst.frame, frames, keys)
    return found


def _use(track: Track, limits: Limits) -> AxisUse:
    peaks = track.peaks()
    room = min(peaks.minimum - limits.minimum, limits.maximum - peaks.maximum)
    return AxisUse(
        peaks.velocity / limits.velocity,
        peaks.acceleration / limits.acceleration,
        peaks.jerk / limits.jerk,
        None if limits.continuous else room,
        peaks.velocity,
        track.fastest_at(),
    )

"""The operator's trim over a running sequence: a live-planned offset, kept apart from the sequence and added to it.

Two motions that are each within limits say nothing about their sum, so the limits are shared out beforehand: the
sequence is planned with a share of V, A and J, the trim gets the rest, and its soft limits are the room that the
sequence leaves on either side. Then the sum is legal whatever either of them does, with nothing to check while it runs.
The offset itself is planned live, as an axis of its own (`sources.trimming`).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from teleop.core.axes import Axis, Limits, Motion, State
from teleop.planner.trajectory import Move

SHARE = 0.75  # of V, A and J for the sequence


def sequence_limits(limits: Mapping[Axis, Limits], share: float = SHARE) -> dict[Axis, Limits]:
    """What a sequence that may be trimmed is to be planned with."""
    return {axis: of_axis.scaled(share) for axis, of_axis in limits.items()}


def trim_limits(move: Move, limits: Mapping[Axis, Limits], share: float = SHARE) -> dict[Axis, Limits]:
    """What is left for the trim of each of the move's axes; its positions are offsets."""
    left = {}
    for axis, peaks in move.peaks().items():
        rest = limits[axis].scaled(1 - share)
        room_below = min(0.0, rest.minimum - peaks.minimum)
        room_above = max(0.0, rest.maximum - peaks.maximum)
        left[axis] = replace(rest, minimum=room_below, maximum=room_above)
    return left


def trimmed(motion: Motion, offsets: Motion) -> dict[Axis, State]:
    """The move and its trim together."""
    return {
        axis: State(*map(sum, zip(state, offsets[axis], strict=True))) if axis in offsets else state
        for axis, state in motion.items()
    }

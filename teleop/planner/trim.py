"""The operator's trim over a running sequence: a live-planned offset, kept apart from the sequence and added to it.

Two motions that are each within limits say nothing about their sum, so the limits are shared out beforehand: the
sequence is planned with a share of V, A and J, the trim gets the rest, and its soft limits are the room that the
sequence leaves on either side. Then the sum is legal whatever either of them does, with nothing to check while it runs.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

from teleop.motion import Axis, Cruise, Demand, Goto, Limits, Motion, State
from teleop.planner.keyframes import Key
from teleop.planner.live import Live
from teleop.planner.move import Move

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


class Trim:
    """The offset of each axis of a running move, planned live. `dt` is the tick in seconds.

    Without a stick the offset is held; `release` takes it back to 0.
    """

    def __init__(self, move: Move, limits: Mapping[Axis, Limits], dt: float, share: float = SHARE) -> None:
        self._live = Live(trim_limits(move, limits, share), dt)
        self._live.reset(dict.fromkeys(move.tracks, State(0.0)))
        self._releasing: set[Axis] = set()

    @property
    def offsets(self) -> dict[Axis, State]:
        return self._live.motion

    def release(self) -> None:
        """Take every offset smoothly back to 0; a stick on an axis takes that axis over again."""
        self._releasing = set(self.offsets)

    def step(self, sticks: Mapping[Axis, Cruise], dt_steps: int = 1) -> dict[Axis, State]:
        """The offsets `dt_steps` ticks on. An axis absent from `sticks` holds its offset."""
        self._releasing -= sticks.keys()
        demand: Demand = {**{axis: Goto(0.0) for axis in self._releasing}, **sticks}
        return self._live.step(demand, dt_steps)


def trimmed(motion: Motion, offsets: Motion) -> dict[Axis, State]:
    """The move and its trim together."""
    return {
        axis: State(*map(sum, zip(state, offsets[axis], strict=True))) if axis in offsets else state
        for axis, state in motion.items()
    }


def written_back(keys: Mapping[Axis, Sequence[Key]], offsets: Motion) -> dict[Axis, list[Key]]:
    """The keys moved by the offsets: the trim made part of the sequence."""
    return {
        axis: [replace(key, position=key.position + offsets[axis].position) for key in of_axis]
        if axis in offsets
        else list(of_axis)
        for axis, of_axis in keys.items()
    }

"""Moves from rest to rest, one after the other, and the way to a frame from the side that the move comes from."""

from __future__ import annotations

import math
from collections.abc import Mapping

from teleop.core.axes import Axis, Limits, Motion, State
from teleop.core.timing import whole_ticks
from teleop.planner.polynomial import Array
from teleop.planner.rest_to_rest import rest_to_rest
from teleop.planner.trajectory import Move

GENTLE = 0.5  # of velocity, acceleration and jerk, where there is time
BACKLASH = {Axis.FOCUS: 0.02}  # units, how far before its place an axis is approached from
BACKLASH_ANGLE = 1.0  # deg


class Way:
    """Moves one after the other, each from rest to rest."""

    def __init__(self, now: float, motion: Motion) -> None:
        self._legs: list[tuple[float, Move]] = []
        self.end = motion  # where it leads to
        self.arrival = now

    def along(self, begin: float, move: Move) -> None:
        """A move that is under way, whose own time is 0 at `begin`."""
        self._legs.append((begin, move))
        self.end, self.arrival = move.end, begin + move.duration

    def on(self, target: Mapping[Axis, float], limits: Mapping[Axis, Limits], share: float, least: float = 0.0) -> None:
        """To `target` when the way so far is over."""
        move = rest_to_rest(self.end, target, limits, share, least)
        self._legs.append((self.arrival, move))
        self.end = {axis: State(position) for axis, position in target.items()}
        self.arrival += whole_ticks(move.duration)

    def at(self, now: float) -> Motion:
        for begin, move in self._legs:
            if now < begin + move.duration:
                return move.at(now - begin)
        return self.end


def approach(
    now: float,
    motion: Motion,
    place: Mapping[Axis, float],
    positions: Mapping[Axis, Array],
    frame: int,
    limits: Mapping[Axis, Limits],
) -> Way:
    """To `place`, in the end from the side from which the move comes to `frame`."""
    before = {axis: _before(axis, there, positions[axis], frame, limits[axis]) for axis, there in place.items()}
    way = Way(now, {axis: motion[axis] for axis in place})
    if before != place:
        way.on(before, limits, GENTLE)
    way.on(place, limits, GENTLE)
    return way


def _before(axis: Axis, place: float, positions: Array, frame: int, limits: Limits) -> float:
    """A little before `place`: by the way there, or, where it begins there, by the way on."""
    here = positions[frame]
    way = next((here - there for there in positions[:frame][::-1] if there != here), 0.0)
    way = way or next((there - here for there in positions[frame:] if there != here), 0.0)
    back = math.copysign(BACKLASH.get(axis, BACKLASH_ANGLE), way) if way else 0.0
    return min(max(place - back, limits.minimum), limits.maximum)

"""Where the base of the rig (a slider, a dolly) is at a time, as the keyframes say.

It moves from key to key as an axis would: smoothly from rest to rest, with the ramps and the even speed between them
that an `ease` asks for. The program does not drive the base; it aims from it.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise
from typing import NamedTuple

from teleop.core.axes import Axis, Limits
from teleop.planner.aim import AimError, Point
from teleop.planner.keyframes.findings import Infeasible
from teleop.planner.keyframes.keys import Key
from teleop.planner.trajectory import Track

ORIGIN = Point(0.0, 0.0, 0.0)
NOTHING = 1e-6  # m: a base that moves less stands still
ABUNDANT = 1e3  # times what the keys need on average: no limit of the base is known, and none is to act


class BaseKey(NamedTuple):
    """Where the base is, in m, and the key's times, ramps and stop (its position means nothing)."""

    place: Point
    key: Key


class BasePath:
    """Places over time; before the first key and after the last one the base rests. Without keys it is at 0, 0, 0.

    Raises AimError where the ramps of two keys do not fit between them.
    """

    def __init__(self, keys: Sequence[BaseKey]) -> None:
        self._keys = keys
        self._start = keys[0].place if keys else ORIGIN
        self._tracks: dict[int, Track] = {}
        self._reach: dict[int, float] = {}
        for number, start in enumerate(self._start):
            reach = max((abs(place[number] - start) for place, _ in keys), default=0.0)
            if reach > NOTHING:
                self._reach[number] = reach
                self._tracks[number] = _track([replace(key, position=(at[number] - start) / reach) for at, key in keys])

    def at(self, time: float) -> Point:
        """Where it is at a time in s."""
        moved = {number: self._reach[number] * track.at(time).position for number, track in self._tracks.items()}
        return Point(*(start + moved.get(number, 0.0) for number, start in enumerate(self._start)))

    def moves(self, begin: float, end: float) -> bool:
        """Whether it moves at any time between the two."""
        return any(track.next_motion(begin) < end for track in self._tracks.values())

    def times(self, begin: float, end: float) -> list[float]:
        """Both, and when the base has keys between them, or the end of a hold."""
        own = {time for _, key in self._keys for time in (key.at, key.at + key.hold)}
        return sorted({begin, end, *(time for time in own if begin < time < end)})


def _track(keys: Sequence[Key]) -> Track:
    """One coordinate over time, as a share of its reach; the planner knows it by the name of some axis."""
    from teleop.planner.keyframes.planner import plan  # loads the solver, which few sequences with an aim need

    shortest = min(after.at - key.at - key.hold for key, after in pairwise(keys))
    most = ABUNDANT / shortest
    limits = Limits(-math.inf, math.inf, most, most / shortest, most / shortest**2)
    try:
        return plan({Axis.PAN: keys}, {Axis.PAN: limits}).tracks[Axis.PAN]
    except Infeasible as error:
        found = error.findings[0]
        raise AimError(
            f"the base has no time for its ramps from {found.first} to {found.last}: use a shorter `ease`"
        ) from None

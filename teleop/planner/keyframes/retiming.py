"""Keys with more time between some of them: all axes are moved along together, as a user would edit the file."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import pairwise
from typing import NamedTuple

from teleop.core.axes import Axis
from teleop.core.timing import SAME_TIME
from teleop.planner.keyframes.keys import Key, Waypoint

Keys = Mapping[Axis, Sequence[Key]]


class Way(NamedTuple):
    """From one key of an axis to a later one, by their numbers (from 0)."""

    axis: Axis
    first: int
    last: int


def retimed(keys: Keys, needs: Mapping[Way, float]) -> dict[Axis, list[Key]]:
    """The keys, with each way lasting at least as long as it `needs` (s) and none shorter than before."""
    times = sorted({round(key.at / SAME_TIME) for of_axis in keys.values() for key in of_axis})
    place = {time: number for number, time in enumerate(times)}
    events = {axis: [place[round(key.at / SAME_TIME)] for key in of_axis] for axis, of_axis in keys.items()}
    ending: dict[int, list[tuple[int, float]]] = {}
    for way, seconds in needs.items():
        first, last = events[way.axis][way.first], events[way.axis][way.last]
        ending.setdefault(last, []).append((first, keys[way.axis][way.first].hold + seconds))
    moved: list[float] = []  # by how much each event is later
    for number, time in enumerate(times):
        shift = moved[-1] if moved else 0.0
        for first, seconds in ending.get(number, ()):
            shift = max(shift, moved[first] + seconds - (time - times[first]) * SAME_TIME)
        moved.append(shift)
    return {
        axis: [replace(key, at=key.at + moved[event]) for key, event in zip(of_axis, events[axis], strict=True)]
        for axis, of_axis in keys.items()
    }


def ways(axis: Axis, keys: Sequence[Key], points: Sequence[Waypoint]) -> list[Way]:
    """The ways between `points`, a leg from rest to rest; a dwell has none."""
    number = bisect_right(keys, points[0].time + SAME_TIME, key=lambda key: key.at + key.hold) - 1
    if number < 0 or keys[number].at + keys[number].hold < points[0].time - SAME_TIME:
        return []
    numbers = [number]
    for point in points[1:]:
        while abs(keys[number].at - point.time) >= SAME_TIME or number == numbers[-1]:
            number += 1
        numbers.append(number)
    return [Way(axis, first, last) for first, last in pairwise(numbers)]

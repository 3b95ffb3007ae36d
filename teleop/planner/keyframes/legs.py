"""Legs: the points of an axis from one rest to the next, which no other leg affects.

A loop or a bounce may be one leg of many passes. Its middle is the same over and over: a few passes tell of all.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from teleop.core.axes import Axis
from teleop.core.timing import SAME_TIME
from teleop.planner.keyframes.keys import Key, Waypoint, waypoints
from teleop.planner.keyframes.segment import Segment
from teleop.planner.polynomial import Array

PASSES = 1  # of a repeated leg that tell of all, beside the first interval and what is left over

Points = Sequence[Waypoint]


def legs(axis: Axis, keys: Sequence[Key]) -> list[Points]:
    """The points from each rest of an axis to the next; a dwell is one too."""
    points = waypoints(axis, keys)
    rests = [number for number, point in enumerate(points) if point.rest]
    return [points[first : last + 1] for first, last in pairwise(rests)]


def segment_of(points: Sequence[Waypoint]) -> Segment:
    """Times and positions only."""
    return Segment(
        np.array([point.time for point in points], float), np.array([point.position for point in points], float)
    )


def last_alike(some: Sequence[Waypoint], others: Sequence[Waypoint]) -> bool:
    """Whether the intervals of two legs last the same."""
    return all(abs(a - b) < SAME_TIME for a, b in zip(durations(some), durations(others), strict=True))


def durations(points: Sequence[Waypoint]) -> list[float]:
    """Of the intervals of a leg, in s."""
    return [last.time - first.time for first, last in pairwise(points)]


def at_durations(points: Points, seconds: Array) -> Points:
    """The points, with their intervals lasting so long."""
    times = points[0].time + np.concatenate([[0.0], np.cumsum(seconds)])
    return [point._replace(time=time) for point, time in zip(points, times.tolist(), strict=True)]


def pairs(points: Points) -> list[object]:
    """What each interval lies between, whichever way it is gone; where keys have no names, its number."""
    return [frozenset((a.where, b.where)) if a.where and b.where else i for i, (a, b) in enumerate(pairwise(points))]


def shortened(points: Points) -> tuple[Points, list[int]]:
    """A leg that repeats itself, with a few passes only, and for each interval the one of these that it is like."""
    between, period = pairs(points), _period(points)
    count = len(between)
    dropped = (count - 1) // period * period - PASSES * period
    if dropped <= 0:
        return points, list(range(count))
    middle = 1 + PASSES // 2 * period
    later = points[middle + dropped :]
    shift = later[0].time - points[middle].time
    short = [*points[:middle], *(point._replace(time=point.time - shift) for point in later)]
    first: dict[object, int] = {}
    for index, pair in enumerate(pairs(short)):
        first.setdefault(pair, index)
    return short, [first[pair] for pair in between]


def _period(points: Points) -> int:
    """After how many intervals the leg is the same again, whatever its first one is; its own length if it never is."""
    ways = [(first.where, last.where) for first, last in pairwise(points)][1:]
    if all(all(way) for way in ways):
        for period in range(1, len(ways) // 2 + 1):
            if ways[period] == ways[0] and ways[period:] == ways[:-period]:
                return period
    return len(ways) + 1

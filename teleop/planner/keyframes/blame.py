"""Which limit is in the way between two keys, and by how much: findings from bounds and from times that were found."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from teleop.core.axes import Axis, Limits
from teleop.planner.keyframes.bounds import factors_needed, least_time
from teleop.planner.keyframes.findings import AT_LIMIT, Finding, Unsolved
from teleop.planner.keyframes.keys import Waypoint
from teleop.planner.keyframes.legs import segment_of
from teleop.planner.keyframes.program import TOLERANCE
from teleop.planner.keyframes.windows import WHOLE, tightness
from teleop.planner.polynomial import Array

LIMITS = ("velocity", "acceleration", "jerk")
ORDERS = np.arange(1, 4)


def timed(axis: Axis, points: Sequence[Waypoint], limits: Limits, interval: int, shortest: float) -> Finding:
    """The finding for an interval of a leg that needs `shortest` seconds."""
    segment = segment_of(points)
    had = float(segment.durations[interval])
    limit, factor = _most(factors_needed(segment, limits)[interval], shortest / had)
    return Finding(axis, points[interval].where, points[interval + 1].where, LIMITS[limit], factor, had, shortest)


def _most(factors: Array, longer: float) -> tuple[int, float]:
    """The limit (0..2) that takes the most time, and by what it is exceeded: all of it in a way `longer` times."""
    limit = int(np.argmax(factors ** (1 / ORDERS)))
    factor = float(factors[limit])
    return limit, max(factor, longer) if limit == 0 or factor < AT_LIMIT else factor


def untimed(axis: Axis, points: Sequence[Waypoint], limits: Limits) -> Iterator[tuple[int, Finding | Unsolved]]:
    """The findings of a leg whose times were not searched for, and their intervals: what the bounds know of it.

    Of a long leg at least the tightest place is known.
    """
    segment = segment_of(points)
    factors = factors_needed(segment, limits)
    blamed = np.flatnonzero(factors.max(axis=1) > TOLERANCE).tolist()
    if not blamed and len(points) > WHOLE + 1:
        blamed = [int(np.argmax(tightness(segment, limits)))]
    for interval in blamed:
        had = float(segment.durations[interval])
        limit, factor = _most(factors[interval], 1.0)
        least = least_time(segment, limits, interval)
        ends = points[interval].where, points[interval + 1].where
        yield interval, Finding(axis, *ends, LIMITS[limit], factor, had, least=least if least > had else None)
    if not blamed:
        yield len(points) - 2, Unsolved(axis, points[0].where, points[-1].where)

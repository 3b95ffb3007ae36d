"""Where a long leg is tight: the intervals that need fine pieces or more time, with some of their neighbors.

What one interval asks for has an effect only within a few intervals. So a long leg is cut finely, and searched, in
windows, and the cost of a tight place does not grow with the number of keys.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from teleop.core.axes import Limits
from teleop.planner.keyframes.bounds import factors_needed
from teleop.planner.keyframes.legs import Points, segment_of
from teleop.planner.keyframes.mesh import Indices
from teleop.planner.keyframes.program import TOLERANCE
from teleop.planner.keyframes.segment import Segment
from teleop.planner.polynomial import Array

WHOLE = 20  # intervals: a leg that has no more is searched as a whole
BESIDE = 4  # intervals on either side of one at fault
NEARLY = 0.8  # of the worst factor: the suspects of a leg in which the bounds find no fault
TIGHT = 0.5  # of what the limits allow: from here on an interval may have to overshoot
GRADES = (0.3, 4), (0.55, 8)  # from which factor on an interval has so many pieces, else COARSE
COARSE = 2


def windows(points: Points, limits: Limits) -> list[tuple[int, int]]:
    """First and last key (from 0) of each window of a leg, in order; they do not overlap."""
    count = len(points) - 1
    if count <= WHOLE:
        return [(0, count)]
    segment = segment_of(points)
    tight = tightness(segment, limits)
    return around(tight > min(TOLERANCE, NEARLY * float(tight.max())))


def tightness(segment: Segment, limits: Limits) -> Array:
    """Per interval (n,) at least how much of the limits a way without overshoot takes: above 1 there is none."""
    return factors_needed(segment, limits, directed=True).max(axis=1)


def graded(tight: Array) -> Indices:
    """Pieces (n,) of the intervals of a long leg: more where they are tight, and beside those."""
    pieces = np.full(len(tight), COARSE)
    for least, fine in GRADES:
        pieces[spread(tight > least)] = fine
    return pieces


def around(suspect: NDArray[np.bool_]) -> list[tuple[int, int]]:
    """First and last key of each window about the suspects (n,)."""
    count, found = len(suspect), []
    for interval in np.flatnonzero(suspect).tolist():
        first, last = max(interval - BESIDE, 0), min(interval + BESIDE + 1, count)
        if found and first <= found[-1][1]:
            first = found.pop()[0]
        found.append((first, last))
    return found


def spread(marked: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Those marked, and the one on either side of each."""
    return marked | np.concatenate([marked[1:], [False]]) | np.concatenate([[False], marked[:-1]])

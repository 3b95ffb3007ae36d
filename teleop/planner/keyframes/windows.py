"""Where a leg is at fault: the intervals whose times are to be searched for, with some of their neighbors.

What one interval asks for has an effect only within a few intervals. So a long leg is searched in windows, and the cost
of a finding does not grow with the number of keys.
"""

from __future__ import annotations

import numpy as np

from teleop.core.axes import Limits
from teleop.planner.keyframes.bounds import factors_needed
from teleop.planner.keyframes.legs import Points, segment_of
from teleop.planner.keyframes.program import TOLERANCE

WHOLE = 20  # intervals: a leg that has no more is searched as a whole
BESIDE = 4  # intervals on either side of one at fault
NEARLY = 0.8  # of the worst factor: the suspects of a leg in which the bounds find no fault


def windows(points: Points, limits: Limits) -> list[tuple[int, int]]:
    """First and last key (from 0) of each window of a leg, in order; they do not overlap."""
    count = len(points) - 1
    if count <= WHOLE:
        return [(0, count)]
    worst = factors_needed(segment_of(points), limits).max(axis=1)
    found: list[tuple[int, int]] = []
    suspect = TOLERANCE if worst.max() > TOLERANCE else NEARLY * float(worst.max())
    for interval in np.flatnonzero(worst > suspect).tolist():
        first, last = max(interval - BESIDE, 0), min(interval + BESIDE + 1, count)
        if found and first <= found[-1][1]:
            first = found.pop()[0]
        found.append((first, last))
    return found

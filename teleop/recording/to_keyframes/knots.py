"""The keys of a move of even speed, found in how its jerk changes: for a take that a sequence made.

Such a plan has a knot at each key and in the middle between two keys, and its jerk jumps at each knot. A hand at a
stick leaves no such pattern; what is found there is tried like any other keys, and fails.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from teleop.planner.polynomial import Array

JUMP = 1e-3  # of the largest jump of jerk: a smaller one is rounding
NEAR = 1  # places: knots lie between those of the grid
MANY = 200  # knots of an axis; more are the noise of a hand


def knots(acceleration: Array) -> Sequence[int]:
    """The places where the jerk jumps, rising; none where they are too many for a plan."""
    jumps = np.abs(np.diff(acceleration, 2))
    if len(jumps) < 3:
        return []
    inner = jumps[1:-1]
    peaks = (inner >= jumps[:-2]) & (inner > jumps[2:]) & (inner > JUMP * jumps.max())
    found = (np.flatnonzero(peaks) + 2).tolist()
    return found if len(found) <= MANY else []


def planned_keys(knots: Sequence[int], begin: int, end: int) -> Iterator[int]:
    """The keys between two rests: from each the next one is the first that has a knot half way to it."""
    inside = [knot for knot in knots if begin < knot < end]
    last = begin
    for knot in inside:
        middle = (last + knot) / 2
        if any(abs(other - middle) <= NEAR for other in inside):
            yield knot
            last = knot

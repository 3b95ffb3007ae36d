"""What the limits leave a correction of a track, as bounds on the coefficients of its spline.

A correction is also kept small where the move itself hardly moves: what a pass measures there is a hand, a slip or
noise, and nothing of it may move an axis that is to stand still.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from teleop.core.axes import Limits
from teleop.learning.basis import ORDERS, Basis, Numbers
from teleop.planner.offset_track import is_within, spans
from teleop.planner.polynomial import Array
from teleop.planner.trajectory import Peaks, Track

USED = 0.999  # of a limit: the rest is for rounding
INSIDE = 1e-6  # units from a soft limit, likewise
STILL = 0.2  # units where the move rests: backlash, and a gimbal's grid
SECONDS = 0.5  # s of the fastest motion nearby: no gimbal is later than that
NEARBY = 0.6  # s


class Room:
    """`bounds` has the least and the greatest coefficient of each order, of a correction of `track`."""

    def __init__(self, track: Track, limits: Limits, basis: Basis) -> None:
        least, greatest = spans(track, basis.knots)
        most = limits.velocity, limits.acceleration, limits.jerk
        lows = [limits.minimum + INSIDE, *(-USED * each for each in most)]
        highs = [limits.maximum - INSIDE, *(USED * each for each in most)]
        near = _nearby(np.maximum(-least[1], greatest[1]), basis.knots)
        self.bounds: list[tuple[Array, Array]] = []
        for order in range(ORDERS):
            first, last = basis.supports(order)
            below = np.minimum(lows[order] - least[order], 0.0)
            above = np.maximum(highs[order] - greatest[order], 0.0)
            if order == 0:
                below, above = np.maximum(below, -near), np.minimum(above, near)
            self.bounds.append((_over(np.maximum, below, first, last), _over(np.minimum, above, first, last)))


def fits(peaks: Peaks, limits: Limits) -> bool:
    """Whether a corrected track keeps its limits."""
    return is_within(peaks, limits, INSIDE)


def _nearby(speeds: Array, knots: Array) -> Array:
    """The greatest offset (n,) in each span, by the highest speeds within NEARBY of it."""
    middles = (knots[:-1] + knots[1:]) / 2
    first = np.searchsorted(middles, middles - NEARBY)
    last = np.searchsorted(middles, middles + NEARBY)
    return STILL + SECONDS * _over(np.maximum, speeds, first, last)


def _over(least_or_most: np.ufunc, values: Array, first: Numbers, last: Numbers) -> Array:
    """The least or the most of `values` within each [first, last)."""
    ranges: Sequence[tuple[int, int]] = list(zip(first.tolist(), last.tolist(), strict=True))
    return np.array([least_or_most.reduce(values[low:high]) for low, high in ranges])

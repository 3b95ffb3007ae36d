"""A track and an offset added to it, exactly, and the room that the limits leave an offset.

Both are quintics between breaks, so their sum is one between the breaks of both: what plays, scales and checks a track
does so with the sum, and needs to know nothing of its parts.
"""

from __future__ import annotations

from math import comb

import numpy as np

from teleop.core.axes import Limits
from teleop.planner.polynomial import Array, extremes
from teleop.planner.trajectory import Peaks, Track

SAME = 1e-9  # s: two breaks that are closer are one
ROUNDED = 1 + 1e-9  # relative, what rounding may add to a limit
_SHIFT = np.array([[comb(power, k) if power >= k else 0 for power in range(6)] for k in range(6)], dtype=float)


def added(track: Track, offset: Track) -> Track:
    """The sum of a track and an offset, in units."""
    breaks = _joined(track.breaks, offset.breaks)
    coefficients = _pieces(track, breaks) + _pieces(offset, breaks)
    return Track(breaks, coefficients, track.end + offset.end)


def spans(track: Track, edges: Array) -> tuple[Array, Array]:
    """Least and greatest (4, n) of position to jerk of a track between `edges` (n + 1,) in s, rising."""
    inside = track.breaks[(track.breaks > edges[0] + SAME) & (track.breaks < edges[-1] - SAME)]
    breaks = _joined(edges, inside)
    least, greatest = extremes(_pieces(track, breaks), np.diff(breaks))
    first = np.searchsorted(breaks, edges[:-1])
    return np.minimum.reduceat(least, first, axis=1), np.maximum.reduceat(greatest, first, axis=1)


def is_within(peaks: Peaks, limits: Limits, slack: float) -> bool:
    """Whether a track with these peaks keeps the limits; its positions, but for `slack` units."""
    return (
        peaks.velocity <= limits.velocity * ROUNDED
        and peaks.acceleration <= limits.acceleration * ROUNDED
        and peaks.jerk <= limits.jerk * ROUNDED
        and peaks.minimum >= limits.minimum - slack
        and peaks.maximum <= limits.maximum + slack
    )


def _joined(first: Array, second: Array) -> Array:
    """The breaks of both; of two that are the same, the first's."""
    nearest = np.clip(np.searchsorted(first, second), 1, max(len(first) - 1, 1))
    before, after = first[nearest - 1], first[np.minimum(nearest, len(first) - 1)]
    apart = np.minimum(np.abs(second - before), np.abs(second - after)) > SAME
    return np.union1d(first, second[apart])


def _pieces(track: Track, breaks: Array) -> Array:
    """The coefficients (n, 6) of a track between `breaks` (n + 1,), each in its own local time."""
    starts, middles = breaks[:-1], (breaks[:-1] + breaks[1:]) / 2
    index = np.searchsorted(track.breaks, middles, side="right") - 1
    pieces = np.zeros((len(starts), 6))
    pieces[:, 0] = np.where(index < 0, track.start, track.end)
    moving = (index >= 0) & (index < len(track.coefficients))
    old = track.coefficients[index[moving]]
    shift = starts[moving] - track.breaks[index[moving]]
    powers = shift[:, None] ** np.arange(6)
    for k in range(6):
        pieces[moving, k] = sum(_SHIFT[k, i] * old[:, i] * powers[:, i - k] for i in range(k, 6))
    return pieces

"""A track as few enough points to draw.

Points are spread over the pieces of the polynomial, not over time: a second's move in the middle of a day gets as many
as the hours around it, so a page can be zoomed to wherever something happens. Jerk steps between pieces, so each piece
brings both its ends, the later one a rounding error early. Only when there are more pieces than points is something
dropped, and then every bucket keeps the least and the greatest of all four quantities: no peak goes missing.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from teleop.planner.polynomial import Array
from teleop.planner.trajectory import Track

QUANTITIES = ("position", "velocity", "acceleration", "jerk")
"""The rows of a curve, in the axis's unit, unit/s, unit/s2 and unit/s3."""

MOST = 4000  # points of a curve: four for each pixel of a wide plot
FINEST = 128  # points of a piece: a quintic drawn with more looks no smoother, zoomed in tenfold
COARSEST = 9  # points of a piece, where there are many: its jerk, a parabola, is met within 1 % of its height


class Curve(NamedTuple):
    """`times` (m,) in seconds, ascending, and `rows` (4, m): one of QUANTITIES each. m is at most MOST."""

    times: Array
    rows: Array


def curve(track: Track, duration: float) -> Curve:
    """`track` from 0 to `duration` seconds, to be joined by straight lines."""
    times = _times(track, duration)
    rows = track.sample(times)
    if len(times) > MOST:
        kept = outline(rows)
        return Curve(times[kept], rows[:, kept])
    return Curve(times, rows)


def _times(track: Track, duration: float) -> Array:
    """Both ends of every piece and, where it moves, points between them; the rests before and after."""
    breaks, pieces = track.breaks, len(track.coefficients)
    before = [] if breaks[0] <= 0 else [0.0, np.nextafter(breaks[0], 0)]
    around = [*before, breaks[-1], max(duration, breaks[-1])]
    if pieces == 0:
        return np.unique(around)
    starts, ends = breaks[:-1], np.nextafter(breaks[1:], breaks[:-1])
    share = np.linspace(0, 1, int(np.clip((MOST - 4) // pieces, COARSEST, FINEST)))
    inside = starts[:, None] + (ends - starts)[:, None] * share
    inside[:, -1] = ends
    needed = np.ones(inside.shape, dtype=bool)
    needed[~track.coefficients[:, 1:].any(axis=1), 1:-1] = False
    return np.unique(np.concatenate([around, inside[needed]]))


def outline(rows: Array) -> NDArray[np.intp]:
    """Ascending indices of at most MOST columns of `rows` (k, m) that keep its shape: the extremes of each bucket."""
    columns = rows.shape[1]
    buckets = (MOST - 2) // (2 * len(rows))
    size = -(-columns // buckets)
    index = np.minimum(np.arange(buckets * size), columns - 1).reshape(buckets, size)
    found = rows[:, index]
    extremes = [np.take_along_axis(index, pick[:, None], 1) for row in found for pick in (row.argmin(1), row.argmax(1))]
    return np.unique(np.concatenate([[0, columns - 1], *(each.ravel() for each in extremes)]))

"""The ways of an imported path, from rest to rest, on an even grid of frames, and how few keys one needs."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from fractions import Fraction

import numpy as np

from teleop.app.imported_keys import DIGITS, RESTED, SECONDS
from teleop.core.axes import Axis
from teleop.interchange.motion import Motion
from teleop.planner.keyframes.fit import SampledSegment, Style, fit_through, turning_points
from teleop.planner.keyframes.frame_keys import Frames, Keys
from teleop.planner.keyframes.frames import FramesFit
from teleop.planner.polynomial import Array

FASTEST_GRID = 60  # frames a second that a path with times of its own is looked at


def fewer(table: Frames, found: FramesFit, rate: float) -> Keys:
    """The keys of an axis on a way, without those between its turns where the planner itself goes by the frames."""
    keys = found.keys[table.axis]
    if found.runs.up or found.runs.out or len(keys) < 3 or np.isnan(table.positions).any():
        return keys
    digits = DIGITS[table.axis.is_angle]
    style = Style(table.axis, table.limits, table.tolerance, digits, 0.0, rate, 1, math.inf)
    turns = turning_points(table.positions, table.tolerance)
    sparse = fit_through(SampledSegment(0, table.positions, style), list(turns))
    return sparse.keys if sparse is not None and len(sparse.keys) < len(keys) else keys


def own_grid(times: Array) -> Fraction:
    """Frames a second for rows that have times and no rate: as near as most are, to a thousandth of a second."""
    if len(times) < 2:
        return Fraction(1)
    step = max(round(float(np.median(np.diff(times))) * SECONDS), math.ceil(SECONDS / FASTEST_GRID))
    return Fraction(SECONDS, step)


def ways_of(motion: Motion, still: Mapping[Axis, float], rate: float) -> Iterator[tuple[int, int]]:
    """From which frame to which something moves; between them all axes rest for a while."""
    last = len(motion.times) - 1
    rests = np.ones(last, dtype=bool)
    for axis, column in motion.positions.items():
        rests &= np.abs(np.diff(column)) <= still[axis]  # of nan and a number: it is not known to rest
    edges = np.flatnonzero(np.diff(np.concatenate([[False], rests, [False]])))
    begin = 0
    for first, end in zip(edges[::2].tolist(), edges[1::2].tolist(), strict=True):
        if (end - first) / rate < RESTED and first > 0 and end < last:
            continue
        if first > begin:
            yield begin, first
        begin = end
    if begin < last or last == 0:
        yield begin, last

"""Warnings about a planned segment: overshoots, and ramps longer than asked for."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from teleop.core.axes import Axis
from teleop.planner.keyframes.findings import LongRamp, Overshoot
from teleop.planner.keyframes.segment import Segment
from teleop.planner.polynomial import Array, extremes

LATE = 1.1  # a ramp this many times as long as asked for is reported; 0 asks for the shortest possible, and never is
VISIBLE = 1e-3  # units: a smaller overshoot is not reported


def overshoots(
    axis: Axis, segment: Segment, names: Sequence[str], widths: Array, coefficients: Array
) -> list[Overshoot]:
    """By how much each interval leaves the range of its two keys, where that can be seen."""
    least, greatest = extremes(coefficients, widths)
    middles = segment.times[0] + np.cumsum(widths) - widths / 2
    interval = np.searchsorted(segment.times, middles) - 1
    low = np.minimum(segment.positions[:-1], segment.positions[1:])[interval]
    high = np.maximum(segment.positions[:-1], segment.positions[1:])[interval]
    excess = np.maximum(low - least[0], greatest[0] - high)
    sizes = np.zeros(len(segment.steps))
    np.maximum.at(sizes, interval, excess)
    return [Overshoot(axis, names[i], names[i + 1], float(sizes[i])) for i in np.flatnonzero(sizes > VISIBLE).tolist()]


def long_ramps(axis: Axis, segment: Segment, names: Sequence[str], asked: tuple[float, float]) -> list[LongRamp]:
    """The ramps that the limits make longer than the seconds `asked` for at its start and end."""
    return [
        LongRamp(axis, where, wanted, taken)
        for where, wanted, taken in zip((names[0], names[-1]), asked, segment.ramps or asked, strict=True)
        if 0 < wanted * LATE < taken
    ]

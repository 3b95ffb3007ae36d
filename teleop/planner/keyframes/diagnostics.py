"""What a planned leg does that was not quite asked for, worth a warning."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from teleop.core.axes import Axis
from teleop.planner.keyframes.findings import LongRamp, Overshoot
from teleop.planner.keyframes.segment import Segment
from teleop.planner.polynomial import Array, extremes

LATE = 1.1  # a ramp this many times as long as asked for is worth a word; one of 0 asks for the shortest there is
VISIBLE = 1e-3  # units: what passes a key by less is met


def overshoots(axis: Axis, leg: Segment, wheres: Sequence[str], widths: Array, coefficients: Array) -> list[Overshoot]:
    """By how much each segment leaves the range of its two keys, where that can be seen."""
    least, greatest = extremes(coefficients, widths)
    middles = leg.times[0] + np.cumsum(widths) - widths / 2
    segment = np.searchsorted(leg.times, middles) - 1
    low = np.minimum(leg.positions[:-1], leg.positions[1:])[segment]
    high = np.maximum(leg.positions[:-1], leg.positions[1:])[segment]
    excess = np.maximum(low - least[0], greatest[0] - high)
    sizes = np.zeros(len(leg.steps))
    np.maximum.at(sizes, segment, excess)
    return [
        Overshoot(axis, wheres[i], wheres[i + 1], float(sizes[i])) for i in np.flatnonzero(sizes > VISIBLE).tolist()
    ]


def long_ramps(axis: Axis, leg: Segment, wheres: Sequence[str], asked: tuple[float, float]) -> list[LongRamp]:
    """The ramps that the limits make longer than the seconds `asked` for at its start and end."""
    return [
        LongRamp(axis, where, wanted, taken)
        for where, wanted, taken in zip((wheres[0], wheres[-1]), asked, leg.ramps or asked, strict=True)
        if 0 < wanted * LATE < taken
    ]

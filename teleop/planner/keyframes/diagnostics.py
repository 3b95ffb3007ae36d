"""Warnings about a planned segment: overshoots, and ramps longer than asked for."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from teleop.core.axes import Axis
from teleop.planner.keyframes.evenness import stills
from teleop.planner.keyframes.findings import LongRamp, Overshoot, Standstill
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


def long_ramps(axis: Axis, segment: Segment, names: Sequence[str], asked: Array) -> list[LongRamp]:
    """The ramps that the limits make longer than the seconds `asked` for (n + 1, 2), the longest one at each key."""
    found: dict[str, LongRamp] = {}
    ramps = asked if segment.ramps is None else segment.ramps
    for key, side in np.argwhere((asked > 0) & (asked * LATE < ramps)).tolist():
        ramp = LongRamp(axis, names[key], float(asked[key, side]), float(ramps[key, side]))
        known = found.get(ramp.last)
        found[ramp.last] = ramp if known is None or known.taken < ramp.taken else known
    return list(found.values())


def standstills(
    axis: Axis, segment: Segment, names: Sequence[str], widths: Array, coefficients: Array
) -> list[Standstill]:
    """The intervals that are almost at rest for long, once each where a repeat goes through them several times."""
    seconds = stills(segment, widths, coefficients)
    found: dict[frozenset[str], Standstill] = {}
    for i in np.flatnonzero(seconds).tolist():
        found.setdefault(frozenset(names[i : i + 2]), Standstill(axis, names[i], names[i + 1], float(seconds[i])))
    return list(found.values())

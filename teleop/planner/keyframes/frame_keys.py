"""Few keys for one axis that a table gives by the frame: at speed in its first row, and with noise.

First the smoothest positions within the tolerance are found (`smoothing`), with frames before and after the table in
which the axis gets up to speed and comes to rest. Keys are put on those: where the axis turns back, and where the
curve of least jerk through the keys so far is furthest off. Those it can do without are taken away again. Only then are
they planned as `play` will do it (`fit`), with more keys where a limit makes the plan leave that curve.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from teleop.core.axes import Axis, Limits
from teleop.planner.keyframes.fit import SampledSegment, Style, refined, turning_points
from teleop.planner.keyframes.minimum_jerk import minimum_jerk
from teleop.planner.keyframes.smoothing import smoothest
from teleop.planner.polynomial import Array

FILLED = 0.9  # of the tolerance, for the curve of least jerk: the plan differs a little from it
TURN = 0.5  # of the tolerance: an axis that turns back by less does not need a key there
DIGITS = 9  # behind the point of a key's position: no file has it

Keys = Mapping[int, float]  # place, in frames from the table's first one on -> units


class Runs(NamedTuple):
    """Frames before the table to get up to speed in, and after it to come to rest in."""

    up: int
    out: int


class Slack(NamedTuple):
    """What the smoothest positions may use: shares of the tolerance and of the limits."""

    tolerance: float
    limits: float


@dataclass(frozen=True, eq=False)
class Frames:
    """An axis by the frame: `positions` (n,) in units, NaN for a frame that the table does not have.

    Each is to be met within `tolerance` units.
    """

    axis: Axis
    positions: Array
    tolerance: float
    limits: Limits

    def smooth(
        self, step: float, slack: Slack, runs: Runs, rests: tuple[bool, bool] = (True, True)
    ) -> Array | None:
        """The smoothest positions, those of the runs before and after included, with frames of `step` seconds.

        `rests` is whether the axis rests before and after. None where the limits leave no way.
        """
        band = slack.tolerance * self.tolerance
        up, out = runs
        low, high = np.full((2, up + len(self.positions) + out), np.nan)
        low[up : up + len(self.positions)] = np.maximum(self.positions - band, self.limits.minimum)
        high[up : up + len(self.positions)] = np.minimum(self.positions + band, self.limits.maximum)
        low[np.isnan(low)], high[np.isnan(high)] = self.limits.minimum, self.limits.maximum
        return smoothest(low, high, step, self.limits.scaled(slack.limits), rests)

    def free(self, step: float) -> Array:
        """The smoothest positions (n,) as they would be without limits."""
        band = self.tolerance / 2
        known = ~np.isnan(self.positions)
        low, high = (np.where(known, self.positions + side, side * np.inf) for side in (-band, band))
        found = smoothest(low, high, step, None, (False, False))
        assert found is not None  # the positions themselves would do
        return found

    def keys(self, smooth: Array, step: float, runs: Runs) -> Keys | None:
        """The keys on `smooth`; None where the planner cannot follow them."""
        targets = np.full(len(smooth), np.nan)
        targets[runs.up : len(smooth) - runs.out] = self.positions
        allowances = np.where(np.isnan(targets), np.inf, self.tolerance - np.abs(smooth - np.nan_to_num(targets)))
        style = Style(self.axis, self.limits, self.tolerance, DIGITS, 0.0, 1 / step, 1)
        segment = SampledSegment(-runs.up, smooth, style, allowances)
        if np.ptp(smooth) <= TURN * self.tolerance:
            return {-runs.up: segment.position(-runs.up)}
        keys = {place: segment.position(place) for place in self._places(segment, targets, runs)}
        found = refined(segment, keys, segment.off(keys))
        near = found.off is not None and segment.fits(found.off)
        return dict(sorted(found.keys.items())) if near else None

    def _places(self, segment: SampledSegment, targets: Array, runs: Runs) -> Iterator[int]:
        """Where keys are needed for the curve of least jerk."""
        curve = _Curve(segment.positions, targets, FILLED * self.tolerance)
        last = len(targets) - 1
        inside = slice(runs.up, last + 1 - runs.out)
        turns = [runs.up + turn for turn in turning_points(segment.positions[inside], TURN * self.tolerance)]
        fixed = sorted({0, *turns, last})
        places = sorted({*fixed, runs.up, last - runs.out})
        while more := curve.worst(places):
            places = sorted({*places, *more})
        for place in [place for place in places if place not in fixed]:
            fewer = [each for each in places if each != place]
            if not curve.worst(fewer):
                places = fewer
        return (place + segment.begin for place in places)


@dataclass(frozen=True, eq=False)
class _Curve:
    """Curves through some of `smooth` (n,), which are to be within `allowed` units of `targets` (n,), NaN: anywhere."""

    smooth: Array
    targets: Array
    allowed: float

    def worst(self, places: list[int]) -> list[int]:
        """Between each two places where the curve is off by too much, the place where it is furthest off."""
        index = np.arange(len(self.smooth), dtype=float)
        curve = minimum_jerk(np.array(places, float), self.smooth[places], index)
        off = np.nan_to_num(np.abs(curve - self.targets))
        if off.max() <= self.allowed:
            return []
        found = []
        for first, second in pairwise(places):
            inner = off[first + 1 : second]
            if inner.size and inner.max() > self.allowed:
                found.append(first + 1 + int(inner.argmax()))
        return found

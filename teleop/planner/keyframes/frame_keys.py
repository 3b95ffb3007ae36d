"""Few keys for one axis that a table gives by the frame: at speed in its first row, and with noise.

First the smoothest positions within the tolerance are found (`smoothing`), with frames before and after the table in
which the axis gets up to speed and comes to rest. Keys are put on those: where the axis turns back, and where the
curve of least jerk through the keys so far is furthest off. Those it can do without are taken away again. Only then are
they planned as `play` will do it (`fit`), with more keys where a limit makes the plan leave that curve.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from teleop.core.axes import Axis, Limits
from teleop.planner.keyframes.fit import SampledSegment, Style, turning_points, worst_places
from teleop.planner.keyframes.minimum_jerk import minimum_jerk
from teleop.planner.keyframes.program import HEADROOM
from teleop.planner.keyframes.smoothing import smoothest
from teleop.planner.polynomial import Array

FILLED = 0.9  # of the tolerance, for the curve of least jerk: the plan differs a little from it
TURN = 0.5  # of the tolerance: an axis that turns back by less does not need a key there
PLANNABLE = 1.1  # times slower than it is: with so little excess the planner may still find another curve
ROUNDS = 5  # of plans with ever more keys, where a limit makes the plan leave the curve of least jerk
DIGITS = 9  # behind the point of a key's position: no file has it

Keys = Mapping[int, float]  # place, in frames from the table's first one on -> units


class Runs(NamedTuple):
    """Frames before the table to get up to speed in, and after it to come to rest in.

    In the `steady` ones next to the table an axis keeps the speed of its first or last frame.
    """

    up: int
    out: int
    steady: int = 0


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

    def smooth(self, step: float, slack: Slack, runs: Runs, rests: tuple[bool, bool] = (True, True)) -> Array | None:
        """The smoothest positions, those of the runs before and after included, with frames of `step` seconds.

        `rests` is whether the axis rests before and after. None where the limits leave no way.
        """
        band = slack.tolerance * self.tolerance
        targets = self._targets(runs)
        low = np.fmax(targets - band, self.limits.minimum)  # of nan and a number, the number
        high = np.fmin(targets + band, self.limits.maximum)
        limits = None if np.isinf(slack.limits) else self.limits.scaled(slack.limits)
        return smoothest(low, high, step, limits, rests)

    @cached_property
    def free(self) -> Array:
        """The smoothest positions (n,) as they would be without limits."""
        band = self.tolerance / 2
        known = ~np.isnan(self.positions)
        low, high = (np.where(known, self.positions + side, side * np.inf) for side in (-band, band))
        found = smoothest(low, high, 1.0, None, (False, False))
        assert found is not None  # the positions themselves would do
        return found

    def places(self, smooth: Array, runs: Runs, *, few: bool = True) -> list[int]:
        """Indices of `smooth` where keys are needed for the curve of least jerk; as `few` as do takes longer."""
        curve = _Curve(smooth, self._targets(runs), FILLED * self.tolerance)
        last = len(smooth) - 1
        inside = slice(runs.up, last + 1 - runs.out)
        turns = [runs.up + turn for turn in turning_points(smooth[inside], TURN * self.tolerance)]
        fixed = sorted({0, *turns, last})
        places = sorted({*fixed, runs.up, last - runs.out})
        while more := curve.worst(places):
            places = sorted({*places, *more})
        for place in [place for place in places if few and place not in fixed]:
            fewer = [each for each in places if each != place]
            if not curve.worst(fewer):
                places = fewer
        return places

    def excess(self, smooth: Array, places: Sequence[int], step: float) -> float:
        """How many times slower the curve of least jerk through these places has to be for the limits."""
        if len(places) < 2:
            return 0.0
        peaks, limits = minimum_jerk(np.array(places) * step, smooth[places]).peaks(), self.limits.scaled(HEADROOM)
        return max(
            peaks.velocity / limits.velocity,
            (peaks.acceleration / limits.acceleration) ** (1 / 2),
            (peaks.jerk / limits.jerk) ** (1 / 3),
        )

    def keys(self, smooth: Array, step: float, runs: Runs) -> Keys | None:
        """The keys on `smooth`; None where the planner cannot follow them."""
        targets = self._targets(runs)
        allowances = np.where(np.isnan(targets), np.inf, self.tolerance - np.abs(smooth - np.nan_to_num(targets)))
        style = Style(self.axis, self.limits, self.tolerance, DIGITS, 0.0, 1 / step, 1, np.inf)
        segment = SampledSegment(-runs.up, smooth, style, allowances)
        if np.ptp(smooth) <= TURN * self.tolerance:
            return {-runs.up: segment.position(-runs.up)}
        places = self.places(smooth, runs)
        if self.excess(smooth, places, step) > PLANNABLE:
            return None
        keys = {place - runs.up: segment.position(place - runs.up) for place in places}
        for _ in range(ROUNDS):
            off = segment.off(keys)
            if off is None or segment.fits(off):
                return None if off is None else dict(sorted(keys.items()))
            keys |= {place: segment.position(place) for place in worst_places(segment, keys, off)}
        return None

    def _targets(self, runs: Runs) -> Array:
        """The positions with those of the runs before and after, NaN where they are free.

        It goes on at the table's own speed for a few frames, so that it is at speed in the first and the last one.
        """
        up, out, steady = runs
        targets = np.full(up + len(self.positions) + out, np.nan)
        targets[up : up + len(self.positions)] = self.positions
        if len(self.free) > 1:
            first, last = self.free[1] - self.free[0], self.free[-1] - self.free[-2]
            for place in range(1, 1 + min(steady, up // 2)):
                targets[up - place] = self._reachable(self.free[0] - place * first)
            for place in range(min(steady, out // 2)):
                targets[up + len(self.positions) + place] = self._reachable(self.free[-1] + (place + 1) * last)
        return targets

    def _reachable(self, position: float) -> float:
        return position if self.limits.minimum <= position <= self.limits.maximum else np.nan


@dataclass(frozen=True, eq=False)
class _Curve:
    """Curves through some of `smooth` (n,), which are to be within `allowed` units of `targets` (n,), NaN: anywhere."""

    smooth: Array
    targets: Array
    allowed: float

    def worst(self, places: Sequence[int]) -> Sequence[int]:
        """Between each two places where the curve is off by too much, the place where it is furthest off."""
        index = np.arange(len(self.smooth), dtype=float)
        curve = minimum_jerk(index[places], self.smooth[places]).sample(index)[0]
        off = np.nan_to_num(np.abs(curve - self.targets))
        if off.max() <= self.allowed:
            return []
        inner = [(first + 1, off[first + 1 : second]) for first, second in pairwise(places) if second > first + 1]
        return [first + int(between.argmax()) for first, between in inner if between.max() > self.allowed]

"""Few keys for one axis between two rests, so that the planner's own way through them stays by samples of it.

The samples are those of a take, or the frames of a table.

Keys are put where people would put them, where the axis turns back, and then where the plan is furthest off, until it
is nowhere off by more than is allowed. Every trial is a plan as `play` will make it: with the limits, nothing else
could tell what lies between two keys. Where a key on the samples themselves would ask for too much (a recording may use
all of a limit, a plan keeps headroom) it may lie a little beside them, towards what the planner would rather do.
"""

from __future__ import annotations

from bisect import bisect, bisect_left
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from teleop.core.axes import Axis, Limits
from teleop.planner.keyframes.planner import Key, attempt
from teleop.planner.keyframes.tension import Tension
from teleop.planner.polynomial import Array

MARGIN = 0.98  # of what is allowed: what a segment is off by itself and as a part of the whole may differ a little
ASIDE = (0.0, 0.5, 0.85)  # of what is allowed: how far beside the samples a key may lie
PRUNED = 40  # keys of a segment of which each is tried without: every trial plans all of the segment
SHARED = 0.2  # of the way to the next key: a key that another axis has that near is as good a place

Keys = Mapping[int, float]  # place of the grid -> units


@dataclass(frozen=True)
class Style:
    """How one axis is fitted: off by `allowed` units at most, keys with so many digits behind the point.

    There are `rate` places in a second, and at least `nearest` between two keys. `overshoot` is as that of a Key.
    """

    axis: Axis
    limits: Limits
    allowed: float
    digits: int
    tension: Tension
    rate: float
    nearest: int
    overshoot: float | None = None


@dataclass(frozen=True, eq=False)
class SampledSegment:
    """One axis from rest to rest: `positions` (n,) from place `begin` on.

    `allowances` (n,) are what each may be off (units, infinite where that does not matter), None: all alike.
    """

    begin: int
    positions: Array
    style: Style
    allowances: Array | None = None

    def position(self, place: int, aside: float = 0.0) -> float:
        """The position of a key there (units), rounded to the digits of the file and kept inside the soft limits."""
        wanted = round(float(self.positions[place - self.begin]) + aside, self.style.digits)
        return min(max(wanted, self.style.limits.minimum), self.style.limits.maximum)

    def off(self, keys: Keys) -> Array | None:
        """How far the plan through these keys is off, at every place (units); None where there is no plan."""
        planned = attempt(
            {
                self.style.axis: [
                    Key((place - self.begin) / self.style.rate, position, overshoot=self.style.overshoot)
                    for place, position in sorted(keys.items())
                ]
            },
            {self.style.axis: self.style.limits},
            self.style.tension,
        )
        if planned is None:
            return None
        return (
            planned.tracks[self.style.axis].sample(np.arange(len(self.positions)) / self.style.rate)[0] - self.positions
        )

    def shares(self, off: Array) -> Array:
        """How much of what is allowed each place is off: 1 is all of it."""
        return np.abs(off) / (self.style.allowed if self.allowances is None else self.allowances)

    def fits(self, off: Array) -> bool:
        return bool(self.shares(off).max() <= MARGIN)


@dataclass(frozen=True, eq=False)
class Fit:
    """The keys of a segment, its ends included, and how far (n,) their plan is off; None where they have no plan."""

    keys: Keys
    off: Array | None


def fit(segment: SampledSegment, corners: Sequence[int], others: Sequence[int]) -> Fit:
    """As few keys as are found; too few, where no more of them bring the plan any nearer.

    `corners` are places worth a key where there is no turn.

    `others` are the places, rising, at which other axes have keys: one of them is as good as a place nearby.
    """
    last = segment.begin + len(segment.positions) - 1
    turns = [segment.begin + turn for turn in turning_points(segment.positions, segment.style.allowed)]
    ends: Keys = {place: segment.position(place) for place in (segment.begin, *turns, last)}
    apart = [corner for corner in corners if all(abs(corner - end) >= segment.style.nearest for end in ends)]
    keys = {**ends, **{place: segment.position(place) for place in apart}}
    off = segment.off(keys)
    if off is None:
        keys, off = ends, segment.off(ends)
    while off is not None and not segment.fits(off):
        more = {place: segment.position(place) for place in worst_places(segment, keys, off, others)}
        trial = {**keys, **more}
        better = segment.off(trial) if more else None
        if better is None:
            trial, better = _one_by_one(segment, keys, off, list(more))
        if len(trial) == len(keys):
            return Fit(keys, off)
        keys, off = trial, better
    return Fit(keys, off) if off is None else _pruned(segment, keys, off)


def fit_through(segment: SampledSegment, places: Iterable[int]) -> Fit | None:
    """With keys at those places, or fewer, should a plan through them be near enough; else None."""
    last = segment.begin + len(segment.positions) - 1
    keys: Keys = {place: segment.position(place) for place in (segment.begin, *places, last)}
    off = segment.off(keys)
    return None if off is None or not segment.fits(off) else _pruned(segment, keys, off)


def turning_points(positions: Array, least: float) -> Iterator[int]:
    """Where it turns back by more than `least` units, as indices: the extremes, with hysteresis."""
    values = positions.tolist()
    low = high = way = 0  # where it was lowest and highest since it last turned, and which way it has gone since
    for index, value in enumerate(values):
        low, high = (index if value < values[low] else low), (index if value > values[high] else high)
        if way >= 0 and value < values[high] - least:
            if way > 0:
                yield high
            way, low = -1, index
        elif way <= 0 and value > values[low] + least:
            if way < 0:
                yield low
            way, high = 1, index


def worst_places(segment: SampledSegment, keys: Keys, off: Array, others: Sequence[int] = ()) -> Iterator[int]:
    """Between each two keys where the plan is off by too much, the place where it is furthest off."""
    shares, nearest = segment.shares(off), segment.style.nearest
    for first, second in pairwise(sorted(keys)):
        between = shares[first - segment.begin : second - segment.begin + 1]
        if between.max() <= MARGIN or second - first < 2 * nearest:
            continue
        worst = min(max(first + int(between.argmax()), first + nearest), second - nearest)
        reach = round(SHARED * (second - first))
        low, high = max(first + nearest, worst - reach), min(second - nearest, worst + reach)
        shared = others[bisect_left(others, low) : bisect(others, high)]
        yield min(shared, key=lambda place, worst=worst: abs(place - worst), default=worst)


def _one_by_one(segment: SampledSegment, keys: Keys, off: Array, places: list[int]) -> tuple[Keys, Array]:
    """As many of the new keys as have a plan and bring it nearer, each where and as it can be."""
    for place in places:
        known = sorted(keys)
        index = bisect(known, place)
        first, second = known[index - 1], known[index]
        here = slice(first - segment.begin, second - segment.begin + 1)
        for other in (place, (place + first) // 2, (place + second) // 2):
            if min(other - first, second - other) < segment.style.nearest:
                continue
            pull = float(np.clip(off[other - segment.begin], -segment.style.allowed, segment.style.allowed))
            trials = ({**keys, other: segment.position(other, aside * pull)} for aside in ASIDE)
            found = ((trial, segment.off(trial)) for trial in trials)
            peak = segment.shares(off)[here].max()
            nearer = next(
                ((trial, new) for trial, new in found if new is not None and segment.shares(new)[here].max() < peak),
                None,
            )
            if nearer is not None:
                keys, off = nearer
                break
    return keys, off


def _pruned(segment: SampledSegment, keys: Keys, off: Array) -> Fit:
    """Without the keys that it can do without."""
    for place in sorted(keys)[1:-1] if len(keys) <= PRUNED else []:
        fewer = {other: position for other, position in keys.items() if other != place}
        without = segment.off(fewer)
        if without is not None and segment.fits(without):
            keys, off = fewer, without
    return Fit(keys, off)

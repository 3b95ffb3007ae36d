"""One segment's pieces, by a ladder of rules: few pieces first, then more, all without overshoot; then with the least.

Two equal keys next to each other are a rest as long as no overshoot is needed there, because the axis can only stand
still between them.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from teleop.core.axes import Limits
from teleop.planner.keyframes.evenness import stills, urged
from teleop.planner.keyframes.mesh import Indices
from teleop.planner.keyframes.overshoot import FINEST, NONE, least_overshoot, with_overshoot
from teleop.planner.keyframes.program import HEADROOM, TOLERANCE, Rule
from teleop.planner.keyframes.qp import solve
from teleop.planner.keyframes.segment import Segment
from teleop.planner.keyframes.tension import EVEN, Tension
from teleop.planner.keyframes.windows import COARSE, TIGHT, WHOLE, graded, tightness
from teleop.planner.polynomial import Array

PIECES = (2, 4, 8)
AROUND = 1  # intervals planned again on either side of one that would be almost at rest


class Pieces(NamedTuple):
    """Durations (m,) in s and coefficients (m, 6), ascending in local seconds."""

    widths: Array
    coefficients: Array

    def begin(self, times: Array) -> Array:
        """When each begins (m,); those at keys of `times` (n + 1,) exactly then, however many widths were added up."""
        starts = times[0] + np.concatenate([[0.0], np.cumsum(self.widths[:-1])])
        starts[self.at(times)] = times[:-1]
        return starts

    def at(self, times: Array) -> Indices:
        """The piece (n,) that begins at each key of `times` (n + 1,) but the last."""
        middles = times[0] + np.cumsum(self.widths) - self.widths / 2
        return np.searchsorted(middles, times[:-1])


class Overshot(NamedTuple):
    """A segment whose keys the limits allow only with more overshoot than is tolerated: the least of each interval."""

    least: Array


def is_easy(segment: Segment, limits: Limits, tension: Tension) -> bool:
    """Whether there is a plan without overshoot, for a search that asks often: by the finest rule alone.

    It can all that others can. Long ones, whose rules differ by place, are planned.
    """
    return directed(segment, limits, tension, finest=len(segment.steps) <= WHOLE) is not None


def is_tolerable(segment: Segment, limits: Limits, tension: Tension) -> bool:
    """Whether there seems to be one with as much overshoot as is tolerated; its least is not asked for."""
    if segment.is_loose or len(segment.steps) > WHOLE:
        return isinstance(overshooting(segment, limits, tension), Pieces)
    return solve(segment, limits, FINEST) is not None


def directed(segment: Segment, limits: Limits, tension: Tension, finest: bool = False) -> Pieces | None:
    """Without overshoot: cut where equal keys follow each other, each part by the coarsest rule that does.

    Or by the `finest` at once, and then as that finds it.
    """
    if np.any(np.abs(segment.steps) > HEADROOM * limits.velocity * segment.durations):
        return None
    flat = segment.steps == 0
    cuts = (np.flatnonzero(flat[:-1] | flat[1:]) + 1).tolist()
    parts = []
    for first, last in pairwise([0, *cuts, len(flat)]):
        part = _standing(segment, first) if flat[first] else _part(segment.part(first, last), limits, tension, finest)
        if part is None:
            return None
        parts.append(part)
    return Pieces(np.concatenate([p.widths for p in parts]), np.concatenate([p.coefficients for p in parts]))


def _part(part: Segment, limits: Limits, tension: Tension, finest: bool) -> Pieces | None:
    for rule in _rules(part, limits, tension):
        if finest and rule.pieces != PIECES[-1]:
            continue
        solved = solve(part, limits, rule)
        if solved is not None:
            return Pieces(*solved) if finest else _moving(part, limits, rule, Pieces(*solved))
    return None


def _rules(part: Segment, limits: Limits, tension: Tension) -> Iterator[Rule]:
    """From coarse to fine; none where the bounds know that there is no way without overshoot."""
    tight = tightness(part, limits)
    if tight.max() > TOLERANCE:
        return
    if len(tight) > WHOLE:
        grades = graded(tight)
        if tight.max() < TIGHT or grades.max() == COARSE:
            yield Rule(COARSE, True, tension)
        yield Rule(np.maximum(grades, PIECES[1]) if grades.max() == COARSE else grades, True, tension)
        return
    for pieces in PIECES:
        if tension in (EVEN, 0) or pieces > COARSE:
            yield Rule(pieces, True, tension)


def _moving(part: Segment, limits: Limits, rule: Rule, solved: Pieces) -> Pieces:
    """What was solved, or better: where it is almost at rest between two keys, it is urged on.

    Only the intervals around are planned again, more finely, from and to how the axis moves there anyway; all of it
    where there are ramps. Tension 0 is as smooth as can be, stops and all.
    """
    still = stills(part, *solved)
    if rule.tension == 0 or not np.any(still):
        return solved
    if part.ramps is not None:
        return _eased(part, limits, rule, solved, still)
    finer = replace(rule, pieces=PIECES[1] if np.ndim(rule.pieces) else max(int(rule.pieces), PIECES[1]), fine=True)
    for first, last in _windows(np.flatnonzero(still).tolist(), len(still)):
        states = _states(part, solved)
        window = urged(part.window(first, last, states), still[first:last])
        moving = solve(window, limits, finer)
        if moving is not None and stills(window, *moving).sum() < still[first:last].sum():
            solved = _spliced(part, solved, Pieces(*moving), first, last)
    return solved


def _eased(part: Segment, limits: Limits, rule: Rule, solved: Pieces, still: Array) -> Pieces:
    """Urged on with its ramps as they are."""
    moving = solve(urged(part, still), limits, replace(rule, pieces=PIECES[-1]))
    return Pieces(*moving) if moving is not None and stills(part, *moving).sum() < still.sum() else solved


def _windows(intervals: Sequence[int], count: int) -> Iterator[tuple[int, int]]:
    """The first and last key of each group of intervals, with some more on either side."""
    first, last = 0, -1
    for interval in intervals:
        if last < 0 or interval - AROUND > last:
            if last >= 0:
                yield first, last
            first = max(interval - AROUND, 0)
        last = min(interval + 1 + AROUND, count)
    yield first, last


def _states(segment: Segment, pieces: Pieces) -> Array:
    """Velocity and acceleration (n + 1, 2) at each key; its rest at the last."""
    return np.concatenate([pieces.coefficients[pieces.at(segment.times), 1:3] * (1, 2), segment.ends[1:]])


def _spliced(segment: Segment, pieces: Pieces, window: Pieces, first: int, last: int) -> Pieces:
    """The pieces with those from key `first` to key `last` replaced."""
    begun = np.append(pieces.at(segment.times), len(pieces.widths))
    before, after = begun[first], begun[last]
    parts = ([old[:before], new, old[after:]] for old, new in zip(pieces, window, strict=True))
    return Pieces(*map(np.concatenate, parts))


def _standing(segment: Segment, interval: int) -> Pieces:
    return Pieces(
        segment.durations[interval : interval + 1], np.array([[segment.positions[interval], 0.0, 0.0, 0.0, 0.0, 0.0]])
    )


def overshooting(segment: Segment, limits: Limits, tension: Tension) -> Pieces | Overshot | None:
    """With the least overshoot: the pieces, or the overshoot if it is more than tolerated; None where limits forbid."""
    if segment.is_loose:
        smoothest = solve(segment, limits, Rule(PIECES[-1], False, tension))
        return None if smoothest is None else Pieces(*smoothest)
    least = least_overshoot(segment, limits)
    if least is None:
        return None
    if np.any(least > segment.strays(directed=False) * (1 + NONE)):
        return Overshot(least)
    solved = with_overshoot(segment, limits, least, tension)
    return None if solved is None else Pieces(*solved)

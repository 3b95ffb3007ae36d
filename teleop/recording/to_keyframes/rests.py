"""Where a recorded axis rests, and where it moves at one speed: what people would make keyframes of.

A momentary stop is the instant at which neither speed nor acceleration is left; where an axis only turns back, its
acceleration is at its greatest. Axes that come to rest together do so within a few places of each other, as a move
ends ever more slowly: a rest that is made a little shorter begins and ends with those of the others.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from teleop.core.axes import Axis
from teleop.planner.polynomial import Array

AT_REST = 1e-6  # unit/s, unit/s2
SLOW, GENTLE = 0.02, 0.1  # of the greatest speed and acceleration within a second around: what is left at a stop
AROUND = 100  # places: that second
APART = 15  # places between a momentary stop and another rest
TOGETHER = 40  # places: rests of two axes that begin or end so near to each other do it at once
EVEN, LONG = 0.01, 10  # of the greatest acceleration and speed, and places: what a way at one speed is


class Span(NamedTuple):
    """From place to place of the grid, both included; a momentary stop has both the same."""

    begin: int
    end: int


def rests(velocity: Array, acceleration: Array) -> Sequence[Span]:
    """All rests of an axis, rising; the first and the last place of the grid are taken for rests in any case."""
    last = len(velocity) - 1
    found = [*_spans((np.abs(velocity) < AT_REST) & (np.abs(acceleration) < AT_REST))]
    found += [Span(end, end) for end in sorted({0, last}) if not any(rest.begin <= end <= rest.end for rest in found)]
    for place in _momentary(velocity, acceleration):
        if not any(rest.begin - APART <= place <= rest.end + APART for rest in found):
            found.append(Span(place, place))
    return sorted(found)


def even_ways(velocity: Array, acceleration: Array) -> Sequence[Span]:
    """Where it moves at one speed, as a stick that is held makes it."""
    speed, force = np.abs(velocity), np.abs(acceleration)
    steady = (force <= EVEN * force.max(initial=0.0)) & (speed > EVEN * speed.max(initial=0.0))
    return [each for each in _spans(steady) if each.end - each.begin >= LONG]


def aligned(found: Mapping[Axis, Sequence[Span]]) -> Mapping[Axis, Sequence[Span]]:
    """The rests of all axes, made shorter where they then begin or end together."""
    begins = {rest.begin for of_axis in found.values() for rest in of_axis}
    ends = {rest.end for of_axis in found.values() for rest in of_axis}

    def shorter(rest: Span) -> Span:
        begin = max(each for each in range(rest.begin, min(rest.begin + TOGETHER, rest.end) + 1) if each in begins)
        end = min(each for each in range(max(rest.end - TOGETHER, begin), rest.end + 1) if each in ends | {begin})
        last = rest.end == latest
        return Span(begin if rest.begin else 0, rest.end if last else end)

    latest = max(ends)
    return {axis: [shorter(rest) for rest in of_axis] for axis, of_axis in found.items()}


def _spans(which: NDArray[np.bool_]) -> Iterator[Span]:
    edges = np.flatnonzero(np.diff(np.concatenate([[False], which, [False]])))
    for begin, end in zip(edges[::2].tolist(), edges[1::2].tolist(), strict=True):
        yield Span(begin, end - 1)


def _momentary(velocity: Array, acceleration: Array) -> Iterator[int]:
    """Where the speed has a minimum that is hardly any, and is about to stay so."""
    speed, force = np.abs(velocity), np.abs(acceleration)
    least = (speed[1:-1] <= speed[:-2]) & (speed[1:-1] <= speed[2:]) & (speed[1:-1] < SLOW * speed.max(initial=0.0))
    for place in (np.flatnonzero(least) + 1).tolist():
        around = slice(max(0, place - AROUND), place + AROUND + 1)
        if speed[place] <= SLOW * speed[around].max() and force[place] <= GENTLE * force[around].max():
            yield place

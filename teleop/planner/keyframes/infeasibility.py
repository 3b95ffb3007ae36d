"""Why a segment is infeasible: which interval needs more time, how much, and which limit is in the way.

1. An elastic program finds the fewest limits that would have to be exceeded, and so the intervals at fault.
2. Those are lengthened together until the segment has a plan (with the planner's own finest rule).
3. Each in turn is then made as short as the others allow.

So all suggested times together are possible, and less of any one is not. Shortening one interval while the others have
no limits would suggest times that are not: a key next to a soft limit is then met at a speed that cannot be stopped.

A change at one key has an effect only within a few intervals, or a few stopping times. So a change is tried on a window
of the segment, between the velocities and accelerations that the solution so far has at its ends: the cost of a finding
does not grow with the number of keys.

A loop or a bounce has the same two keys several times. Such intervals are twins: they are lengthened together and make
one finding.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from teleop.core.axes import Axis, Limits
from teleop.planner.keyframes.findings import Finding
from teleop.planner.keyframes.program import HEADROOM, Rule
from teleop.planner.keyframes.qp import least_factors, solve
from teleop.planner.keyframes.segment import Segment
from teleop.planner.polynomial import Array

FINEST = Rule(pieces=8, directed=False, fine=True)
BLAMED = 1 + 1e-3  # a factor above this is a limit that gives, not the solver's tolerance
PRECISION = 0.005  # relative, of the shortest time
ROOM = 0.95  # a time that can be cut to this share has been found too long: less time is not always harder for the mesh
LONGEST = 2.0**20  # times the duration asked for: nothing that time could mend needs more
WIDE = 5  # intervals, at least, on either side of the one that a window is about
STOPS = 2.0  # and so many of the axis's longest stops
LIMITS = ("velocity", "acceleration", "jerk")

_Twins = Sequence[Sequence[int]]


def infeasibilities(axis: Axis, segment: Segment, names: Sequence[str], limits: Limits) -> list[Finding]:
    """The findings of a segment that no rule solves; `names` (n + 1,) name its keys."""
    factors = least_factors(segment, limits, FINEST)
    if factors is None:
        factors = np.ones((len(segment.steps), 3))
    too_fast = np.abs(segment.steps) / (HEADROOM * limits.velocity * segment.durations)
    factors[:, 0] = np.maximum(factors[:, 0], too_fast)
    twins = _twins(names)
    factors = np.array([factors[list(alike)].max(axis=0) for alike in twins])
    worst = factors.max(axis=1)
    suspects = [i for i in np.argsort(-worst, kind="stable").tolist() if worst[i] > BLAMED or i == worst.argmax()]
    firsts = [i for i in suspects if i == twins[i][0]]
    times = _least_times(segment, _culprits(segment, limits, firsts, twins), limits, twins)
    return [
        Finding(
            axis,
            names[interval],
            names[interval + 1],
            LIMITS[int(factors[interval].argmax())],
            float(factors[interval].max()),
            float(segment.durations[interval]),
            shortest,
        )
        for interval, shortest in times.items()
    ]


def _twins(names: Sequence[str]) -> _Twins:
    """For each interval, all that lie between the same two keys in either direction, itself included, in order."""
    alike: dict[object, list[int]] = {}
    pairs = [frozenset(pair) if all(pair) else number for number, pair in enumerate(pairwise(names))]
    for number, pair in enumerate(pairs):
        alike.setdefault(pair, []).append(number)
    return [alike[pair] for pair in pairs]


class _Solution:
    """A solved segment whose intervals `relaxed` have no limits.

    Of the solution only `states` (n + 1, 2) are kept: velocity and acceleration at each key. A change applies to an
    interval and its twins; it is tried on a window, and kept if that can be solved.
    """

    def __init__(
        self, segment: Segment, states: Array, limits: Limits, twins: _Twins, relaxed: frozenset[int] = frozenset()
    ) -> None:
        self.segment, self.relaxed = segment, relaxed
        self._states, self._limits, self._twins = states, limits, twins
        velocity, acceleration, jerk = limits.velocity, limits.acceleration, limits.jerk
        self._reach = STOPS * (velocity / acceleration + acceleration / jerk)

    def lasting(self, interval: int, duration: float) -> bool:
        """Make an interval last `duration` seconds; whether that is possible."""
        return self._change(interval, _stretched(self.segment, self._twins[interval], duration), self.relaxed)

    def limited(self, interval: int) -> bool:
        """Apply the limits to an interval again; whether that is possible."""
        return self._change(interval, self.segment, self.relaxed - {*self._twins[interval]})

    def _change(self, interval: int, segment: Segment, relaxed: frozenset[int]) -> bool:
        first, last = self._window(segment, interval)
        inside = frozenset(other - first for other in relaxed if first <= other < last)
        states = _solve(segment.window(first, last, self._states), self._limits, inside)
        if states is None:
            return False
        self.segment, self.relaxed = segment, relaxed
        self._states = np.concatenate([self._states[:first], states, self._states[last + 1 :]])
        return True

    def _window(self, segment: Segment, interval: int) -> tuple[int, int]:
        """First and last key of the window in which a change of `interval` and its twins has an effect."""
        begun, ended = self._twins[interval][0], self._twins[interval][-1] + 1
        start, end = segment.times[begun] - self._reach, segment.times[ended] + self._reach
        first = min(begun - WIDE, int(np.searchsorted(segment.times, start, "right")) - 1)
        last = max(ended + WIDE, int(np.searchsorted(segment.times, end)))
        return max(first, 0), min(last, len(segment.steps))


def _solve(segment: Segment, limits: Limits, relaxed: frozenset[int] = frozenset()) -> Array | None:
    """Velocity and acceleration (n + 1, 2) at the keys of the solved segment, None when there is no solution."""
    solved = solve(segment, limits, FINEST, relaxed)
    if solved is None:
        return None
    widths, coefficients = solved
    starts = segment.times[0] + np.concatenate([[0.0], np.cumsum(widths[:-1])])
    pieces = [int(np.abs(starts - time).argmin()) for time in segment.times[:-1]]
    return np.concatenate([coefficients[pieces, 1:3] * (1, 2), segment.ends[1:]])


def _stretched(segment: Segment, intervals: Sequence[int], duration: float) -> Segment:
    for interval in intervals:
        segment = segment.stretched(interval, duration)
    return segment


def _culprits(segment: Segment, limits: Limits, suspects: list[int], twins: _Twins) -> list[int]:
    """The suspects, in order, without those whose limits can be kept after all once the others have more time."""
    relaxed = frozenset(twin for interval in suspects for twin in twins[interval])
    states = _solve(segment, limits, relaxed)
    if states is None:
        return sorted(suspects)
    solution = _Solution(segment, states, limits, twins, relaxed)
    for interval in reversed(suspects):
        if solution.relaxed > {*twins[interval]}:
            solution.limited(interval)
    return sorted(solution.relaxed & {*suspects})


def _least_times(segment: Segment, blamed: list[int], limits: Limits, twins: _Twins) -> dict[int, float | None]:
    """Durations, whole milliseconds up, of the intervals that need more time, with which the segment is possible.

    Those are the `blamed`, and where their time alone does not help, their neighbors, and so on. None for each of the
    blamed when no time would help.
    """
    firsts = sorted({alike[0] for alike in twins})
    involved, solution = blamed, _possible(segment, blamed, limits, twins)
    while solution is None and len(involved) < len(firsts):
        near = {twin + side for interval in involved for twin in twins[interval] for side in (-1, 0, 1)}
        involved = [interval for interval in firsts if near & {*twins[interval]}]
        solution = _possible(segment, involved, limits, twins)
    if solution is None:
        return dict.fromkeys(blamed)
    for interval in involved:
        _shorten(solution, interval, float(segment.durations[interval]))
    for interval in involved:  # those that were shortened since may have left it some room
        duration = float(solution.segment.durations[interval])
        if solution.lasting(interval, max(float(segment.durations[interval]), ROOM * duration)):
            _shorten(solution, interval, float(segment.durations[interval]))
    return {
        interval: float(duration)
        for interval, (duration, asked) in enumerate(zip(solution.segment.durations, segment.durations, strict=True))
        if interval in involved and duration > asked + 1e-9
    }


def _possible(segment: Segment, intervals: list[int], limits: Limits, twins: _Twins) -> _Solution | None:
    """The segment with these intervals so many times longer that it is possible, None when no time would do."""
    factor = 2.0
    while factor <= LONGEST:
        longer = segment
        for interval in intervals:
            longer = _stretched(longer, twins[interval], factor * float(segment.durations[interval]))
        states = _solve(longer, limits)
        if states is not None:
            return _Solution(longer, states, limits, twins)
        factor *= 2
    return None


def _shorten(solution: _Solution, interval: int, low: float) -> None:
    """Give `interval` its least duration, at least `low`, rounded up to whole milliseconds where the solver allows."""
    if solution.lasting(interval, low):
        return
    high = float(solution.segment.durations[interval])
    while high > low * (1 + PRECISION):
        middle = math.sqrt(low * high)
        low, high = (low, middle) if solution.lasting(interval, middle) else (middle, high)
    rounded = math.ceil(high * 1000) / 1000
    while rounded < high * 1.05 and not solution.lasting(interval, rounded):
        rounded = math.ceil(rounded * (1 + PRECISION) * 1000) / 1000

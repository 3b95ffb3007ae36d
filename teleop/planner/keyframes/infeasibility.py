"""Why keyframes cannot be met, in terms of what to change: the segment, the limit, by how much, and the time it needs.

An elastic programme finds the fewest limits that would have to give. The segments it blames are lengthened together,
with the planner's own finest rule, until the leg is possible, and then each in turn is made as short as the others
allow. So the times are found from the possible side: all of them together do, and less of any one does not. Shortening
one against segments without limits instead gives times that nothing can follow: a key next to a soft limit is then met
at a speed that cannot be stopped.

What happens at one key is felt a few segments away, or a few stops, and no further: a change is tried on a window of
the leg around it, between the velocities and accelerations that the solution so far has there. So the price of a
finding does not grow with the number of keys.

In a loop or a bounce the way between two keys is gone several times, and whoever changes one changes all: such twins
are lengthened together, and are one finding.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from teleop.core.axes import Axis, Limits
from teleop.planner.keyframes.findings import Finding
from teleop.planner.keyframes.qp import HEADROOM, Rule, least_factors, solve
from teleop.planner.keyframes.segment import Segment
from teleop.planner.polynomial import Array

FINEST = Rule(pieces=8, directed=False)
BLAMED = 1 + 1e-3  # a factor above this is a limit that gives, not the solver's tolerance
PRECISION = 0.005  # relative, of the shortest time
ROOM = 0.95  # a time that can be cut to this share has been found too long: less time is not always harder for the mesh
LONGEST = 2.0**20  # times the duration asked for: nothing that time could mend needs more
WIDE = 5  # segments, at least, on either side of the one that a window is about
STOPS = 2.0  # and so many of the axis's longest stops
LIMITS = ("velocity", "acceleration", "jerk")

_Twins = Sequence[Sequence[int]]


def explain(axis: Axis, leg: Segment, wheres: Sequence[str], limits: Limits) -> list[Finding]:
    """The findings of a leg that no rule solves; `wheres` (n + 1,) name its keys."""
    factors = least_factors(leg, limits, FINEST)
    if factors is None:
        factors = np.ones((len(leg.steps), 3))
    too_fast = np.abs(leg.steps) / (HEADROOM * limits.velocity * leg.durations)
    factors[:, 0] = np.maximum(factors[:, 0], too_fast)
    twins = _twins(wheres)
    factors = np.array([factors[list(alike)].max(axis=0) for alike in twins])
    worst = factors.max(axis=1)
    suspects = [i for i in np.argsort(-worst, kind="stable").tolist() if worst[i] > BLAMED or i == worst.argmax()]
    firsts = [i for i in suspects if i == twins[i][0]]
    times = _least_times(leg, _culprits(leg, limits, firsts, twins), limits, twins)
    return [
        Finding(
            axis,
            wheres[segment],
            wheres[segment + 1],
            LIMITS[int(factors[segment].argmax())],
            float(factors[segment].max()),
            float(leg.durations[segment]),
            shortest,
        )
        for segment, shortest in times.items()
    ]


def _twins(wheres: Sequence[str]) -> _Twins:
    """For each segment all that lie between the same two keys, either way, itself among them; the first comes first."""
    alike: dict[object, list[int]] = {}
    pairs = [frozenset(pair) if all(pair) else number for number, pair in enumerate(pairwise(wheres))]
    for number, pair in enumerate(pairs):
        alike.setdefault(pair, []).append(number)
    return [alike[pair] for pair in pairs]


class _Solution:
    """A leg solved with the segments `relaxed` free of limits; of it only `states` (n + 1, 2) at the keys are kept.

    Every change is of a segment and its twins. It is tried on a window, and taken over where that can be solved.
    """

    def __init__(
        self, leg: Segment, states: Array, limits: Limits, twins: _Twins, relaxed: frozenset[int] = frozenset()
    ) -> None:
        self.leg, self.relaxed = leg, relaxed
        self._states, self._limits, self._twins = states, limits, twins
        velocity, acceleration, jerk = limits.velocity, limits.acceleration, limits.jerk
        self._reach = STOPS * (velocity / acceleration + acceleration / jerk)

    def lasting(self, segment: int, duration: float) -> bool:
        """Have a segment last `duration` s, if that is possible."""
        return self._change(segment, _stretched(self.leg, self._twins[segment], duration), self.relaxed)

    def limited(self, segment: int) -> bool:
        """Have the limits apply to a segment again, if that is possible."""
        return self._change(segment, self.leg, self.relaxed - {*self._twins[segment]})

    def _change(self, segment: int, leg: Segment, relaxed: frozenset[int]) -> bool:
        first, last = self._window(leg, segment)
        inside = frozenset(other - first for other in relaxed if first <= other < last)
        states = _solve(leg.window(first, last, self._states), self._limits, inside)
        if states is None:
            return False
        self.leg, self.relaxed = leg, relaxed
        self._states = np.concatenate([self._states[:first], states, self._states[last + 1 :]])
        return True

    def _window(self, leg: Segment, segment: int) -> tuple[int, int]:
        """The keys between which a change of `segment` and its twins may be felt."""
        begun, ended = self._twins[segment][0], self._twins[segment][-1] + 1
        start, end = leg.times[begun] - self._reach, leg.times[ended] + self._reach
        first = min(begun - WIDE, int(np.searchsorted(leg.times, start, "right")) - 1)
        last = max(ended + WIDE, int(np.searchsorted(leg.times, end)))
        return max(first, 0), min(last, len(leg.steps))


def _solve(leg: Segment, limits: Limits, relaxed: frozenset[int] = frozenset()) -> Array | None:
    """Velocity and acceleration (n + 1, 2) at the keys of the solved leg, None when there is no solution."""
    solved = solve(leg, limits, FINEST, relaxed)
    if solved is None:
        return None
    widths, coefficients = solved
    starts = leg.times[0] + np.concatenate([[0.0], np.cumsum(widths[:-1])])
    pieces = [int(np.abs(starts - time).argmin()) for time in leg.times[:-1]]
    return np.concatenate([coefficients[pieces, 1:3] * (1, 2), leg.ends[1:]])


def _stretched(leg: Segment, segments: Sequence[int], duration: float) -> Segment:
    for segment in segments:
        leg = leg.stretched(segment, duration)
    return leg


def _culprits(leg: Segment, limits: Limits, suspects: list[int], twins: _Twins) -> list[int]:
    """The suspects, in order, without those whose limits can be kept after all once the others have more time."""
    relaxed = frozenset(twin for segment in suspects for twin in twins[segment])
    states = _solve(leg, limits, relaxed)
    if states is None:
        return sorted(suspects)
    solution = _Solution(leg, states, limits, twins, relaxed)
    for segment in reversed(suspects):
        if solution.relaxed > {*twins[segment]}:
            solution.limited(segment)
    return sorted(solution.relaxed & {*suspects})


def _least_times(leg: Segment, blamed: list[int], limits: Limits, twins: _Twins) -> dict[int, float | None]:
    """Durations, whole milliseconds up, of the segments that need more time, with which the leg is possible.

    Those are the `blamed`, and where their time alone does not help, their neighbours, and so on. None for each of the
    blamed when no time would help.
    """
    firsts = sorted({alike[0] for alike in twins})
    involved, solution = blamed, _possible(leg, blamed, limits, twins)
    while solution is None and len(involved) < len(firsts):
        near = {twin + side for segment in involved for twin in twins[segment] for side in (-1, 0, 1)}
        involved = [segment for segment in firsts if near & {*twins[segment]}]
        solution = _possible(leg, involved, limits, twins)
    if solution is None:
        return dict.fromkeys(blamed)
    for segment in involved:
        _shorten(solution, segment, float(leg.durations[segment]))
    for segment in involved:  # those that were shortened since may have left it some room
        duration = float(solution.leg.durations[segment])
        if solution.lasting(segment, max(float(leg.durations[segment]), ROOM * duration)):
            _shorten(solution, segment, float(leg.durations[segment]))
    return {
        segment: float(duration)
        for segment, (duration, asked) in enumerate(zip(solution.leg.durations, leg.durations, strict=True))
        if segment in involved and duration > asked + 1e-9
    }


def _possible(leg: Segment, segments: list[int], limits: Limits, twins: _Twins) -> _Solution | None:
    """The leg with these segments so many times longer that it is possible, None when no time would do."""
    factor = 2.0
    while factor <= LONGEST:
        longer = leg
        for segment in segments:
            longer = _stretched(longer, twins[segment], factor * float(leg.durations[segment]))
        states = _solve(longer, limits)
        if states is not None:
            return _Solution(longer, states, limits, twins)
        factor *= 2
    return None


def _shorten(solution: _Solution, segment: int, low: float) -> None:
    """Give `segment` its least duration, `low` or longer, whole milliseconds unless the leg is on the solver's edge."""
    if solution.lasting(segment, low):
        return
    high = float(solution.leg.durations[segment])
    while high > low * (1 + PRECISION):
        middle = math.sqrt(low * high)
        low, high = (low, middle) if solution.lasting(segment, middle) else (middle, high)
    rounded = math.ceil(high * 1000) / 1000
    while rounded < high * 1.05 and not solution.lasting(segment, rounded):
        rounded = math.ceil(rounded * (1 + PRECISION) * 1000) / 1000

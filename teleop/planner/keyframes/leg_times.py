"""The least times of one leg of an axis, from rest to rest, that the planner's own rules can do.

What `least_times` finds is tried, whole milliseconds up, and made a little longer until there is a plan.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from teleop.core.axes import Axis, Limits
from teleop.planner.keyframes.bounds import factors_needed, rest_to_rest
from teleop.planner.keyframes.budget import SINGLE, Budget, searching, trying
from teleop.planner.keyframes.least_times import Window, least_durations
from teleop.planner.keyframes.legs import Points, at_durations, durations, pairs, segment_of, shortened
from teleop.planner.keyframes.overshoot import tolerated
from teleop.planner.keyframes.possible import Possible, same
from teleop.planner.keyframes.windows import windows
from teleop.planner.polynomial import Array

Known = dict[object, list[float] | None]

LONGER = 1e-6  # relative: an interval that is longer by less is as it was
ROOM = 1.005  # times the least one: what the planner finds a plan for nearly always
TRIED = (1.0, 1.003, 1.006, 1.01, 1.015, 1.02, 1.03, 1.05, 1.1, 1.2, 1.35, 1.5, 1.7, 2.0, 3.0)  # times what was found
NEAR = 1.025  # two of these that are so near are not tried between
SHORT = 0.2  # of the longest interval
CLOSE = 1.01  # times what was found: where it took more, some interval may have too much
LESS = 0.955
START = 1.2  # times what the bounds know of each interval


class LegTimes:
    """Of one axis. `possible` tells whether a leg has a plan; ways from rest to rest that are alike are timed once.

    So are legs that are the same at other times, or of another axis with the same limits, by what is `known` of all.
    """

    def __init__(self, axis: Axis, limits: Limits, possible: Possible, budget: Budget, known: Known) -> None:
        self.axis, self.limits, self.budget = axis, limits, budget
        self._possible = possible
        self._known = known

    def least(self, points: Points) -> list[float] | None:
        """The durations of a leg's intervals, none shorter than they are; None when none were found."""
        if len(points) == 2:
            return self._single(points)
        leg = same(self.axis, self.limits, points)
        if leg not in self._known:
            self._known[leg] = self._through(points)
        return self._known[leg]

    def _through(self, points: Points) -> list[float] | None:
        whole, kept = shortened(points)
        found = self._searched(whole)
        if found is None:
            return None
        seconds = np.array([found[pair] for pair in pairs(whole)])
        settled = self._settled(whole, seconds) or self._settled(whole, self._stop_at_each(whole))
        return None if settled is None else [settled[number] for number in kept]

    def _searched(self, points: Points) -> dict[object, float] | None:
        """The seconds between each two keys of a leg; None where they are not worth searching for."""
        spans = windows(points, self.limits)
        if not self.budget.take(sum(searching(last - first) for first, last in spans)):
            return None
        seconds, guess, between = np.array(durations(points), float), self._guess(points), pairs(points)
        for first, last in spans:
            numbers: dict[object, int] = {}
            twins = np.array([numbers.setdefault(pair, len(numbers)) for pair in between[first:last]])
            part = segment_of(points[first : last + 1])
            allowed = [point.overshoot for point in points[first:last]]
            stray = tolerated(self.axis, part, allowed)
            window = Window(part, self.limits, twins, (first > 0, last < len(between)), stray)
            found = least_durations(window, guess[first:last])
            found = guess[first:last] if found is None else found
            seconds[first:last] = np.where(found > part.durations * (1 + LONGER), ROOM * found, part.durations)
        return dict(zip(between, seconds.tolist(), strict=True))

    def _single(self, points: Points) -> list[float] | None:
        first, last = points
        step, had = abs(last.position - first.position), last.time - first.time
        value = (self.limits, round(step, 9), round(had, 9), first.leave, last.arrive, first.tension)
        if value not in self._known:
            if not self.budget.take(SINGLE):
                return None
            guess = max(had, ROOM * rest_to_rest(step, self.limits))
            settled = self._settled(points, np.array([guess]), tries=1)
            if settled is None:
                found = least_durations(Window(segment_of(points), self.limits, np.array([0])), np.array([guess]))
                settled = self._settled(points, np.array([guess]) if found is None else ROOM * found)
            if settled is None:
                return None
            self._known[value] = settled
        return self._known[value]

    def _guess(self, points: Points) -> Array:
        """From what the bounds know of each interval, and of a way that would stop at its keys."""
        segment = segment_of(points)
        factors = np.maximum(factors_needed(segment, self.limits), 1.0) ** (1 / np.arange(1, 4))
        return segment.durations * np.where(factors.max(axis=1) > 1, START * factors.max(axis=1), 1.0)

    def _stop_at_each(self, points: Points) -> Array:
        """Times that are always enough, if not the least: all the way from each key to the next from rest to rest."""
        segment = segment_of(points)
        needed = [rest_to_rest(step, self.limits) for step in np.abs(segment.steps).tolist()]
        return np.maximum(segment.durations, needed)

    def _settled(self, points: Points, found: Array, tries: int = len(TRIED)) -> list[float] | None:
        """The times that were found, whole milliseconds, as much longer as it takes to have a plan."""
        had = np.array(durations(points), float)
        changed = found > had * (1 + LONGER)
        if not changed.any():
            changed[:] = True

        def lasting(longer: float) -> Array:
            return np.where(changed, np.ceil(np.maximum(found, had) * longer * 1000 - 1e-6) / 1000, had)

        def fits(longer: float) -> bool:
            affordable = self.budget.take(trying(len(points) - 1))
            return affordable and self._possible(self.axis, at_durations(points, lasting(longer)))

        high = next((longer for longer in TRIED[:tries] if fits(longer)), None)
        if high is None:
            return None
        low = max((longer for longer in TRIED if longer < high), default=1.0)
        while high > NEAR * low:
            middle = (low * high) ** 0.5
            low, high = (low, middle) if fits(middle) else (middle, high)
        settled = lasting(high)
        suspect = (settled > had) & ((high > CLOSE) | (settled < SHORT * settled.max()))
        return self._without_slack(points, settled, had, np.flatnonzero(suspect).tolist()).tolist()

    def _without_slack(self, points: Points, found: Array, had: Array, suspect: Sequence[int]) -> Array:
        """With less time for those that are suspect, if it does.

        The room of a long interval may be a large share of a short one beside it; and if all had to be longer, one of
        them may have been the reason.
        """
        between = pairs(points)
        for interval in suspect:
            while found[interval] > had[interval] and between.count(between[interval]) == 1:
                less = found.copy()
                less[interval] = max(had[interval], np.ceil(LESS * found[interval] * 1000) / 1000)
                affordable = less[interval] < found[interval] and self.budget.take(trying(len(points) - 1))
                if not affordable or not self._possible(self.axis, at_durations(points, less)):
                    break
                found = less
        return found

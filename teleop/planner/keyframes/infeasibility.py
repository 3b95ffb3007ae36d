"""Why keys cannot be met in their times: which way between two keys needs more, how much, and what is in the way.

1. `bounds` finds what no plan can do, without a solver: by what each interval asks for more than the limits.
2. `least_times` gives the segments at fault the least durations that the limits allow. They are tried with the
   planner's own rules, and made a little longer until those find a plan.
3. Times are found for each axis alone, then once more with what the other axes need, and tried together: a file that
   takes all suggestions is playable.

What is worth that work has a bound (`Budget`): a file with hundreds of intervals at fault is no matter of single keys.
Those are named with what they exceed, and are to be stretched. Identical ways from rest to rest are timed once, and
so are the ways of a loop or a bounce, which have the same two keys several times (twins).
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import pairwise

from teleop.core.axes import Axis, Limits
from teleop.core.timing import SAME_TIME
from teleop.planner.keyframes.blame import timed, untimed
from teleop.planner.keyframes.budget import Budget
from teleop.planner.keyframes.findings import Finding, Overshooting, RampsTooLong, Unsolved
from teleop.planner.keyframes.keys import Key, ramps_asked, ramps_fit
from teleop.planner.keyframes.leg_times import Known, LegTimes
from teleop.planner.keyframes.legs import Points, durations, last_alike, legs, shortened
from teleop.planner.keyframes.possible import Possible
from teleop.planner.keyframes.ramp import together
from teleop.planner.keyframes.retiming import Way, retimed, ways

ROUNDS = 3  # of all axes together
SWEEPS = 2  # of each axis among the others
NOTICED = 1.02  # times what an axis needs alone: with so much more time, what it needs beside that is other
LONGER = 1e-4  # s: a way that needs so little more is as it was

Found = Finding | RampsTooLong | Unsolved


def infeasibilities(
    keys: Mapping[Axis, Sequence[Key]],
    limits: Mapping[Axis, Limits],
    refused: Mapping[Axis, Sequence[Points]],
    possible: Possible,
) -> list[Found]:
    """The findings of the legs that were `refused`, in order of time; `possible` tells whether a leg has a plan."""
    search = _Search(keys, limits, refused, possible)
    search.run()
    return search.findings()


class _Search:
    """`needs` are the seconds of each way that has to be longer; `untimed` are legs for which no time was found."""

    def __init__(
        self,
        keys: Mapping[Axis, Sequence[Key]],
        limits: Mapping[Axis, Limits],
        refused: Mapping[Axis, Sequence[Points]],
        possible: Possible,
    ) -> None:
        self.keys, self.limits, self.refused = keys, limits, refused
        self.possible = possible
        self.needs: dict[Way, float] = {}
        self.ramps: dict[Way, RampsTooLong] = {}
        self.untimed: list[tuple[Axis, Points]] = []
        planned = [points for axis, of_axis in keys.items() for points in legs(axis, of_axis)]
        budget = Budget.of(planned, [(points, limits[axis]) for axis, of_axis in refused.items() for points in of_axis])
        known: Known = {}
        self.times = {axis: LegTimes(axis, limits[axis], self.possible, budget, known) for axis in keys}

    def run(self) -> None:
        """Time each axis alone, then with the others."""
        for axis, of_axis in self.refused.items():
            for points in of_axis:
                self._time(axis, points, self.keys[axis])
        if len({way.axis for way in self.needs}) > 1 and not self.untimed:
            for axis in [*self.refused] * SWEEPS:
                self._time_among_others(axis)
        for _ in range(ROUNDS):
            if self.untimed or not self._lengthened_together():
                return

    def _time(self, axis: Axis, points: Points, keys: Sequence[Key]) -> None:
        """What a leg of `keys`, which may already be later than the file's, needs beyond its own times."""
        between = ways(axis, keys, points)
        if not self._has_ramps(Way(axis, between[0].first, between[-1].last), points):
            return
        least = self.times[axis].least(points)
        if least is None:
            self.untimed.append((axis, points))
            return
        for way, seconds, had in zip(between, least, durations(points), strict=True):
            if seconds > had + LONGER:
                self.needs[way] = max(seconds, self.needs.get(way, 0.0))

    def _has_ramps(self, way: Way, points: Points) -> bool:
        """Whether there is time for both ramps of a leg; else it is needed first."""
        asked = ramps_asked(points)
        if asked is None or ramps_fit(points):
            return True
        leave, arrive = points[0].leave or points[-1].arrive, points[-1].arrive or points[0].leave
        shortest = together(leave, arrive) if leave and arrive else None
        shortest = shortest and math.ceil(shortest * 1000 - SAME_TIME) / 1000
        first, last = (self.keys[way.axis][number] for number in way[1:])
        had = last.at - first.at - first.hold
        both = float(asked[0, 1]), float(asked[-1, 0])
        self.ramps[way] = RampsTooLong(way.axis, first.where, last.where, *both, had, shortest)
        if shortest is not None:
            self.needs[way] = max(shortest, self.needs.get(way, 0.0))
        return False

    def _time_among_others(self, axis: Axis) -> None:
        """Time an axis again where the others take longer anyhow; what they need more of has one finding, theirs."""
        own = {self._events(way): seconds for way, seconds in self.needs.items() if way.axis is axis}
        others = {
            way: seconds
            for way, seconds in self.needs.items()
            if way.axis is not axis and seconds > own.get(self._events(way), 0.0)
        }
        keys = retimed(self.keys, others)[axis]
        starts = {points[0].time for points in self.refused[axis]}
        for before, points in zip(legs(axis, self.keys[axis]), legs(axis, keys), strict=True):
            between = ways(axis, keys, points)
            alone = [max(self.needs.get(way, 0.0), had) for way, had in zip(between, durations(before), strict=False)]
            if before[0].time in starts and any(
                a > NOTICED * b for a, b in zip(durations(points), alone, strict=False)
            ):
                for way in between:
                    self.needs.pop(way, None)
                self.ramps.pop(Way(axis, between[0].first, between[-1].last), None)
                if not self.possible(axis, shortened(points)[0]):
                    self._time(axis, points, keys)

    def _lengthened_together(self) -> bool:
        """Try all axes with what all need; lengthen what is still refused, and tell whether there was anything."""
        keys, refused = retimed(self.keys, self.needs), False
        for axis in self.keys:
            for before, points in zip(legs(axis, self.keys[axis]), legs(axis, keys[axis]), strict=True):
                if self._is_proved(axis, before, points) or self.possible.surely(axis, shortened(points)[0]):
                    continue
                self._time(axis, points, keys[axis])
                refused = True
        return refused

    def _is_proved(self, axis: Axis, before: Points, points: Points) -> bool:
        """Whether a leg needs no further try: it is as it was, or a single way that has only become longer."""
        between = ways(axis, self.keys[axis], before)
        if last_alike(before, points):
            return not any(leg[0].time == before[0].time for leg in self.refused.get(axis, ()))
        return len(points) == 2 and not {*between} & {*self.ramps}

    def _events(self, way: Way) -> tuple[float, float]:
        of_axis = self.keys[way.axis]
        return round(of_axis[way.first].at, 6), round(of_axis[way.last].at, 6)

    def findings(self) -> list[Found]:
        """All that was found, by time; what lies between the same two keys once, with the longest time."""
        found: list[tuple[float, Found]] = []
        for axis, points in self.untimed:
            found += [(points[i + 1].time, each) for i, each in untimed(axis, points, self.limits[axis])]
        for axis in self.keys:
            for points in legs(axis, self.keys[axis]):
                found += [(points[i + 1].time, each) for i, each in self._needed(axis, points)]
        if not found:  # a refusal always has a reason
            found = [
                (points[-1].time, Unsolved(axis, points[0].where, points[-1].where))
                for axis, of_axis in self.refused.items()
                for points in of_axis
            ]
        worst: dict[object, tuple[float, Found]] = {}
        for time, each in found:
            cause = (type(each), each.axis, frozenset((each.first, each.last)) if each.first and each.last else time)
            known = worst.get(cause)
            if known is None or _shortest(known[1]) < _shortest(each):
                worst[cause] = (time if known is None else known[0]), each
        return [each for _, each in sorted(worst.values(), key=lambda timed: timed[0])]

    def _needed(self, axis: Axis, points: Points) -> Iterator[tuple[int, Found]]:
        """The findings of a leg and their intervals."""
        between = ways(axis, self.keys[axis], points)
        if not between:
            return
        ramps = self.ramps.get(Way(axis, between[0].first, between[-1].last))
        if ramps is not None:
            yield len(between) - 1, ramps
        for interval, way in enumerate(between):
            seconds = self.needs.get(way, 0.0)
            if seconds > (ramps.shortest or 0.0 if ramps is not None and len(between) == 1 else 0.0) + LONGER:
                yield interval, timed(axis, points, self.limits[axis], interval, seconds)


def with_overshoots(
    found: Sequence[Found], overshot: Sequence[tuple[Points, Overshooting]]
) -> list[Found | Overshooting]:
    """The findings, those of legs that only overshoot too far with that as their reason."""
    result: list[Found | Overshooting] = []
    for each in found:
        for points, overshoot in overshot:
            between = [{first.where, last.where} for first, last in pairwise(points)]
            if each.axis is not overshoot.axis or isinstance(each, RampsTooLong):
                continue
            if isinstance(each, Unsolved) and each.first == points[0].where:
                each = overshoot
            elif isinstance(each, Finding) and {each.first, each.last} in between and each.seconds is not None:
                way = (each.first, each.last) if each.shortest is not None else None
                each = replace(overshoot, way=way, seconds=each.seconds, shortest=each.shortest or 0.0)
            else:
                continue
            break
        result.append(each)
    return result


def _shortest(found: Found) -> float:
    return 0.0 if isinstance(found, Unsolved) else found.shortest or 0.0

"""An operator's keys, and the segments between the rests of an axis that they make."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from teleop.core.axes import Axis, Limits
from teleop.core.timing import SAME_TIME
from teleop.planner.keyframes.findings import PlanError
from teleop.planner.keyframes.ramp import Ramp, quickest
from teleop.planner.keyframes.segment import Segment
from teleop.planner.keyframes.tension import Tension
from teleop.planner.polynomial import Array

SHORTEST = 3e-5  # of its interval: a ramp is at least so long, 0.1 s of an hour, or no solver can tell it from none
SETTLED = 8  # rounds of a ramp and the speed it leads to, until neither changes any more


@dataclass(frozen=True, slots=True)
class Key:
    """Be at `position` (units) at `at` (s); `stop` there, for `hold` s. `where` names it in its file.

    `arrive` and `leave` are the ramps to rest there and away from it; where neither end of a way between rests has
    one, all of that way is used to be as smooth as can be, and where one end has one, so has the other. `tension` is
    that of the way from this key to the next rest, where it differs from the plan's. The way to the next key may leave
    the range of the two by `overshoot` units, None for what is usual, inf for any distance (on all of
    a way from rest to rest: its keys are samples of a curve).
    """

    at: float
    position: float
    stop: bool = False
    hold: float = 0.0
    where: str = ""
    arrive: Ramp | None = None
    leave: Ramp | None = None
    tension: Tension | None = None
    overshoot: float | None = None

    def later(self, factor: float) -> Key:
        """With all its times multiplied."""
        arrive, leave = (ramp and ramp.longer(factor) for ramp in (self.arrive, self.leave))
        return replace(self, at=factor * self.at, hold=factor * self.hold, arrive=arrive, leave=leave)


class Waypoint(NamedTuple):
    """A key, or the end of its dwell: time in s, position in units."""

    time: float
    position: float
    rest: bool
    where: str
    arrive: Ramp | None = None
    leave: Ramp | None = None
    tension: Tension | None = None
    overshoot: float | None = None


def _waypoint(key: Key, time: float, rest: bool) -> Waypoint:
    return Waypoint(time, key.position, rest, key.where, key.arrive, key.leave, key.tension, key.overshoot)


def waypoints(axis: Axis, keys: Sequence[Key]) -> list[Waypoint]:
    """Keys in time, a dwell as two rests; one that begins where a dwell ends continues it.

    Raises PlanError where one is not after the other.
    """
    points: list[Waypoint] = []
    for number, key in enumerate(keys):
        rest = key.stop or key.hold > 0 or number in (0, len(keys) - 1)
        if points and key.at <= points[-1].time + SAME_TIME:
            last = points[-1]
            if key.at < last.time - SAME_TIME or key.position != last.position:
                raise PlanError(
                    f"{axis}: {key.where} (at {key.at:.6g} s) is not after {last.where} (until {last.time:.6g} s)"
                )
            points[-1] = last._replace(rest=True, leave=key.leave, tension=key.tension, overshoot=key.overshoot)
        else:
            points.append(_waypoint(key, key.at, rest))
        if key.hold > 0:
            points[-1] = points[-1]._replace(leave=None)
            points.append(_waypoint(key, key.at + key.hold, True)._replace(arrive=None))
    return points


def ramps_asked(points: Sequence[Waypoint]) -> Array | None:
    """The seconds (n + 1, 2) asked for to slow down to each point and to get up to speed from it, None without any.

    Each end of a segment has its own, or that of the other end. So has a turn, where the direction changes: its own,
    or the ends'. Ramps that meet at a turn are shortened to the time that there is; shares are of the way from one rest
    or turn to the next.
    """
    leave, arrive = points[0].leave or points[-1].arrive, points[-1].arrive or points[0].leave
    if leave is None or arrive is None or all(point.position == points[0].position for point in points):
        return None
    asked = np.zeros((len(points), 2))
    for first, last in ways(np.array([point.position for point in points])):
        duration = points[last].time - points[first].time
        both = (points[first].leave or leave).over(duration), (points[last].arrive or arrive).over(duration)
        fit = 1.0 if (first, last) == (0, len(points) - 1) else min(1.0, duration / max(sum(both), duration))
        asked[first, 1], asked[last, 0] = both[0] * fit, both[1] * fit
    return asked


def ramps_fit(points: Sequence[Waypoint]) -> bool:
    """Whether there is time for both ramps from one rest to the next."""
    asked = ramps_asked(points)
    return asked is None or asked[0, 1] + asked[-1, 0] <= points[-1].time - points[0].time + SAME_TIME


def ways(positions: Array) -> list[tuple[int, int]]:
    """First and last key of each way in one direction, without those that stand still."""
    direction = np.sign(np.diff(positions))
    turns = [0, *(np.flatnonzero(np.diff(direction)) + 1).tolist(), len(direction)]
    return [(first, last) for first, last in pairwise(turns) if direction[first] != 0]


def segment_between(points: Sequence[Waypoint], asked: Array | None, limits: Limits) -> Segment:
    """From one rest to the next, with ramps that the limits allow for about the speed that its intervals need."""
    segment = Segment(
        np.array([point.time for point in points], float), np.array([point.position for point in points], float)
    )
    if asked is None:
        return segment
    ramps = asked.copy()
    for first, last in ways(segment.positions):
        for interval, key, side in ((first, first, 1), (last - 1, last, 0)):
            step, duration = abs(float(segment.steps[interval])), float(segment.durations[interval])
            least = max(segment.resolved(limits.jerk), SHORTEST * duration)
            at_both = 2 if last == first + 1 else 1
            for _ in range(SETTLED):
                speed = step / max(duration - at_both * ramps[key, side] / 2, duration / 2)
                ramps[key, side] = max(asked[key, side], quickest(speed, limits), least)
    return replace(segment, ramps=ramps)

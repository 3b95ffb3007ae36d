"""An operator's keys, and the segments between the rests of an axis that they make."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from teleop.core.axes import Axis, Limits
from teleop.core.timing import SAME_TIME
from teleop.planner.keyframes.findings import PlanError
from teleop.planner.keyframes.ramp import Ramp, quickest
from teleop.planner.keyframes.segment import Segment

SETTLED = 8  # rounds of a ramp and the speed it leads to, until neither changes any more


@dataclass(frozen=True, slots=True)
class Key:
    """Be at `position` (units) at `at` (s); `stop` there, for `hold` s. `where` names it in its file.

    `arrive` and `leave` are the ramps to rest there and away from it; where neither end of a way between rests has
    one, all of that way is used to be as smooth as can be, and where one end has one, so has the other. `tension` is
    that of the way from this key to the next rest, where it differs from the plan's.
    """

    at: float
    position: float
    stop: bool = False
    hold: float = 0.0
    where: str = ""
    arrive: Ramp | None = None
    leave: Ramp | None = None
    tension: float | None = None

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
    tension: float | None = None


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
            points[-1] = last._replace(rest=True, leave=key.leave, tension=key.tension)
        else:
            points.append(Waypoint(key.at, key.position, rest, key.where, key.arrive, key.leave, key.tension))
        if key.hold > 0:
            points[-1] = points[-1]._replace(leave=None)
            points.append(Waypoint(key.at + key.hold, key.position, True, key.where, None, key.leave, key.tension))
    return points


def ramps_asked(points: Sequence[Waypoint]) -> tuple[float, float] | None:
    """The seconds asked for from one rest to the next: each end's own, or the other end's, None without any."""
    leave, arrive = points[0].leave or points[-1].arrive, points[-1].arrive or points[0].leave
    if leave is None or arrive is None or all(point.position == points[0].position for point in points):
        return None
    duration = points[-1].time - points[0].time
    return leave.over(duration), arrive.over(duration)


def ramps_fit(points: Sequence[Waypoint]) -> bool:
    """Whether there is time for both ramps from one rest to the next."""
    asked = ramps_asked(points)
    return asked is None or sum(asked) <= points[-1].time - points[0].time + SAME_TIME


def segment_between(points: Sequence[Waypoint], asked: tuple[float, float] | None, limits: Limits) -> Segment:
    """From one rest to the next, with ramps that the limits allow for about the speed that its intervals need."""
    segment = Segment(
        np.array([point.time for point in points], float), np.array([point.position for point in points], float)
    )
    if asked is None:
        return segment
    ramps = list(asked)
    for end in (0, -1):
        step, duration = abs(float(segment.steps[end])), float(segment.durations[end])
        at_both = 2 if len(segment.steps) == 1 else 1
        for _ in range(SETTLED):
            speed = step / max(duration - at_both * ramps[end] / 2, duration / 2)
            ramps[end] = max(asked[end], quickest(speed, limits))
    return replace(segment, ramps=tuple(ramps))

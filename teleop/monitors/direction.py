"""Notices, within about a degree, an axis that moves the other way than it is sent.

The cause is a sign in the profile that does not fit the gimbal, so the cure is a line in it. With a wrong sign of the
speeds the correction makes matters worse all by itself, which is why this may not be left to the stall guard.

What tells a wrong sign from a hand is the shape. A mirrored axis does, a little later, what it was sent, times about
-1: while it starts, at the speed at which it starts. A hand that holds it leaves it where it is, one that pushes it has
a course of its own. So each reading is kept with what had been sent 0 .. 0.25 s before it, and the readings since the
axis rested are fitted, by least squares, with the travel that was sent. Once an axis has moved the right way it is
proved, and not watched any more: a sign does not change.
"""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Callable, Mapping, Sequence
from itertools import takewhile
from typing import NamedTuple

from teleop.core.axes import Axis
from teleop.core.errors import DeviceError
from teleop.core.events import Tick
from teleop.monitors.sent_travel import SentTravel

LAGS = (0.0, 0.05, 0.1, 0.15, 0.2, 0.25)  # s by which a gimbal may be late, beyond the delay that is known
HISTORY = 100  # ticks of what was sent
KEPT = 64  # readings; of older ones every second is kept
GAP = 2.5  # s without a reading, after which it begins anew
REST_ANGLE = 0.15  # deg sent: not yet moving
MOVED = 0.3  # deg from where it rested: more than noise of 0.1 deg in most readings,
RIGHT = 0.4  # deg the right way: then it was no wrong sign that turned it back
AMPLITUDE = 0.8  # deg of a movement that says which way an axis goes
LARGE = 3.0  # deg that are asked for when only the correction moves the axis, or readings are few
PROVED = 1.0  # deg the right way
SCALE = 0.5, 2.0  # times as far as sent: the rate of a full stick is only roughly known
HALVES = 0.3, 3.0  # the same for either half of the way: a push and then nothing is a hand
RMS, SHARE = 0.15, 0.03  # deg beside the fit, and of the movement: noise of 0.1 deg, reports to 0.1 deg, backlash
MIRRORED = 0.3  # deg: so close to the mirror image of its place is no accident
JUMP = 5.0  # deg that a plan may go in a tick; it goes further where it begins anew


class Seen(NamedTuple):
    """A reading (s, deg), the plan's place then, and the travel that had been sent by each of LAGS before it."""

    time: float
    measured: float
    planned: float
    sent: Sequence[float]


class DirectionGuard:
    """An observer. `found` are the axes that go the other way.

    `line` is what the profile needs for an axis. A sink that sends speeds calls `sent` with each of them; without, the
    plan's positions are what is sent. `delay` is how much later than commanded the axes move, in s.
    """

    def __init__(self, line: Callable[[Axis], str], delay: float, speeds: bool) -> None:
        self.found: set[Axis] = set()
        self._line, self._delay, self._speeds = line, delay, speeds
        self._proved: set[Axis] = set()
        self._sent = SentTravel()
        self._history: dict[Axis, deque[tuple[float, float]]] = {}
        self._seen: dict[Axis, list[Seen]] = {}

    def sent(self, now: float, speeds: Mapping[Axis, float]) -> None:
        """These speeds (deg/s, the operator's signs) are sent now."""
        self._sent.sent(now, speeds)

    def observe(self, tick: Tick) -> None:
        """Raises DeviceError for an axis that goes the other way, once."""
        if self._speeds:
            self._sent.advance(tick.time)
        for axis, state in tick.motion.items():
            reading = tick.reported.get(axis)
            if axis in self._proved or axis in self.found or reading is None:
                continue
            history = self._history.setdefault(axis, deque(maxlen=HISTORY))
            history.append((tick.time, self._sent.travel.get(axis, 0.0) if self._speeds else state.position))
            seen = self._seen.setdefault(axis, [])
            if seen and (abs(state.position - seen[-1].planned) > JUMP or reading.time - seen[-1].time > GAP):
                seen.clear()
            if not seen or reading.time > seen[-1].time:
                self._add(axis, Seen(reading.time, reading.position, state.position, self._before(axis, reading.time)))

    def _before(self, axis: Axis, time: float) -> Sequence[float]:
        return [_at(self._history[axis], time - self._delay - lag) for lag in LAGS]

    def _add(self, axis: Axis, latest: Seen) -> None:
        seen = self._seen[axis]
        seen.append(latest)
        if len(seen) > KEPT:
            del seen[1:-8:2]
        moved = latest.measured - seen[0].measured
        ways = latest.planned - seen[0].planned, latest.sent[0] - seen[0].sent[0]
        if abs(moved) >= PROVED and all(abs(way) >= PROVED / 2 and way * moved > 0 for way in ways):
            self._proved.add(axis)
        elif (way := _mirrored(seen)) or (not self._speeds and _in_the_mirror(seen)):
            self.found.add(axis)
            raise DeviceError(
                f"{axis} goes the other way: sent {way or latest.planned:+.1f} deg, measured"
                f" {moved if way else latest.measured:+.1f}; the gimbal's entry in the profile needs {self._line(axis)}"
            )
        elif axis in self._proved:
            del self._seen[axis]


def _at(history: Sequence[tuple[float, float]], time: float) -> float:
    """What had been sent by `time`, in deg; the oldest that is known for a time before it."""
    later = history[-1]
    for earlier in reversed(history):
        if earlier[0] <= time:
            span = later[0] - earlier[0]
            return earlier[1] + (later[1] - earlier[1]) * ((time - earlier[0]) / span if span > 0 else 0.0)
        later = earlier
    return later[1]


def _mirrored(seen: Sequence[Seen]) -> float:
    """How far an axis was sent that goes the other way; 0 when it does not, or while that is unknown."""
    first, latest = seen[0], seen[-1]
    rested = _rested(seen)
    moved = latest.measured - rested
    planned = latest.planned - first.planned
    driven = abs(planned) >= MOVED and planned * moved < 0
    if abs(moved) < (AMPLITUDE if driven else LARGE) or len(seen) < 4:
        return 0.0
    ways = [math.copysign(1.0, moved) * (each.measured - rested) for each in seen]
    if sum(way >= MOVED for way in ways) < (4 if abs(moved) < LARGE else 2):
        return 0.0
    sent = [math.copysign(1.0, moved) * (first.sent[0] - each.sent[0]) for each in seen]
    if any(way <= -RIGHT and so_far >= MOVED for way, so_far in zip(ways, sent, strict=True)):
        return 0.0
    measured = [rested, *(each.measured for each in seen[1:])]
    for lag in range(len(LAGS)):
        sent = [each.sent[lag] for each in seen]
        scale, rms = _fit(sent, measured)
        fits = SCALE[0] <= -scale <= SCALE[1] and rms <= RMS + (SHARE * abs(moved) if driven else 0.0)
        if fits and _halves_too(sent, measured):
            return sent[-1] - sent[0]
    return 0.0


def _rested(seen: Sequence[Seen]) -> float:
    """Where the axis was before it was sent anywhere, the noise averaged out."""
    still = [each.measured for each in takewhile(lambda each: abs(each.sent[0] - seen[0].sent[0]) < REST_ANGLE, seen)]
    return sum(still) / len(still)


def _halves_too(sent: Sequence[float], measured: Sequence[float]) -> bool:
    """Whether the axis went the other way in the first half of what was sent and in the second."""
    middle = min(range(len(sent)), key=lambda index: abs(sent[index] - (sent[0] + sent[-1]) / 2))
    for begin, end in ((0, middle), (middle, -1)):
        way = sent[end] - sent[begin]
        if not way or not HALVES[0] <= (measured[begin] - measured[end]) / way <= HALVES[1]:
            return False
    return True


def _in_the_mirror(seen: Sequence[Seen]) -> bool:
    """Whether an axis that was sent nowhere went to the mirror image of its place: its reports have the wrong sign."""
    here = seen[0].planned
    if len(seen) < 4 or abs(here) < 1.0 or any(each.planned != here for each in seen):
        return False
    return all(abs(each.measured + here) < MIRRORED for each in seen[-3:])


def _fit(x: Sequence[float], y: Sequence[float]) -> tuple[float, float]:
    """The slope of y over x by least squares, and the root mean square of what it leaves; (0, inf) where x is one."""
    middle_x, middle_y = sum(x) / len(x), sum(y) / len(y)
    xx = sum((each - middle_x) ** 2 for each in x)
    if xx < 1e-6:
        return 0.0, math.inf
    xy = sum((a - middle_x) * (b - middle_y) for a, b in zip(x, y, strict=True))
    yy = sum((each - middle_y) ** 2 for each in y)
    return xy / xx, math.sqrt(max(0.0, yy - xy * xy / xx) / len(x))

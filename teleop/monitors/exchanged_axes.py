"""Notices, within a few degrees, that the gimbal reports one axis in the place of another.

Some old firmware answers for its angles in the order yaw, pitch, roll (docs/protocol-facts.md). Read in the usual
order, tilt is measured as roll and roll as tilt: a correction would drive an axis that it does not see, so this may not
be left to the stall guard. What tells an exchange from a hand or a slow gimbal is the shape: the other axis does just
what this one was sent, a little later, and this one does what the other was sent.
"""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Callable, Mapping, Sequence
from itertools import pairwise
from operator import mul
from typing import NamedTuple

from teleop.core.axes import Axis
from teleop.core.errors import DeviceError
from teleop.core.events import Tick
from teleop.monitors.sent_travel import SentTravel

LAGS = (0.0, 0.05, 0.1, 0.15, 0.2, 0.25, 0.3, 0.4)  # s by which a gimbal may be late, beyond the delay that is known
BETWEEN_LAGS = 0.015  # s, of the root mean square between the two nearest
HISTORY = 100  # ticks of what was sent
KEPT = 32  # readings; of older ones every second is kept
GAP = 2.5  # s without a reading, after which it begins anew
JUMP = 5.0  # deg that a plan may go in a tick; it goes further where it begins anew
READINGS = 5  # at least
APART = 1.0  # deg between what the two axes were sent
MOVED = 1.0  # deg that an axis has moved at least
DRIFTS = 0.0, -1.2, -0.6, 0.6, 1.2  # deg/s under speed control
SCALE = 0.5, 2.0  # times as far as sent: the rate of a full stick is only roughly known
RMS, SHARE = 0.15, 0.05  # deg beside the fit, and of the way: noise of 0.1 deg, reports to 0.1 deg, backlash
WORSE = 3.0  # times: so much worse must the usual order fit,
BEYOND = 1.1  # times: and so much worse than a fit may be
NEAR = 0.3  # deg: so close to the place of the other axis is no accident

Pair = tuple[float, float]


class Seen(NamedTuple):
    """A reading of both axes (s, deg), and what had been sent to them by each of LAGS before it."""

    time: float
    measured: Pair
    sent: Sequence[Pair]


class ExchangedAxesGuard:
    """An observer. `pair` are the axes of the gimbal's pitch and roll, and `ratio` the product of their reports' signs.

    `cure` is what the profile needs. A sink that sends speeds calls `sent` with each of them; without, the plan's
    positions are what is sent. `delay` is how much later than commanded the axes move, in s. The pair is added to
    `found`, the axes that are misreported.
    """

    def __init__(
        self, pair: tuple[Axis, Axis], ratio: int, cure: Callable[[], str], delay: float, speeds: bool, found: set[Axis]
    ) -> None:
        self._pair, self._ratio, self._cure, self._delay, self._speeds = pair, ratio, cure, delay, speeds
        self._found, self._over = found, False
        self._moves = [False, False]
        self._way = 0.0  # deg between what the two axes were sent since the first reading
        self._sent = SentTravel()
        self._history: deque[tuple[float, Pair]] = deque(maxlen=HISTORY)
        self._seen: list[Seen] = []

    def sent(self, now: float, speeds: Mapping[Axis, float]) -> None:
        """These speeds (deg/s, the operator's signs) are sent now."""
        self._sent.sent(now, speeds)

    def observe(self, tick: Tick) -> None:
        """Raises DeviceError when the axes are exchanged, once."""
        if self._speeds:
            self._sent.advance(tick.time)
        readings = [tick.reported.get(axis) for axis in self._pair]
        first, second = readings
        self._moves = [axis in tick.motion for axis in self._pair]
        if self._over or first is None or second is None or not any(self._moves):
            return
        sent = self._traveled() if self._speeds else self._planned(tick, (first.position, second.position))
        if self._history and max(abs(now - then) for now, then in zip(sent, self._history[-1][1], strict=True)) > JUMP:
            self._seen.clear()
        self._history.append((tick.time, sent))
        if self._seen and first.time - self._seen[-1].time > GAP:
            self._seen.clear()
        if first.time == second.time and (not self._seen or first.time > self._seen[-1].time):
            before = self._before(first.time - self._delay)
            self._add(Seen(first.time, (first.position, second.position), before))

    def _planned(self, tick: Tick, measured: Pair) -> Pair:
        """Where the axes are sent; one that this run does not move stays where it was measured first."""
        rest = self._seen[0].measured if self._seen else measured
        places = (
            tick.motion[axis].position if axis in tick.motion else place
            for axis, place in zip(self._pair, rest, strict=True)
        )
        first, second = places
        return first, second

    def _traveled(self) -> Pair:
        first, second = (self._sent.travel.get(axis, 0.0) for axis in self._pair)
        return first, second

    def _before(self, time: float) -> Sequence[Pair]:
        """What had been sent by each of LAGS before `time`, to the tick; the oldest that is known at most."""
        latest = reversed(self._history)
        at, sent = next(latest)
        before: list[Pair] = []
        for lag in LAGS:
            while at > time - lag and (earlier := next(latest, None)):
                at, sent = earlier
            before.append(sent)
        return before

    def _add(self, latest: Seen) -> None:
        seen = self._seen
        seen.append(latest)
        if len(seen) > KEPT:
            del seen[1:-8:2]
        pitch, roll = _from(latest.sent[0], seen[0].sent[0])
        self._way = max(self._way if len(seen) > 1 else 0.0, abs(pitch - self._ratio * roll))
        verdict = True if not self._speeds and self._changed_places() else None
        if verdict is None and self._way >= APART:
            verdict = verdict_of(seen, self._ratio, DRIFTS if self._speeds else (0.0,))
        self._over = verdict is not None
        if verdict:
            self._found.update(self._pair)
            raise DeviceError(self._text(seen))

    def _changed_places(self) -> bool:
        """Whether axes that were sent nowhere went each to the place of the other, as by a first position command."""
        first, last = self._seen[0], self._seen[-READINGS:]
        here = first.sent[0]
        if len(self._seen) <= READINGS or any(each.sent[0] != here for each in self._seen):
            return False
        crossed = [self._ratio * here[1 - index] for index in (0, 1)]
        there = [crossed[i] if self._moves[1 - i] else first.measured[i] for i in (0, 1)]
        if max(abs(there[i] - first.measured[i]) for i in (0, 1)) < APART:
            return False
        return all(abs(each.measured[i] - there[i]) < NEAR for each in last for i in (0, 1))

    def _text(self, seen: Sequence[Seen]) -> str:
        sent = _from(seen[-1].sent[0], seen[0].sent[0])
        moved = _from(seen[-1].measured, seen[0].measured)
        index = 0 if abs(sent[0]) >= abs(sent[1]) else 1
        axis, other = self._pair[index], self._pair[1 - index]
        return (
            f"{axis} is measured as {other}: sent {axis} {sent[index]:+.1f} deg, measured {axis} {moved[index]:+.1f}"
            f" and {other} {moved[1 - index]:+.1f}; the gimbal's entry in the profile needs {self._cure()}"
        )


def verdict_of(seen: Sequence[Seen], ratio: int, drifts: Sequence[float]) -> bool | None:
    """True for exchanged axes, False for axes that were seen to be in their places, None while that is unknown.

    `drifts` are what an axis may do beside what it is sent, in deg/s.
    """
    first = seen[0]
    measured = [[each.measured[axis] - first.measured[axis] for each in seen] for axis in (0, 1)]
    moved = [max(map(abs, course)) for course in measured]
    if len(seen) < READINGS or max(moved) < MOVED:
        return None
    usual, crossed = [], []
    for axis, other in ((0, 1), (1, 0)):
        drifted = (_less(measured[axis], drift, seen) for drift in drifts)
        usual.append(min(_best(seen, axis, 1, course) for course in drifted))
        crossed.append(_best(seen, other, ratio, measured[axis]))
    allowed = [RMS + SHARE * way + BETWEEN_LAGS * _fastest(seen, axis) for axis, way in enumerate(moved)]
    still = [_rms(course) for course in measured]  # a hand holds the axis
    if all(left <= most for left, most in zip(crossed, allowed, strict=True)):
        needed = [max(WORSE * left, WORSE * RMS, BEYOND * most) for left, most in zip(crossed, allowed, strict=True)]
        return any(min(usual[axis], still[axis]) >= needed[axis] for axis in (0, 1)) or None
    in_place = [moved[axis] >= MOVED and usual[axis] <= allowed[axis] for axis in (0, 1)]
    far = [crossed[axis] >= WORSE * max(usual[axis], RMS) for axis in (0, 1)]
    return False if any(map(all, zip(in_place, far, strict=True))) else None


def _best(seen: Sequence[Seen], axis: int, ratio: int, measured: Sequence[float]) -> float:
    """What is left when `measured` is explained by what the axis was sent, with the lag that explains most."""
    first = seen[0].sent
    return min(
        _fit([ratio * (each.sent[lag][axis] - first[lag][axis]) for each in seen], measured) for lag in range(len(LAGS))
    )


def _less(measured: Sequence[float], drift: float, seen: Sequence[Seen]) -> Sequence[float]:
    return [angle - drift * (each.time - seen[0].time) for angle, each in zip(measured, seen, strict=True)]


def _from(pair: Pair, first: Pair) -> Pair:
    return pair[0] - first[0], pair[1] - first[1]


def _fit(sent: Sequence[float], measured: Sequence[float]) -> float:
    """What is left, root mean square in deg, when `measured` is explained by `sent` times a scale."""
    xx, xy, yy = (sum(map(mul, a, b)) for a, b in ((sent, sent), (sent, measured), (measured, measured)))
    scale = min(max(xy / xx if xx else 0.0, SCALE[0]), SCALE[1])
    return math.sqrt(max(0.0, yy + scale * (scale * xx - 2 * xy)) / len(measured))


def _fastest(seen: Sequence[Seen], axis: int) -> float:
    """The greatest speed between two readings, in deg/s."""
    return max(abs(b.measured[axis] - a.measured[axis]) / (b.time - a.time) for a, b in pairwise(seen))


def _rms(values: Sequence[float]) -> float:
    return math.sqrt(sum(map(mul, values, values)) / len(values))

"""Where the camera would look at what a tracker reports: a stream of pan and tilt for each source, with its dead man.

The gateway computes them and says when each arrived. How they move is a parabola through the newest ones, by least
squares, so that the noise of a tracker is averaged and an even motion is met without a lag.
"""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Mapping, Sequence

import numpy as np

from teleop.core.axes import Axis, State
from teleop.planner.aim import nearest_turn

RAMP = 0.25  # s from which on the axes come to rest
ENDED = 1.0  # s from which on the stream is over
SOURCES = 16
AIMED = (Axis.PAN, Axis.TILT)
SPAN = 0.2  # s of a stream that is averaged, unless its entry says otherwise
KEPT = 128  # of each
AHEAD = 0.05  # s that a sender's time may lie in the future
LONGEST_BEND = 0.05  # s for which a bend of the way is taken to go on
BENDS = 5  # samples that say how a way bends


class AimStream:
    """What one source has sent. Times are the loop's clock, in s. `span` is over how much of it is averaged."""

    def __init__(self, span: float = SPAN) -> None:
        self._span = span
        self._times: deque[float] = deque(maxlen=KEPT)
        self._rows: deque[dict[Axis, float]] = deque(maxlen=KEPT)
        self._fits: dict[Axis, tuple[float, float, float]] = {}
        self.axes: tuple[Axis, ...] = ()

    def take(self, time: float, axes: Mapping[Axis, float], now: float) -> None:
        """A sample; one out of order or from the future is dropped."""
        if time > now + AHEAD or (self._times and time <= self._times[-1]):
            return
        if tuple(axes) != self.axes or (self._times and time - self._times[-1] > ENDED):
            self._times.clear()
            self._rows.clear()
            self.axes = tuple(axes)
        before = self._rows[-1] if self._rows else None
        row = dict(axes)
        if before is not None and Axis.PAN in row:
            row[Axis.PAN] = nearest_turn(row[Axis.PAN], before[Axis.PAN])
        self._times.append(time)
        self._rows.append(row)
        self._fits.clear()

    def age(self, now: float) -> float:
        return max(0.0, now - self._times[-1]) if self._times else math.inf

    def fresh(self, now: float) -> bool:
        return self.age(now) <= RAMP

    def at(self, axis: Axis, now: float) -> State:
        """Where the axis would be at `now`, and how it moves; there has to be a sample."""
        position, speed, bend = self._fits.get(axis) or self._fit(axis)
        ahead = max(0.0, now - self._times[-1])
        bent = min(ahead, LONGEST_BEND)
        faster = bend * bent
        return State(
            position + speed * ahead + faster * (ahead - bent / 2),
            speed + faster,
            bend if ahead <= LONGEST_BEND else 0.0,
        )

    def _fit(self, axis: Axis) -> tuple[float, float, float]:
        """Position, speed and acceleration at the newest sample."""
        newest = self._times[-1]
        rows = [(t - newest, r[axis]) for t, r in zip(self._times, self._rows, strict=True) if newest - t <= self._span]
        times, places = np.array(rows).T
        degree = 2 if len(rows) >= BENDS else min(1, len(rows) - 1)
        powers = np.vander(times / self._span, degree + 1, increasing=True)
        found = [*np.linalg.lstsq(powers, places, rcond=None)[0].tolist(), 0.0, 0.0]
        made = found[0], found[1] / self._span, 2 * found[2] / self._span**2
        self._fits[axis] = made
        return made


class Aims:
    """The streams by the numbers of their sources, from 1; `spans` are over how much of each is averaged, in s."""

    def __init__(self, spans: Sequence[float] = ()) -> None:
        self._spans = dict(enumerate(spans, 1))
        self._streams: dict[int, AimStream] = {}

    def take(self, source: int, time: float, axes: Mapping[Axis, float], now: float) -> None:
        if any(axis not in AIMED for axis in axes):
            return
        stream = self._streams.get(source)
        if stream is None and len(self._streams) < SOURCES:
            stream = self._streams[source] = AimStream(self._spans.get(source, SPAN))
        if stream is not None:
            stream.take(time, axes, now)

    def get(self, source: int) -> AimStream | None:
        return self._streams.get(source)

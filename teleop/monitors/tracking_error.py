"""How well the devices followed: the error of every reading against what was commanded at that moment.

Readings are compared at their own time, between the two commanded states around it, so that the age of a report does
not look like lag. Sums are kept, not samples: a run of hours takes the memory of one of seconds.
"""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass

from teleop.core.axes import Axis, Motion
from teleop.core.events import Tick


@dataclass
class Score:
    """One axis: how many readings there were, and the error (commanded minus measured, units) over them."""

    readings: int = 0
    squares: float = 0.0
    peak: float = 0.0

    def add(self, error: float) -> None:
        self.readings += 1
        self.squares += error * error
        self.peak = max(self.peak, abs(error))

    @property
    def rms(self) -> float:
        return math.sqrt(self.squares / self.readings) if self.readings else math.nan


class TrackingErrorMonitor:
    """An observer. Readings from before `begin`, on the loop's clock, do not count.

    `planned` is what they are compared with, of a tick: what was commanded, unless a correction was added to that.
    `counts` says of a time whether readings of it do.
    """

    def __init__(
        self,
        begin: Callable[[], float],
        planned: Callable[[Tick], Motion] = lambda tick: tick.motion,
        counts: Callable[[float], bool] = lambda _time: True,
    ) -> None:
        self.scores: dict[Axis, Score] = {}
        self._begin, self._planned, self._counts = begin, planned, counts
        self._latest: Tick | None = None
        self._commanded: deque[tuple[float, Motion]] = deque(maxlen=100)
        self._counted: dict[Axis, float] = {}

    def observe(self, tick: Tick) -> None:
        self._latest = tick
        self._commanded.append((tick.time, self._planned(tick)))
        for axis, reading in tick.reported.items():
            if axis in tick.motion and reading.time != self._counted.get(axis) and reading.time >= self._begin():
                self._counted[axis] = reading.time
                if self._counts(reading.time):
                    error = self._commanded_at(axis, reading.time) - reading.position
                    self.scores.setdefault(axis, Score()).add(error)

    @property
    def seconds(self) -> float:
        """How long the run has been going since its begin."""
        return max(0.0, self._latest.time - self._begin()) if self._latest else 0.0

    def ends(self, axis: Axis) -> tuple[float, float]:
        """Where the axis was last commanded to be, and last measured, in units."""
        assert self._latest is not None
        return self._latest.motion[axis].position, self._latest.reported[axis].position

    def _commanded_at(self, axis: Axis, time: float) -> float:
        later = self._commanded[-1]
        for earlier in reversed(self._commanded):
            if earlier[0] <= time:
                span = later[0] - earlier[0]
                share = (time - earlier[0]) / span if span > 0 else 0.0
                return earlier[1][axis].position + share * (later[1][axis].position - earlier[1][axis].position)
            later = earlier
        return later[1][axis].position

"""The times of the control loop. One `LoopTiming` is given to a run; everything that steps with it takes them there."""

from __future__ import annotations

import math
from dataclasses import dataclass

RATE = 100  # Hz, of ticks
PERIOD = 1 / RATE  # s, of a tick
KEEP_ALIVE = 0.4  # s: the longest a resting loop sleeps; a gimbal forgets a speed after 0.5 s
SAME_TIME = 1e-6  # s: two times that are closer are the same, whatever they were added up from
FIRST_REPORT = 2.0  # s to wait for the first report of every axis in use


@dataclass(frozen=True, slots=True)
class LoopTiming:
    """In s: the tick's `period`, the longest sleep while all axes rest, and the longest wait for the first readings."""

    period: float = PERIOD
    keep_alive: float = KEEP_ALIVE
    first_report: float = FIRST_REPORT

    @property
    def rate(self) -> float:
        """Ticks in a second: whole for any period the loop is run at, so that its times stay on a grid."""
        return round(1 / self.period, 9)


DEFAULTS = LoopTiming()


def whole_ticks(seconds: float) -> float:
    """At least as long, and so many ticks of the usual rate: a time so rounded up is one of the loop's."""
    return math.ceil(seconds * RATE - SAME_TIME) / RATE

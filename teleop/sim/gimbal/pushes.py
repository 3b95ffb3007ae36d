"""When a simulated gimbal says something unasked: beats counted from when they were switched on, never added up."""

from __future__ import annotations

import math
from dataclasses import dataclass

from teleop.dji.message import Message

Due = tuple[float, Message]  # s, and what is pushed then

WINDOW = 1.0  # s: of the beats missed between two polls, as many are made up for as a queue would hold


@dataclass
class Beat:
    """The moments `start` + k * `period` (s) for k = 1 .. `count`; `done` of them are past."""

    start: float
    period: float
    count: float = math.inf
    done: int = 0

    @property
    def end(self) -> float:
        return self.start + self.count * self.period

    def due(self, now: float) -> list[float]:
        """The moments since the last call up to and including `now`, of the last WINDOW at most."""
        last = int(min(self.count, (now - self.start) / self.period + 1.0))
        while last > 0 and self.start + last * self.period > now:
            last -= 1
        first = max(self.done, last - math.ceil(WINDOW / self.period))
        self.done = max(self.done, last)
        return [self.start + beat * self.period for beat in range(first + 1, last + 1)]

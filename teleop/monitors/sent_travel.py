"""How far axes were sent by speeds, each of which a gimbal obeys until the next one, but not for ever."""

from __future__ import annotations

import math
from collections.abc import Mapping

from teleop.core.axes import Axis

HOLDS = 0.5  # s that a speed is obeyed: R SDK V2.5, section 2.3.4.2


class SentTravel:
    """In deg by axis, since the first call; an axis that was sent no speed is not among them."""

    def __init__(self) -> None:
        self.travel: dict[Axis, float] = {}
        self._speeds: Mapping[Axis, float] = {}
        self._sent_at = self._last = -math.inf

    def sent(self, now: float, speeds: Mapping[Axis, float]) -> None:
        """These speeds (deg/s) are sent now, and no others are in force any more."""
        self.advance(now)
        self._speeds, self._sent_at = dict(speeds), now

    def advance(self, now: float) -> None:
        """Up to `now`, by what is in force."""
        until = min(now, self._sent_at + HOLDS)
        if until > self._last > -math.inf:
            for axis, speed in self._speeds.items():
                self.travel[axis] = self.travel.get(axis, 0.0) + speed * (until - self._last)
        self._last = now

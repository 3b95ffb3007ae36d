"""A virtual clock for benches: something happens as its time passes, and it can stall."""

from __future__ import annotations

from collections.abc import Callable

from teleop.core.clock import VirtualClock


class HookedClock(VirtualClock):
    """Calls `hook` after each sleep; `stall` makes the next one so many seconds too long."""

    def __init__(self) -> None:
        super().__init__(1000.0)
        self.hook: Callable[[float], None] = lambda _now: None
        self._too_long = 0.0

    def stall(self, seconds: float) -> None:
        self._too_long += seconds

    def sleep_until(self, time: float) -> None:
        too_long, self._too_long = self._too_long, 0.0
        super().sleep_until(max(time, self.now()) + too_long)
        self.hook(self.now())

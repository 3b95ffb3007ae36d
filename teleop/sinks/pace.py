"""A sink's own rate, slower than the loop's."""

from __future__ import annotations


class Pace:
    """Says which ticks are a sink's: `rate` times a second, from the first tick on, never two for one period."""

    def __init__(self, rate: float) -> None:
        self.period = 1 / rate
        self._next = 0.0

    def due(self, now: float) -> bool:
        """Whether this tick is one of the sink's; asked once a tick. After a pause the rhythm starts afresh."""
        if now < self._next - 1e-6:
            return False
        late = now - self._next
        self._next = now + self.period if late > self.period else self._next + self.period
        return True

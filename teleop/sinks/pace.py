"""A sink's own rate, slower than the loop's."""

from __future__ import annotations

from teleop.motion import Motion


class Pace:
    """Says which ticks are a sink's: `rate` times a second, from the first tick on, never two for one period.

    But for one: the tick in which something starts to move, because a hand that has moved a stick waits for it.
    """

    def __init__(self, rate: float) -> None:
        self.period = 1 / rate
        self._next = 0.0
        self._moving = False

    def due(self, now: float, motion: Motion | None = None) -> bool:
        """Whether this tick is one of the sink's; asked once a tick. After a pause the rhythm starts afresh."""
        moved, self._moving = self._moving, motion is not None and any(s[1] or s[2] for s in motion.values())
        if now < self._next - 1e-6:
            if moved or not self._moving:
                return False
            self._next = now
        late = now - self._next
        self._next = now + self.period if late > self.period else self._next + self.period
        return True

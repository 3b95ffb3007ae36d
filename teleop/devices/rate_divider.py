"""A sink's own rate, slower than the loop's.

Periods are counted from where the rhythm began, never added up: a sum of rounded periods drifts until it misses a tick.
"""

from __future__ import annotations

import math

from teleop.core.axes import Motion

SLACK = 1e-6  # s: a tick that is so little early is on time; more than floats are off by after thirty years of uptime


class RateDivider:
    """Says which ticks are a sink's: `rate` times a second, from the first tick on, never two for one period.

    But for one: the tick in which something starts to move, because a hand that has moved a stick waits for it.
    """

    def __init__(self, rate: float) -> None:
        self.period = 1 / rate
        self._rate = rate
        self._began = -math.inf  # the rhythm (s), and how many periods of it are over
        self._count = 0
        self._moving = False

    def due(self, now: float, motion: Motion | None = None) -> bool:
        """Whether this tick is one of the sink's; asked once a tick. After a pause the rhythm starts afresh."""
        moved, self._moving = self._moving, motion is not None and any(s[1] or s[2] for s in motion.values())
        late = now - (self._began + self._count / self._rate)
        if late < -SLACK:
            if moved or not self._moving:
                return False
            late = self.period  # it begins to move, and so does the rhythm
        if late >= self.period - SLACK:
            self._began, self._count = now, 0
        self._count += 1
        return True

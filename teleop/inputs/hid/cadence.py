"""How often a device reports, seen from its reports: only one that reports all the time repeats itself many times.

`patience` is how long a silence is normal. Of a device with several reports each has its own cadence as well: one that
was repeated all the time and ends is missing, whatever else goes on.
"""

from __future__ import annotations

import math
from collections import deque

SILENT = 0.2  # s without a report, after which a device is not trusted that was not seen to report more rarely
REPEATS = 9  # the latest repetitions whose interval is looked at
FEW_REPEATS = 3  # enough of them to know the interval
SLOWEST_REPEAT = 1.0  # s: what is repeated after longer is no sign of life to be expected
LATE = 2.5  # times the usual interval: then a report is missing
HEARTBEAT = 0.15  # s: what repeats itself more rarely reports changes at once, and lives between them
STEADY = 20  # reports in a row without a change: more than any device that reports changes sends for one


class Cadence:
    """Of a device, or of one of its reports; `interval` is the usual one in s, 0 until it is known."""

    def __init__(self) -> None:
        self.interval = 0.0
        self._same = 0
        self._arrived = -math.inf
        self._intervals: deque[float] = deque(maxlen=REPEATS)  # before reports that repeated the one before

    def take(self, repeats: bool, now: float) -> None:
        """A report came by itself; `repeats`: it is the one before it once more."""
        interval, self._arrived = now - self._arrived, now
        repeats = repeats and interval <= SLOWEST_REPEAT
        if repeats:
            self._intervals.append(interval)
            if len(self._intervals) >= FEW_REPEATS:
                self.interval = sorted(self._intervals)[len(self._intervals) // 2]
        if self._same < STEADY:
            self._same = self._same + 1 if repeats else 0

    @property
    def patience(self) -> float:
        """s without a report after which one is missing."""
        return max(SILENT, LATE * self.interval)

    @property
    def has_heartbeat(self) -> bool:
        """Whether changes are reported at once and, between them, that the device lives."""
        return self.interval > HEARTBEAT

    @property
    def steady(self) -> bool:
        """Whether it has been seen to report without anything having changed."""
        return self._same >= STEADY

    def is_overdue(self, now: float) -> bool:
        """Whether what was repeated all the time has ended."""
        return self.steady and now - self._arrived > self.patience

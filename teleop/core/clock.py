"""The only module that reads the time.

Both clocks are absolute: a loop sleeps until a moment, never for a duration, so that lateness does not add up.
"""

from __future__ import annotations

import time

EXACT = 0.003  # s: a wait as short as that is for a moment that is to be met, not for waking up some time after it
AWAKE = 0.0002  # s of such a wait that are not slept, because a sleep ends that much late


class SystemClock:
    """The machine's monotonic clock, in seconds; a step of the wall clock does not move it."""

    def now(self) -> float:
        return time.monotonic()

    def sleep_until(self, time: float) -> None:
        """Returns at once when `time` has passed; signal handlers run meanwhile."""
        _sleep_until(time)


def _sleep_until(moment: float) -> None:
    awake = AWAKE if moment - time.monotonic() < EXACT else 0.0
    while (remaining := moment - time.monotonic()) > 0:
        if remaining > awake:
            time.sleep(remaining - awake)


class VirtualClock:
    """Time that passes only in `sleep_until`: hours of a run in seconds, and the same every time."""

    def __init__(self, now: float = 0.0) -> None:
        self._now = now

    def now(self) -> float:
        return self._now

    def sleep_until(self, time: float) -> None:
        self._now = max(self._now, time)


def date() -> float:
    """Seconds since 1970 by the wall clock, which may jump: for what is written into files, never for control."""
    return time.time()

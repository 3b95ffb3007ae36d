"""How devices are given back at the end of a run: each by its own steps at its own times, and never for ever.

A sink's `release` says when it is to be called again, or None once all is given back. One that fails is tried again
for a while, because a link that is full or off may come back. Nothing that a sink does keeps a run from ending.
"""

from __future__ import annotations

import math
import threading
from collections.abc import Callable, Sequence
from typing import Any

from teleop.core.errors import TeleopError
from teleop.core.interfaces import Sink

RELEASE_PATIENCE = 0.5  # s to keep trying to give a device back over a link that fails
RELEASE_LONGEST = 10.0  # s for all releases together, whatever a sink still has to do


class Shutdown:
    """`sinks` being given back; `period` (s) is that of the steps, by which their times are kept."""

    def __init__(self, sinks: Sequence[Sink], period: float) -> None:
        self._sinks, self._period = sinks, period
        self._due = dict.fromkeys(range(len(sinks)), -math.inf)  # sink -> when its next step is
        self._steps = [threading.Lock() for _ in sinks]  # held while a sink is in a step, which may hang
        self._end = self._limit = math.inf

    def step(self, now: float, guarded: Callable[..., Any]) -> bool:
        """Whether all is given back. `guarded` calls a sink's release and answers `default` where that fails.

        Raises TeleopError, once, when it took too long; what is still to be given back then is left.
        """
        if math.isinf(self._limit):
            self._end, self._limit = now + RELEASE_PATIENCE, now + RELEASE_LONGEST
        self._advance(now, guarded, again_until=self._end)
        if self._due and now > self._limit:
            self._due.clear()
            raise TeleopError(f"shutdown timed out after {RELEASE_LONGEST:g} s: some devices were not released")
        return not self._due

    def once(self, now: float, guarded: Callable[..., Any]) -> bool:
        """As `step`, but what fails is not tried again. Safe beside a thread that hangs in a sink's step."""
        self._advance(now, guarded, again_until=-math.inf)
        return not self._due

    def _advance(self, now: float, guarded: Callable[..., Any], again_until: float) -> None:
        failed = object()
        for index, due in list(self._due.items()):
            if now < due - self._period / 2 or not self._steps[index].acquire(blocking=False):
                continue
            try:
                again = guarded(self._sinks[index].release, now, default=failed)
            finally:
                self._steps[index].release()
            if again is failed and now < again_until:
                again = now + self._period
            if isinstance(again, int | float):
                self._due[index] = again
            else:  # released, failed for good, or nothing that is a time
                self._due.pop(index, None)

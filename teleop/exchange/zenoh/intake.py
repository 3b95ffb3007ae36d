"""What arrives in Zenoh's threads, on its way to the event loop: bounded in number and rate, and never waited for."""

from __future__ import annotations

import asyncio
import threading
from collections import deque
from collections.abc import Callable
from contextlib import suppress
from time import monotonic
from typing import Any

from teleop.gateway.bucket import Bucket


class Intake:
    """`handle` gets each item in the event loop. At most `most` wait, and `rate` a second are taken; others are
    counted in `dropped`."""

    def __init__(
        self, loop: asyncio.AbstractEventLoop, handle: Callable[[Any], object], most: int, rate: float
    ) -> None:
        self._loop, self._handle, self._most = loop, handle, most
        self._items: deque[Any] = deque()
        self._lock = threading.Lock()
        self._bucket = Bucket(rate, most, most, monotonic())
        self._woken = False
        self.dropped = 0

    def offer(self, item: Any) -> bool:
        """Whether it is taken; from any thread."""
        with self._lock:
            if len(self._items) >= self._most or not self._bucket.take(monotonic()):
                self.dropped += 1
                return False
            self._items.append(item)
            if self._woken:
                return True
            self._woken = True
        with suppress(RuntimeError):  # the loop is closed: all is over
            self._loop.call_soon_threadsafe(self._drain)
        return True

    def _drain(self) -> None:
        with self._lock:
            items, self._items, self._woken = self._items, deque(), False
        for item in items:
            self._handle(item)

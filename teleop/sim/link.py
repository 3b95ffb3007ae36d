"""The cable to a simulated device in this process."""

from __future__ import annotations

import math
import random
from collections import Counter
from collections.abc import Callable
from typing import Protocol

from teleop.core.errors import LinkError
from teleop.sim.gimbal.foreign_traffic import ForeignTraffic


class Device(Protocol):
    """Something that obeys bytes and has no clock of its own; times are seconds and never go back."""

    def receive(self, data: bytes, now: float) -> None:
        """Bytes that arrive at `now`."""
        ...

    def advance(self, now: float) -> bytes:
        """What the device has sent up to `now`."""
        ...


class SimLink:
    """A `Link` to a device at its far end, which lives by the clock `now` (s). It is never lost."""

    def __init__(self, device: Device, now: Callable[[], float]) -> None:
        self._device = device
        self._now = now

    def send(self, data: bytes) -> None:
        self._device.receive(data, self._now())

    def receive(self) -> bytes:
        return self._device.advance(self._now())


class FaultyWire(SimLink):
    """A cable of which something is wrong, as a bus that is not terminated, or an adapter that resets.

    `errors` is the share of the frames, either way, that end as error frames. `reset` is after how many s the adapter
    is gone once, 0 for never. `foreign_traffic`: frames of other ids pass too. `counts` and `foreign` are a link's.
    """

    def __init__(
        self,
        device: Device,
        now: Callable[[], float],
        errors: float = 0.0,
        reset: float = 0.0,
        foreign_traffic: bool = False,
    ) -> None:
        super().__init__(device, now)
        self.counts: Counter[str] = Counter()
        self.foreign: Counter[int] = Counter()
        self._errors, self._reset = errors, now() + reset if reset else math.inf
        self._traffic = ForeignTraffic(now()) if foreign_traffic else None
        self._chance = random.Random(1)  # errors repeat

    def send(self, data: bytes) -> None:
        self._check()
        if not self._damaged():
            super().send(data)

    def receive(self) -> bytes:
        self._check()
        for can_id, _ in self._traffic.due(self._now()) if self._traffic else ():
            self.foreign[can_id] += 1
        data = super().receive()
        return b"" if data and self._damaged() else data

    def _check(self) -> None:
        if self._now() >= self._reset:
            raise LinkError("sim: the adapter is gone: plug it in, then start again")

    def _damaged(self) -> bool:
        if self._errors and self._chance.random() < self._errors:
            self.counts["error frames"] += 1
            return True
        return False

"""The cable to a simulated device in this process."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol


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

"""What a reader of a device waits for, and its steps on a clock that does not wait for it."""

from __future__ import annotations

import math
from collections.abc import Generator
from typing import NamedTuple

from teleop.inputs.hid.backend import HidDevice

EPSILON = 1e-9  # s


class Pause(NamedTuple):
    """Wait for so many seconds."""

    seconds: float


class Read(NamedTuple):
    """Wait for a report of this device, for so many seconds at most."""

    device: HidDevice
    seconds: float


Steps = Generator[Pause | Read, bytes, bool]
"""What a reader does between its waits: it yields what it waits for, and is sent the report, or its OSError thrown."""


class PolledSteps:
    """A reader's steps on a clock that does not wait for it; `time` is how far they have come."""

    def __init__(self, steps: Steps, now: float) -> None:
        self.time = now
        self._steps = steps
        self._request = next(steps)

    def advance(self, now: float) -> None:
        """Take all steps that are due by `now`. Raises what the reader does."""
        while True:
            request = self._request
            end = self.time + request.seconds
            due = getattr(request.device, "next_report", math.inf) if isinstance(request, Read) else math.inf
            if min(due, end) > now + EPSILON:
                return
            self.time = max(self.time, min(due, end))
            try:
                report = request.device.read(0) if isinstance(request, Read) and due <= end else b""
            except OSError as error:
                self._request = self._steps.throw(error)
            else:
                self._request = self._steps.send(report)

    def close(self) -> None:
        self._steps.close()

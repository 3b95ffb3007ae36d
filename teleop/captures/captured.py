"""What a capture holds: where it was made, and each frame with its time."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, NamedTuple

from teleop.core.errors import UsageError
from teleop.links import FAR_END, NEAR_END

TO_DEVICE, FROM_DEVICE = NEAR_END, FAR_END  # the senders on a serial line, which has no ids


class CaptureError(UsageError):
    """A capture that cannot be written in this format, or a file that is none."""


class Captured(NamedTuple):
    """A frame of a CAN bus, or bytes of a serial line. `time` is in s since 1970, `id` a CAN id or a sender."""

    time: float
    id: int
    data: bytes
    extended: bool = False
    remote: bool = False
    error: bool = False  # a report of the adapter's: `id` has the classes of error


@dataclass(frozen=True)
class Source:
    """Where a capture was made. `interface` is a CAN interface's name or a serial port's, at most 15 characters."""

    kind: Literal["can", "serial"]
    interface: str
    device: Literal["gimbal", "drone"] = "gimbal"

"""A serial line in an `exchange` entry: `serial:DEVICE`, with `@BAUD` behind it where that is not the usual one."""

from __future__ import annotations

from typing import NamedTuple

from teleop.config.documents.messages import shown

SERIAL = "serial:"
FASTEST = 4_000_000  # baud


class SerialPlace(NamedTuple):
    """A serial line: its device, and its speed in baud."""

    device: str
    baud: int


def serial_place(text: str, usual: int) -> SerialPlace:
    """The line that `serial:DEVICE` or `serial:DEVICE@BAUD` is; `usual` is the speed without one. Raises ValueError."""
    device, at, baud = text.removeprefix(SERIAL).rpartition("@")
    if not at:
        device, baud = baud, str(usual)
    if not (device and device.isprintable() and baud.isascii() and baud.isdigit() and 0 < int(baud) <= FASTEST):
        raise ValueError(f"must be serial:DEVICE@BAUD, as in serial:/dev/ttyUSB0@{usual}, not {shown(text)}")
    return SerialPlace(device, int(baud))

"""FreeD D1 out: over UDP, or over a serial line of 38400 baud with 8 bits, odd parity and one stop bit."""

from __future__ import annotations

from typing import Protocol

import serial

from teleop.config.exchange.freed import BAUD, RECEIVERS, FreeDSection
from teleop.config.exchange.serial_place import SERIAL, serial_place
from teleop.core.errors import TeleopError
from teleop.exchange.attitude import Attitude, AttitudeFeed
from teleop.exchange.freed.codec import D1, LENGTH, encode
from teleop.exchange.served import Served
from teleop.exchange.udp import udp_sender
from teleop.links.serial import SerialPort

BITS = 11  # of a byte with odd parity on a serial line
FULL = 65535  # counts of an encoder at its far end, unless the receiver's are known

Counts = int | tuple[int, int]


class Sender(Protocol):
    def send(self, data: bytes) -> None: ...

    def close(self) -> None: ...


async def send(section: FreeDSection, to: str, served: Served) -> None:
    """A message for each slot of time, each with the attitude of `latency` before its slot."""
    name = f"freed to {to}"
    feed = AttitudeFeed(served, name, section.latency)
    lens, (x, y, z) = LensCounts(section), section.position
    rate = section.rate
    if to.startswith(SERIAL):
        sender: Sender = SerialSender(to)
        rate = min(rate, int(serial_place(to, BAUD).baud / (BITS * LENGTH)))
    else:
        sender = await udp_sender(to, name, served.notify)
    served.notify(
        f"{name}: camera {section.camera}, {rate:g} messages a second, each with the attitude of"
        f" {section.latency * 1000:g} ms before"
    )

    def pass_on(_instant: float, at: Attitude) -> None:
        sender.send(encode(D1(section.camera, at.pan, at.tilt, at.roll, x, y, z, *lens.counts(at))))

    try:
        await feed.each(rate, pass_on)
    finally:
        sender.close()


class LensCounts:
    """What is sent for zoom and focus: the receiver's ranges, overruled by the entry's own `lens`."""

    def __init__(self, section: FreeDSection) -> None:
        ranges = RECEIVERS.get(section.receiver or "")
        own = section.lens
        self._zoom = _counts(own.zoom, 0 if ranges is None else ranges.zoom)
        self._focus = _counts(own.focus, (0, FULL) if ranges is None else ranges.focus)

    def counts(self, at: Attitude) -> tuple[int, int]:
        """Of zoom and of focus."""
        zoom = self._zoom if isinstance(self._zoom, int) else self._zoom[0]
        if isinstance(self._focus, int):
            return zoom, self._focus
        near, far = self._focus
        return zoom, round(near + (at.focus or 0.0) * (far - near))


def _counts(own: int | list[int] | None, ranges: int | tuple[int, int]) -> Counts:
    if own is None:
        return ranges if isinstance(ranges, int) else (ranges[0], ranges[1])
    return own if isinstance(own, int) else (own[0], own[1])


class SerialSender:
    """Raises TeleopError for a line that cannot be opened; what does not fit into its buffer is left out."""

    def __init__(self, to: str) -> None:
        self._device, baud = serial_place(to, BAUD)
        try:
            self._port = SerialPort(self._device, baud, serial.PARITY_ODD, most_waiting=2 * LENGTH - 1)
        except (OSError, ValueError) as error:
            raise TeleopError(f"to {to}: cannot be opened: {error}") from None

    def send(self, data: bytes) -> None:
        try:
            self._port.write(data)
        except OSError as error:
            raise TeleopError(f"{self._device}: {error}") from None

    def close(self) -> None:
        self._port.close()

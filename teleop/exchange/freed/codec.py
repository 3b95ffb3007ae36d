"""FreeD D1, 29 bytes big-endian: type, camera, pan, tilt, roll, x, y, z, zoom, focus, spare, checksum.

Angles are 24 bits of 1/32768 degree, positions 24 bits of 1/64 mm: Vinten Radamec, free-d Operator's Guide, A.3. Pan is
+ right, tilt + up, roll + clockwise from behind; x right, y forward, z up. Zoom and focus are an encoder's counts.
"""

from __future__ import annotations

import math
from typing import NamedTuple

LENGTH = 29
TYPE = 0xD1
START, ALSO = 0x40, 0x00  # what the sum is taken from: by the book, and by some senders (0x100)
ANGLE, PLACE = 32768, 64000  # counts of a degree and of a meter
MOST = 0x7FFFFF  # counts that 24 bits with a sign have room for


class FreeDError(ValueError):
    """Why bytes are no D1 message; one line."""


class D1(NamedTuple):
    """A camera's attitude in deg, its place in m, and the counts of its lens. `spare` is the maker's own."""

    camera: int
    pan: float
    tilt: float
    roll: float
    x: float
    y: float
    z: float
    zoom: int = 0
    focus: int = 0
    spare: int = 0


class Decoded(NamedTuple):
    """`by_the_book`: its checksum is, and not the one that some senders make."""

    message: D1
    by_the_book: bool


def encode(message: D1) -> bytes:
    """The 29 bytes. Angles wrap at +-180 deg; a place or a count that has no room is cut."""
    body = bytes((TYPE, message.camera & 0xFF))
    body += b"".join(_signed(_half_turn(angle) * ANGLE) for angle in (message.pan, message.tilt, message.roll))
    body += b"".join(_signed(place * PLACE) for place in (message.x, message.y, message.z))
    body += b"".join(min(max(count, 0), 0xFFFFFF).to_bytes(3, "big") for count in (message.zoom, message.focus))
    body += (message.spare & 0xFFFF).to_bytes(2, "big")
    return body + bytes(((START - sum(body)) & 0xFF,))


def decode(data: bytes) -> Decoded:
    """The message that `data` is. Raises FreeDError."""
    if len(data) != LENGTH:
        raise FreeDError(f"has {len(data)} bytes, and a D1 message has {LENGTH}")
    if data[0] != TYPE:
        raise FreeDError(f"is of type {data[0]:02X}, not D1")
    total = sum(data)
    if total & 0xFF not in (START, ALSO):
        raise FreeDError("has a wrong checksum")
    pan, tilt, roll = (_of_signed(data, at) / ANGLE for at in (2, 5, 8))
    x, y, z = (_of_signed(data, at) / PLACE for at in (11, 14, 17))
    zoom, focus, spare = (int.from_bytes(data[begin:end], "big") for begin, end in ((20, 23), (23, 26), (26, 28)))
    return Decoded(D1(data[1], pan, tilt, roll, x, y, z, zoom, focus, spare), total & 0xFF == START)


def _half_turn(angle: float) -> float:
    return math.remainder(angle, 360.0)


def _signed(counts: float) -> bytes:
    return min(max(round(counts), -MOST - 1), MOST).to_bytes(3, "big", signed=True)


def _of_signed(data: bytes, at: int) -> int:
    return int.from_bytes(data[at : at + 3], "big", signed=True)

"""The packets of OpenTrackIO 1.0.1: 16 bytes before each segment of a sample, big-endian, and how segments join.

`OTrk`, a reserved byte, the encoding, a sequence number for each packet, the offset of the segment in the sample, the
length of the segment with a flag for the last one, and a checksum over all but itself: Fletcher-16 by sums modulo 256,
the second sum first.
"""

from __future__ import annotations

import struct
from collections import OrderedDict
from collections.abc import Iterator
from itertools import accumulate
from typing import NamedTuple

MAGIC = b"OTrk"
HEADER = struct.Struct(">4sBBHIH2s")
JSON, CBOR = 1, 2
LAST, LENGTH = 0x8000, 0x7FFF
LARGEST = 65536  # bytes of a sample that is put together
SENDERS = 16  # whose segments are waited for at a time


class PacketError(ValueError):
    """Why bytes are no packet of a sample; one line."""


class Packet(NamedTuple):
    """One segment. `by_the_book`: its checksum is, and not the one of SMPTE's first sender, modulo 255."""

    encoding: int
    sequence: int
    offset: int
    last: bool
    data: bytes
    by_the_book: bool = True


def fletcher16(data: bytes, modulus: int = 256) -> bytes:
    """The second sum, then the first."""
    return bytes((sum(accumulate(data)) % modulus, sum(data) % modulus))


def packets(data: bytes, encoding: int, sequence: int, room: int) -> Iterator[bytes]:
    """The packets that carry a sample, numbered from `sequence` on, with `room` bytes of it in each at most."""
    room = min(room, LENGTH)
    for offset in range(0, max(len(data), 1), room):
        segment = data[offset : offset + room]
        flag = LAST if offset + room >= len(data) else 0
        head = struct.pack(">4sBBHIH", MAGIC, 0, encoding, sequence & 0xFFFF, offset, flag | len(segment))
        yield head + fletcher16(head + segment) + segment
        sequence += 1


def parsed(data: bytes) -> Packet:
    """The packet that `data` is. Raises PacketError."""
    if len(data) < HEADER.size:
        raise PacketError(f"has {len(data)} bytes, and a packet at least {HEADER.size}")
    magic, _, encoding, sequence, offset, length, checksum = HEADER.unpack_from(data)
    segment = data[HEADER.size :]
    if magic != MAGIC:
        raise PacketError("does not begin with OTrk")
    if encoding not in (JSON, CBOR):
        raise PacketError(f"has the encoding {encoding}, and JSON is 1 and CBOR 2")
    if len(segment) != length & LENGTH:
        raise PacketError(f"has {len(segment)} bytes of a sample, and its header says {length & LENGTH}")
    covered = data[: HEADER.size - 2] + segment
    by_the_book = checksum == fletcher16(covered)
    if not by_the_book and checksum not in ((also := fletcher16(covered, 255)), also[::-1]):
        raise PacketError("has a wrong checksum")
    return Packet(encoding, sequence, offset, bool(length & LAST), segment, by_the_book)


class _Begun(NamedTuple):
    encoding: int
    sequence: int
    data: bytes


class Reassembly:
    """Puts samples together again, for each sender on its own; one with a segment missing is dropped."""

    def __init__(self) -> None:
        self._begun: OrderedDict[object, _Begun] = OrderedDict()

    def add(self, sender: object, packet: Packet) -> bytes | None:
        """The whole sample once its last segment is here, else None."""
        begun = self._begun.pop(sender, None)
        if packet.offset == 0:
            data = packet.data
        elif (
            begun is None
            or begun.encoding != packet.encoding
            or packet.offset != len(begun.data)
            or packet.sequence != (begun.sequence + 1) & 0xFFFF
            or packet.offset + len(packet.data) > LARGEST
        ):
            return None
        else:
            data = begun.data + packet.data
        if packet.last:
            return data
        self._begun[sender] = _Begun(packet.encoding, packet.sequence, data)
        while len(self._begun) > SENDERS:
            self._begun.popitem(last=False)
        return None

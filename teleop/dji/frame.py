"""The frame that the gimbal's R SDK and the drone's Onboard SDK share, and how to find one in a stream of bytes.

Neither link marks where a frame begins: CAN cuts it into 8-byte pieces without an index, a serial line gives what has
arrived. So the reader trusts nothing but checksums: it looks for the start byte, believes the length only once the
header's CRC-16 agrees, the content only once the CRC-32 agrees, and after any damage drops a single byte and looks
again, so that a good frame behind (or inside the claimed length of) a damaged one survives. Damage is a value that
callers count, never an exception: on a shared bus it is ordinary.

Layout and checks: R SDK V2.5 sections 2.1, 2.2 and 3.2; the register values are those of docs/protocol-facts.md.
"""

from __future__ import annotations

import struct
from collections.abc import Iterator
from typing import Final, NamedTuple

import crcmod

from teleop.core.errors import TeleopError

START: Final = 0xAA
HEADER_SIZE: Final = 12  # bytes, its CRC-16 included
TAIL_SIZE: Final = 4  # bytes of CRC-32
LARGEST: Final = 0x3FF  # bytes in a whole frame: the length field has ten bits
REPLY: Final = 0x20  # cmd_type bit 5
PIECE: Final = 8  # bytes in a CAN frame
PARTIAL_PATIENCE: Final = 0.1  # s without bytes after which a partial frame will not be finished

_HEADER = struct.Struct("<BHBB3sH")
_CRC16 = struct.Struct("<H")
_CRC32 = struct.Struct("<I")
_crc16 = crcmod.mkCrcFun(0x18005, initCrc=0x3AA3, rev=True, xorOut=0)
_crc32 = crcmod.mkCrcFun(0x104C11DB7, initCrc=0x3AA3, rev=True, xorOut=0)


class FrameError(TeleopError):
    """A frame that cannot be written: a field does not fit its bits."""


class Frame(NamedTuple):
    """One frame; everything on the wire except start, length and checks, so that encoding a decoded frame is exact.

    `data` is what lies between header and CRC-32 (for a plain R SDK frame: set, id, value), at most 1007 bytes, and
    may be empty: such a frame ends with its header. `cmd_type` is the whole byte 3, `encryption` the whole byte 4
    (type in bits 7..5, padding in 4..0), `reserved` three bytes, `version` the six bits beside the length.
    """

    data: bytes
    cmd_type: int = 0
    sequence: int = 0
    encryption: int = 0
    reserved: bytes = bytes(3)
    version: int = 0

    @property
    def is_reply(self) -> bool:
        return bool(self.cmd_type & REPLY)

    @property
    def wants_reply(self) -> bool:
        """Whether the sender insists on a reply (section 2.2: reply types 2 to 31 of a command frame)."""
        return not self.is_reply and self.cmd_type & 0x1F >= 2

    @property
    def allows_reply(self) -> bool:
        """Whether a reply may come (reply types 1 to 31 of a command frame)."""
        return not self.is_reply and bool(self.cmd_type & 0x1F)

    @property
    def is_encrypted(self) -> bool:
        return bool(self.encryption >> 5)

    def encode(self) -> bytes:
        """The bytes on the wire. Raises FrameError when a field does not fit."""
        size = HEADER_SIZE + len(self.data) + TAIL_SIZE if self.data else HEADER_SIZE
        if size > LARGEST:
            raise FrameError(f"a frame of {size} bytes is too long: at most {LARGEST}")
        header = self._header(size)
        header += _CRC16.pack(_crc16(header))
        if not self.data:
            return header
        body = header + self.data
        return body + _CRC32.pack(_crc32(body))

    def _header(self, size: int) -> bytes:
        """The header of a frame of `size` bytes, without its CRC-16."""
        if len(self.reserved) == 3:
            try:
                return _HEADER.pack(
                    START, self.version << 10 | size, self.cmd_type, self.encryption, self.reserved, self.sequence
                )
            except struct.error:
                pass
        raise FrameError(
            f"frame fields do not fit: cmd_type {self.cmd_type} and encryption {self.encryption} must be 0..255, "
            f"sequence {self.sequence} 0..65535, version {self.version} 0..63, reserved {len(self.reserved)} of 3 bytes"
        )


class Damage(NamedTuple):
    """Bytes that are no frame: why the first of them was given up, and all of them."""

    reason: str
    data: bytes

    @property
    def is_padding(self) -> bool:
        """Whether it only fills the last CAN frame of a DJI frame up to 8 bytes, as some clients do."""
        return self.reason == _PADDING


_PADDING: Final = "padding"


class FrameReader:
    """Finds the frames in one direction's byte stream, however it was cut.

    A frame that lost its last bytes is still good when the next frame begins with just those bytes (in one of 256
    cases for a single byte, which is what a CAN bus loses of a frame of 25). Then both are found, the shared bytes
    being taken twice: after a frame the search goes on inside its CRC-32.

    A stream `in_pieces` comes from CAN: the filling of a frame's last piece is not damage.
    """

    def __init__(self, in_pieces: bool = False) -> None:
        self._in_pieces = in_pieces
        self._buffer = b""
        self._taken = 0  # bytes at the head of the buffer that already belong to a frame
        self._last_arrival = 0.0

    @property
    def held(self) -> int:
        """How many of the last bytes may yet become a frame."""
        return len(self._buffer)

    def feed(self, data: bytes, now: float) -> list[Frame | Damage]:
        """What is known once `data` has arrived at `now` (seconds, any origin), in wire order."""
        found = self.flush(now)
        if data:
            self._last_arrival = now
            found.extend(self._scan(self._buffer + data, final=False))
        return found

    def flush(self, now: float) -> list[Frame | Damage]:
        """Give up on a partial frame that has had no bytes for 100 ms at `now`; `math.inf` ends a stream.

        Good frames inside the bytes that were given up are found.
        """
        if not self._buffer or now - self._last_arrival <= PARTIAL_PATIENCE:
            return []
        return list(self._scan(self._buffer, final=True))

    def _scan(self, data: bytes, final: bool) -> Iterator[Frame | Damage]:
        """Cut `data` into frames and damage; when not `final`, what may yet become a frame stays in the buffer."""
        position, taken = 0, self._taken
        reason = ""
        while (start := data.find(START, position)) >= 0:
            verdict = _frame_at(data, start)
            if verdict is None and not final:
                break
            if isinstance(verdict, Frame):
                if start > taken:
                    yield Damage(reason or "no start byte", data[taken:start])
                yield verdict
                taken = start + _size_at(data, start)
                position = taken - TAIL_SIZE
                reason = ""
                if filling := self._filling(data, start, taken):
                    yield Damage(_PADDING, filling)
                    taken += len(filling)
            else:
                if start >= taken and not reason:
                    reason = "no start byte" if start > taken else verdict or "incomplete frame"
                position = start + 1
        end = len(data) if start < 0 else start
        self._buffer, self._taken = data[end:], max(0, taken - end)
        if end > taken:
            yield Damage(reason or "no start byte", data[taken:end])

    def _filling(self, data: bytes, start: int, end: int) -> bytes:
        """What fills the last piece of the frame from `start` to `end`, b"" for nothing.

        Pieces arrive whole. So a start byte behind the frame begins the next one when a good header follows, or as long
        as a single piece is there.
        """
        size = (start - end) % PIECE if self._in_pieces else 0
        filling, header = data[end : end + size], data[end : end + HEADER_SIZE]
        if not size or len(filling) < size:
            return b""
        begins = not _crc16(header) if len(header) == HEADER_SIZE else len(header) == PIECE
        return b"" if filling[0] == START and begins else filling


def _size_at(data: bytes, start: int) -> int:
    return (data[start + 1] | data[start + 2] << 8) & LARGEST


def _frame_at(data: bytes, start: int) -> Frame | str | None:
    """The frame that begins at `start`, or why there is none, or None when more bytes are needed to tell."""
    header = data[start : start + HEADER_SIZE]
    if len(header) < HEADER_SIZE:
        return None
    if _crc16(header):  # over bytes with their own CRC the register ends at zero
        return "header CRC-16 is wrong"
    _, version_and_size, cmd_type, encryption, reserved, sequence = _HEADER.unpack_from(header)
    size = version_and_size & LARGEST
    if size != HEADER_SIZE and size <= HEADER_SIZE + TAIL_SIZE:
        return f"length {size} is impossible"
    whole = data[start : start + size]
    if len(whole) < size:
        return None
    if size > HEADER_SIZE and _crc32(whole):
        return "frame CRC-32 is wrong"
    return Frame(whole[HEADER_SIZE:-TAIL_SIZE], cmd_type, sequence, encryption, reserved, version_and_size >> 10)


def pieces(frame: bytes) -> tuple[bytes, ...]:
    """A frame as it is cut for CAN: consecutive pieces of 8 bytes, the last one short."""
    return tuple(frame[start : start + PIECE] for start in range(0, len(frame), PIECE))

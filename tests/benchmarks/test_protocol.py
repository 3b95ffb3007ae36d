"""What the protocol costs, as ratios: `python tests/benchmarks/test_protocol.py` prints them.

Times on a shared machine mean little, ratios of things run in turn more: each contender is run in short rounds, one
after the other, and its best round counts. Pytest checks only that the contenders do the same work; it times nothing.
"""

from __future__ import annotations

import struct
import sys
import time
import zlib
from collections.abc import Callable

import crcmod

from teleop.dji.frame import Frame, FrameReader, pieces
from teleop.dji.gimbal.messages import Position, Push
from teleop.dji.gimbal.r_sdk import R_SDK
from teleop.dji.gimbal.session import Session

ROUNDS, CALLS = 300, 100

POSITION = Position(3.2, 4.8, 6.4)
SEQUENCE = 0x1122
PUSH = Push(True, True, True, 1.1, 2.2, 3.3, 4.4, 5.5, 6.6, 145, 55, 179, 179, 30, 30, 46, 54, 65)
PUSHES = 100
PUSH_FRAME = Frame(PUSH.data()).encode()
STREAM = PUSH_FRAME * PUSHES

_HEADER = struct.Struct("<BHBB3sH")
_POSITION = struct.Struct("<BBhhhBB")
_PUSH = struct.Struct("<BBBhhhhhhBBBBBBBBB")
_crc16 = crcmod.mkCrcFun(0x18005, initCrc=0x3AA3, rev=True, xorOut=0)


def encode() -> tuple[bytes, ...]:
    """A position command as a message, to the pieces that go onto the bus."""
    return pieces(Frame(POSITION.data(), POSITION.cmd_type, SEQUENCE).encode())


def encode_bare() -> tuple[int, int]:
    """What no implementation can do without: the fields packed, and both checks."""
    header = _HEADER.pack(0xAA, 26, 3, 0, b"\0\0\0", SEQUENCE)
    value = _POSITION.pack(0x0E, 0x00, 32, 48, 64, 0x01, 20)
    return _crc16(header), zlib.crc32(header + b"\xa2\x42" + value, 0xFFFFC55C) ^ 0xFFFFFFFF


def encode_bitwise(crc: Callable[[bytes, int, int, int], int]) -> tuple[bytes, ...]:
    """The same frame and pieces with checks computed bit by bit."""
    header = _HEADER.pack(0xAA, 26, 3, 0, b"\0\0\0", SEQUENCE)
    header += crc(header, 16, 0x8005, 0xC55C).to_bytes(2, "little")
    body = header + _POSITION.pack(0x0E, 0x00, 32, 48, 64, 0x01, 20)
    return pieces(body + crc(body, 32, 0x04C11DB7, 0xC55C0000).to_bytes(4, "little"))


def reflect(value: int, width: int) -> int:
    return int(f"{value:0{width}b}"[::-1], 2)


def crc_reflected(data: bytes, width: int, polynomial: int, start: int) -> int:
    """The quickest bitwise form: everything mirrored beforehand."""
    register, polynomial = reflect(start, width), reflect(polynomial, width)
    for byte in data:
        register ^= byte
        for _ in range(8):
            register = register >> 1 ^ polynomial if register & 1 else register >> 1
    return register


def crc_as_documented(data: bytes, width: int, polynomial: int, start: int) -> int:
    """The form of the document's parameters (RefIn, RefOut, Init): each byte and the result mirrored."""
    register, top, mask = start, 1 << width - 1, (1 << width) - 1
    for byte in data:
        register ^= mirrored(byte, 8) << width - 8
        for _ in range(8):
            register = (register << 1 ^ polynomial if register & top else register << 1) & mask
    return mirrored(register, width)


def mirrored(value: int, width: int) -> int:
    result = 0
    for bit in range(width):
        if value & 1 << bit:
            result |= 1 << width - 1 - bit
    return result


def decode() -> list[Push]:
    """A stream of pushes to message objects."""
    found = FrameReader().feed(STREAM, 0.0)
    messages = [R_SDK.decode(item).message for item in found if isinstance(item, Frame)]
    return [message for message in messages if isinstance(message, Push)]


def decode_in_a_session() -> list[Push]:
    """The same with everything a session adds: matching, counting."""
    received = Session().receive(STREAM, 0.0)
    return [item.message for item in received if isinstance(item.message, Push)]


def decode_bare() -> int:
    """What no implementation can do without: both checks, and the fields unpacked."""
    good = 0
    size = len(PUSH_FRAME)
    for start in range(0, len(STREAM), size):
        whole = STREAM[start : start + size]
        _HEADER.unpack_from(whole)
        good += _crc16(whole[:12]) == 0 and zlib.crc32(whole, 0xFFFFC55C) == 0xFFFFFFFF
        _PUSH.unpack_from(whole, 12)
    return good


def test_encoders_make_the_documents_sample() -> None:
    sample = "aa1a0003000000002211a2420e0020003000400001147b4097be"
    assert b"".join(encode()).hex() == sample
    assert encode_bare() == (0x42A2, 0xBE97407B)
    for crc in (crc_reflected, crc_as_documented):
        assert b"".join(encode_bitwise(crc)).hex() == sample


def test_decoders_find_every_push() -> None:
    assert decode() == decode_in_a_session() == [PUSH] * PUSHES
    assert decode_bare() == PUSHES


def best(contenders: dict[str, Callable[[], object]], calls: int) -> dict[str, float]:
    """Microseconds of each contender's best round."""
    fastest = dict.fromkeys(contenders, float("inf"))
    for _ in range(ROUNDS):
        for name, run in contenders.items():
            start = time.perf_counter()
            for _ in range(calls):
                run()
            fastest[name] = min(fastest[name], (time.perf_counter() - start) / calls * 1e6)
    return fastest


def main() -> None:
    encoding = best({"encode": encode, "bare": encode_bare}, CALLS)
    bitwise = best(
        {
            "reflected": lambda: encode_bitwise(crc_reflected),
            "documented": lambda: encode_bitwise(crc_as_documented),
            "crcs": lambda: crc_as_documented(bytes(10), 16, 1, 1) + crc_as_documented(bytes(22), 32, 1, 1),
        },
        1,
    )
    checks = best({"crcs": lambda: _crc16(bytes(10)) + zlib.crc32(bytes(22), 0)}, CALLS)
    decoding = best({"decode": decode, "session": decode_in_a_session, "bare": decode_bare}, 1)
    ours = encoding["encode"]
    sys.stdout.write(
        f"position command to CAN pieces: {ours:.2f} us\n"
        f"  {ours / encoding['bare']:.1f} times struct.pack and two CRC calls\n"
        f"  {bitwise['reflected'] / ours:.0f} times as fast as with bitwise CRCs, mirrored beforehand\n"
        f"  {bitwise['documented'] / ours:.0f} times as fast as with bitwise CRCs by the document's parameters\n"
        f"  ({bitwise['crcs'] / checks['crcs']:.0f} times for the CRCs alone)\n"
        f"stream of pushes to messages: {decoding['decode'] / PUSHES:.2f} us each\n"
        f"  {decoding['decode'] / decoding['bare']:.1f} times the bare calls\n"
        f"  {decoding['session'] / decoding['bare']:.1f} times through a session\n"
    )


if __name__ == "__main__":
    main()

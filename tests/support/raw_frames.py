"""Frames built without any of the package: both checksums bit by bit, as the two protocol documents describe them."""

from __future__ import annotations

REPLY = 0x20
_START = 0x3AA3  # of both registers: r-sdk-facts.md "Frame"


def _crc(data: bytes, polynomial: int) -> int:
    register = _START
    for byte in data:
        register ^= byte
        for _ in range(8):
            register = register >> 1 ^ (polynomial if register & 1 else 0)
    return register


def raw_frame(data: bytes, kind: int = 0, sequence: int = 1, encryption: int = 0) -> bytes:
    """A whole frame around `data`; `kind` is byte 3: a reply type or a session."""
    size = 16 + len(data) if data else 12
    header = bytes((0xAA, size & 0xFF, size >> 8, kind, encryption, 0, 0, 0)) + sequence.to_bytes(2, "little")
    header += _crc(header, 0xA001).to_bytes(2, "little")
    return header + data + _crc(header + data, 0xEDB88320).to_bytes(4, "little") if data else header


def raw_data(frame: bytes) -> bytes:
    """What lies between header and CRC-32."""
    return frame[12:-4]


def cut(stream: bytes) -> list[bytes]:
    """The frames of a stream in which nothing is damaged and nothing is missing."""
    frames = []
    while stream:
        size = stream[1] | (stream[2] & 3) << 8
        frame, stream = stream[:size], stream[size:]
        assert frame == raw_frame(frame[12:-4], frame[3], frame[8] | frame[9] << 8, frame[4]), frame.hex()
        frames.append(frame)
    return frames

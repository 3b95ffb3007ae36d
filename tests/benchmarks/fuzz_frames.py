"""A million mutated streams: `python tests/benchmarks/fuzz_frames.py [STREAMS] [SEED]`.

Each stream is a few good frames of the gimbal's protocol or of the drone's, with damage done to some of them and junk
between, cut at random. A frame that was not touched must come out, in order; every byte must come out as a frame or as
damage; nothing may raise: a session and the JSON lines see all of it too. Prints what it counted; the exit code is 1
when a frame was lost.
"""

from __future__ import annotations

import math
import random
import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from teleop.dji.drone.encryption import Cipher
from teleop.dji.drone.onboard_sdk import A3, M100
from teleop.dji.drone.session import OnboardSession
from teleop.dji.frame import Damage, Frame, FrameReader
from teleop.dji.gimbal.r_sdk import R_SDK
from teleop.dji.gimbal.session import Session
from teleop.dji.json_record import Transcriber, restore
from teleop.dji.registry import Registry

CIPHER = Cipher(bytes(32))


@dataclass(frozen=True)
class Protocol:
    """What a stream is of: its messages, the sizes of its values, what byte 3 and byte 4 may be, and who hears it."""

    registry: Registry
    sizes: Sequence[int]
    cmd_types: Sequence[int]
    encryptions: Sequence[int]
    session: Callable[[], Session | OnboardSession]


PROTOCOLS = (
    Protocol(R_SDK, (0, 1, 1, 4, 7, 8, 9, 22, 22), (0x00, 0x03, 0x20), (0,), Session),
    Protocol(M100, (0, 1, 2, 2, 17, 44, 64, 126), (0x00, 0x01, 0x02, 0x22), (0, 0, 0x25), OnboardSession),
    Protocol(A3, (0, 1, 2, 16, 202), (0x00, 0x02, 0x22), (0, 0x2D), lambda: OnboardSession(A3, cipher=CIPHER)),
)


def some_frame(protocol: Protocol, rng: random.Random) -> Frame:
    """Mostly the commands and replies of the protocol, sometimes anything."""
    command = rng.choice(protocol.registry.messages).set_and_id if rng.random() < 0.9 else rng.randbytes(2)
    data = command + rng.randbytes(rng.choice((*protocol.sizes, rng.randrange(60))))
    encryption = rng.choice(protocol.encryptions)
    if encryption and rng.random() < 0.7:
        data, encryption = CIPHER.encrypt(data)
    return Frame(data, rng.choice(protocol.cmd_types), rng.randrange(8), encryption)


def harm(data: bytes, rng: random.Random) -> bytes:
    """One of the ways in which a bus loses, repeats, swaps or flips what it carries."""
    at, end = sorted((rng.randrange(len(data)), rng.randrange(len(data) + 1)))
    return rng.choice(
        (
            data[:at] + bytes((data[at] ^ 1 << rng.randrange(8),)) + data[at + 1 :],
            data[:at],
            data[at + 1 :],
            data[:at] + data[end + 1 :],
            data[:at] + rng.randbytes(rng.randrange(1, 9)) + data[at:],
            data[:at] + b"\xaa" + data[at:],
            data[end:] + data[:at],
        )
    )


def mutated(protocol: Protocol, rng: random.Random) -> tuple[bytes, list[Frame]]:
    """A stream, and the frames in it that were not touched."""
    parts, whole = [], []
    for _ in range(rng.randrange(1, 6)):
        frame = some_frame(protocol, rng)
        encoded = frame.encode()
        if rng.random() < 0.5:
            changed = harm(encoded, rng)
            parts.append(changed)
        else:
            parts.append(encoded)
            whole.append(frame)
        if rng.random() < 0.2:
            parts.append(rng.choice((b"\xaa", b"\xaa\x1a\x00", rng.randbytes(rng.randrange(12)))))
    return b"".join(parts), whole


def survivors(stream: bytes, rng: random.Random) -> list[Frame | Damage]:
    reader = FrameReader()
    found: list[Frame | Damage] = []
    at = 0
    while at < len(stream):
        size = rng.choice((1, 8, 8, 8, 64))
        found += reader.feed(stream[at : at + size], 0.0)
        at += size
    return found + reader.flush(math.inf)


def covers(pieces: list[bytes], stream: bytes) -> bool:
    """Whether `pieces` are all of `stream` in order; a frame may share up to four bytes with the one before it."""
    at = 0
    for piece in pieces:
        shared = next((count for count in range(5) if at >= count and stream.startswith(piece, at - count)), None)
        if shared is None:
            return False
        at += len(piece) - shared
    return at == len(stream)


def loses_a_frame(protocol: Protocol, stream: bytes, whole: list[Frame], rng: random.Random) -> bool:
    """Whether an untouched frame of one stream did not come out; asserts that no byte is lost or made up."""
    found = survivors(stream, rng)
    transcriber = Transcriber(protocol.registry, lambda: CIPHER)
    lines = [transcriber.record(item) for item in found]
    assert covers([restore(protocol.registry, line, lambda: CIPHER) for line in lines], stream)
    protocol.session().receive(stream, 0.0)
    at = 0
    for frame in whole:
        if frame not in found[at:]:
            return True
        at = found.index(frame, at) + 1
    return False


def main(streams: int = 1_000_000, seed: int = 0) -> int:
    rng = random.Random(seed)
    frames = lost = 0
    for number in range(streams):
        protocol = PROTOCOLS[number % len(PROTOCOLS)]
        stream, whole = mutated(protocol, rng)
        frames += len(whole)
        if loses_a_frame(protocol, stream, whole, rng):
            sys.stdout.write(f"stream {number}: a frame is lost of {stream.hex()}\n")
            lost += 1
    sys.stdout.write(f"{streams} streams with {frames} untouched frames, seed {seed}: lost in {lost}, nothing raised\n")
    return 1 if lost else 0


if __name__ == "__main__":
    sys.exit(main(*map(int, sys.argv[1:])))

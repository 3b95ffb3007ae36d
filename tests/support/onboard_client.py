"""A client of the simulated drone that builds its frames without any of the package, and reads bytes."""

from __future__ import annotations

import struct
from collections.abc import Iterator

from cryptography.hazmat.primitives.ciphers import Cipher, algorithms, modes
from raw_frames import cut, raw_data, raw_frame

from teleop.sim.drone.device import SimulatedDrone
from teleop.sim.drone.settings import DroneSettings

ACTIVATE = b"\x00\x01" + struct.pack("<III32s", 1030093, 2, 0x03010A00, b"9" * 32)
OBTAIN, RELEASE = b"\x01\x00\x01", b"\x01\x00\x00"
GO_HOME, TAKE_OFF, LAND = 1, 4, 6


KEY = bytes.fromhex("00112233445566778899aabbccddeeff0123456789abcdeffedcba9876543210")  # of the maker's vectors


def encrypted(data: bytes, session: int, sequence: int, key: bytes = KEY) -> bytes:
    """A frame whose data are encrypted as docs/protocol-facts.md says, filled up with arbitrary bytes."""
    padding = 16 - len(data) % 16
    aes = Cipher(algorithms.AES256(key), modes.ECB()).encryptor()
    return raw_frame(aes.update(data + b"\xee" * padding) + aes.finalize(), session, sequence, 1 << 5 | padding)


class Client:
    """Sends commands in session 2 and reads what acknowledges them."""

    def __init__(self, **settings: object) -> None:
        self.drone = SimulatedDrone(settings=DroneSettings(**settings))  # type: ignore[arg-type]
        self.now = 0.0
        self.tasks = 0
        self._sequences: Iterator[int] = iter(range(1, 60000))
        self.unasked: list[bytes] = []

    def ask(self, data: bytes) -> str:
        """The value of the one acknowledgement, which comes at once; "" for none."""
        sequence = next(self._sequences)
        self.drone.receive(raw_frame(data, 2, sequence), self.now)
        acks = self.listen()
        assert all(frame[8:10] == sequence.to_bytes(2, "little") for frame in acks)
        return "".join(raw_data(frame).hex() for frame in acks)

    def tell(self, data: bytes) -> None:
        self.drone.receive(raw_frame(data, 0, next(self._sequences)), self.now)

    def task(self, kind: int) -> str:
        self.tasks += 1
        return self.ask(bytes((1, 1, self.tasks, kind)))

    def result(self) -> str:
        return self.ask(bytes((1, 2, self.tasks)))

    def wait(self, seconds: float) -> None:
        self.now += seconds
        assert self.listen() == []

    def listen(self) -> list[bytes]:
        frames = cut(self.drone.advance(self.now))
        self.unasked += [frame for frame in frames if not frame[3] & 0x20]
        return [frame for frame in frames if frame[3] & 0x20]

    @classmethod
    def in_control(cls, **settings: object) -> Client:
        client = cls(**settings)
        assert client.ask(ACTIVATE) == "0000"
        client.ask(OBTAIN)
        assert client.ask(OBTAIN) == "0200"
        return client

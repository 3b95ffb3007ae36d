"""Captures made by hand: a host and a gimbal whose frames a test writes down with their times."""

from __future__ import annotations

from pathlib import Path

from teleop.captures.captured import Captured, Source
from teleop.captures.writer import CaptureWriter
from teleop.dji.frame import REPLY, Frame, pieces
from teleop.dji.message import Message
from teleop.links.can import GIMBAL_ID, HOST_ID

CAN0 = Source("can", "can0")
STARTED = 1_732_888_888.0  # s since 1970


class MadeCapture:
    """The frames of a bus, at times in s from STARTED on."""

    def __init__(self) -> None:
        self.frames: list[Captured] = []

    def ask(self, time: float, message: Message, sequence: int) -> None:
        """The host sends `message`."""
        self.send(time, HOST_ID, Frame(message.data(), 0x03, sequence).encode())

    def answer(self, time: float, message: Message, sequence: int, bare: bytes | None = None) -> None:
        """The gimbal replies with `message`, without set and id when `bare` is its value."""
        data = message.data() if bare is None else bare
        self.send(time, GIMBAL_ID, Frame(data, REPLY, sequence).encode())

    def push(self, time: float, message: Message, sequence: int = 0) -> None:
        self.send(time, GIMBAL_ID, Frame(message.data(), 0, sequence).encode())

    def send(self, time: float, can_id: int, data: bytes) -> None:
        self.frames += [Captured(STARTED + time, can_id, piece) for piece in pieces(data)]

    def write(self, path: Path, source: Source = CAN0) -> Path:
        writer = CaptureWriter(path, source)
        for frame in self.frames:
            writer.add(frame)
        writer.close()
        return path

"""A drone's connection and telemetry without any drone: a test reads what was sent, and decides what is answered."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, cast

from teleop.devices.connection import Answer, Connection
from teleop.devices.drone.telemetry import Telemetry
from teleop.dji.message import Message


class FakeConnection:
    """`streamed` and `requests` are what was sent, `withdrawn` what must not be sent again."""

    def __init__(self) -> None:
        self.opened = 0.0
        self.streamed: list[Message] = []
        self.requests: list[Message] = []
        self.withdrawn: set[type[Message]] = set()
        self._handlers: dict[type[Message], Callable[[Answer], None]] = {}

    def on_answer(self, kind: type[Message], handler: Callable[[Answer], None]) -> None:
        self._handlers[kind] = handler

    def stream(self, message: Message) -> None:
        self.streamed.append(message)

    def request(self, message: Message, _now: float) -> int:
        self.requests.append(message)
        return len(self.requests) - 1

    def withdraw(self, *kinds: type[Message]) -> None:
        self.withdrawn |= set(kinds)

    def answer(self, reply: Message | None, sequence: int = -1) -> None:
        """The answer to a request, the last one unless given; None when none came."""
        sequence %= len(self.requests)
        self._handlers[type(self.requests[sequence])](Answer(sequence, 0.0, reply))

    @property
    def real(self) -> Connection:
        return cast(Connection, self)


class FakeTelemetry:
    """`parts` are what the drone says, each since `since` (s)."""

    activated = True

    def __init__(self, **parts: Any) -> None:
        self.parts = parts
        self.since = 0.0
        self.control_lost = 0

    def get(self, part: str, now: float, within: float = 1.0) -> Any:
        return self.parts.get(part) if now - self.since <= within else None

    def service(self, now: float) -> None: ...

    @property
    def real(self) -> Telemetry:
        return cast(Telemetry, self)

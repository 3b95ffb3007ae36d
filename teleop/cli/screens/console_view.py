"""What the terminal shows beside a console: the messages, a line each as they come. The picture is in the browser."""

from __future__ import annotations

from collections.abc import Callable
from types import TracebackType
from typing import Self

from teleop.cli.screens.live_view import new_messages
from teleop.cli.screens.stderr_writer import StderrWriter
from teleop.core.events import Tick
from teleop.manual.status import Message, OperatorStatus


class ConsoleView:
    """`status` is the operator's."""

    def __init__(self, status: Callable[[], OperatorStatus]) -> None:
        self._status = status
        self._lines = StderrWriter()
        self._last: Message | None = None
        self._begin: float | None = None

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._lines.finish()

    def observe(self, tick: Tick) -> None:
        self._begin = tick.time if self._begin is None else self._begin
        messages = self._status().messages
        for message in reversed(new_messages(messages, self._last)):
            self._lines.notify(f"{tick.time - self._begin:6.1f} s  {message.text}")
        self._last = messages[0] if messages else self._last

    def notify(self, text: str) -> None:
        self._lines.notify(text)

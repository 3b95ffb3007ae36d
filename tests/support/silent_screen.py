"""A screen that shows nothing: it keeps what is written to it, and what was on it."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import TracebackType
from typing import Self

from teleop.core.events import Tick


class SilentScreen:
    def __init__(self) -> None:
        self.said: list[str] = []
        self.ticks: list[Tick] = []
        self.entered = self.left = 0

    def notify(self, text: str) -> None:
        self.said.append(text)

    def observe(self, tick: Tick) -> None:
        self.ticks.append(tick)

    def __enter__(self) -> Self:
        self.entered += 1
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.left += 1


@contextmanager
def no_signals(
    _interrupt: Callable[[str], object], _release: Callable[[], object], _notify: Callable[[str], object]
) -> Iterator[None]:
    """For a run that no signal ends."""
    yield

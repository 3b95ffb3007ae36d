"""What a run that moves by itself shows of itself on stderr: a view on a terminal, elsewhere lines.

On a terminal a thread draws (`picture`), from what the control thread has left for it. What is said in between stands
in the view, and is printed for good when it ends.
"""

from __future__ import annotations

import sys
from abc import ABC, abstractmethod
from collections import deque
from contextlib import ExitStack
from types import TracebackType
from typing import Self

from rich.text import Text

from teleop.cli.screens.folded import folded
from teleop.cli.screens.picture import Picture, Rows, Sheet
from teleop.cli.screens.stderr_writer import MOST, StderrWriter
from teleop.core.events import Tick

NOTES = 5  # of the latest messages, shown in the view


class Screen(ABC):
    """A sink that only shows, under the `sheet`. `silent` is for programs: then only warnings are printed."""

    def __init__(self, title: str, silent: bool, sheet: Sheet | None = None) -> None:
        self._title, self._silent = title, silent
        self._lines = StderrWriter()
        self._said: deque[str] = deque(maxlen=MOST)
        self._picture = Picture(self._draw, sheet=sheet)
        self._on_screen = self._picture.possible and not silent
        self._stack = ExitStack()

    def __enter__(self) -> Self:
        if self._on_screen:
            self._stack.enter_context(self._picture)
        elif not self._silent:
            self._lines.notify(self._title)
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._stack.close()
        if self._on_screen:
            for line in self._said:
                self._lines.notify(folded(line, sys.stderr))
        self._lines.finish()

    def notify(self, text: str) -> None:
        """A line that stays."""
        if self._on_screen:
            self._said.append(f"teleop: {text}")
        else:
            self._lines.notify(f"teleop: {text}")

    @abstractmethod
    def observe(self, tick: Tick) -> None: ...

    @property
    def _in_lines(self) -> bool:
        """Whether what is to be seen is written as lines."""
        return not self._on_screen and not self._silent

    @property
    def _notes(self) -> list[Text]:
        return [Text(f" {line}") for line in list(self._said)[-NOTES:]]

    @abstractmethod
    def _draw(self, width: int, height: int) -> Rows: ...

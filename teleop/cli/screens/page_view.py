"""What is shown a page at a time: a picture on a terminal, lines elsewhere."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import ExitStack
from typing import Self

from teleop.cli.screens.picture import Picture, Rows, Sheet
from teleop.cli.screens.stderr_writer import StderrWriter


class PageView:
    """`draw` makes the picture, which is there while this is entered; without one, `_lines` take what is said.

    `sheet` is what may lie over it.
    """

    def __init__(self, draw: Callable[[int, int], Rows], sheet: Sheet | None = None) -> None:
        self._picture = Picture(draw, sheet=sheet)
        self._lines = StderrWriter()
        self._stack = ExitStack()

    def __enter__(self) -> Self:
        if self._picture.possible:
            self._stack.enter_context(self._picture)
        return self

    def __exit__(self, *_: object) -> None:
        self._stack.close()
        self._lines.finish()

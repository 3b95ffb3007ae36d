"""What a run shows of itself on stderr: on a terminal a part that is drawn again and again, elsewhere lines.

On a terminal a thread of rich's redraws, from what the control thread has left for it; a terminal that is slow or
stopped holds up that thread and no other. What is said in between stands below the picture, and stays when it ends.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections import deque
from types import TracebackType
from typing import Self

from rich.console import Console, Group, RenderableType
from rich.live import Live
from rich.text import Text

from teleop.cli.lines import Lines
from teleop.motion import Tick

NOTES = 5  # of what was said, that stand below the picture


class Screen(ABC):
    """A sink that only shows. `silent` is for programs: nothing then but what has to be said."""

    def __init__(self, title: str, silent: bool, redraws: int) -> None:
        self._title, self._silent = title, silent
        self._lines = Lines()
        self._notes: deque[str] = deque(maxlen=NOTES)
        console = Console(stderr=True)
        self._live = (
            Live(console=console, get_renderable=self._picture, refresh_per_second=redraws)
            if console.is_terminal and not silent
            else None
        )

    def __enter__(self) -> Self:
        if self._live:
            self._live.start()
        elif not self._silent:
            self._lines.say(self._title)
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._live:
            self._live.stop()
        self._lines.finish()

    def say(self, text: str) -> None:
        """A line that stays."""
        if self._live:
            self._notes.append(f"teleop: {text}")
        else:
            self._lines.say(f"teleop: {text}")

    @abstractmethod
    def write(self, tick: Tick) -> None: ...

    def release(self, now: float) -> float | None:  # noqa: ARG002 - nothing was taken over
        return None

    @property
    def _in_lines(self) -> bool:
        """Whether what is to be seen is written as lines."""
        return self._live is None and not self._silent

    @abstractmethod
    def _draw(self) -> RenderableType: ...

    def _picture(self) -> RenderableType:
        return Group(self._draw(), *map(Text, list(self._notes)))

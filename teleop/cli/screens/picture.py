"""The terminal while something moves: rows drawn again and again on a screen of their own, by a thread of their own.

A drawing fits whatever size the terminal has at that moment: a row that is too long is cut and never wrapped, and of
too many rows the least important go. The key line stays at the bottom. Nothing that goes wrong in a drawing reaches
the motion or the terminal: one that cannot be made is a line that says so, and a terminal that is slow, stopped or
gone holds up this thread and no other.
"""

from __future__ import annotations

import threading
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from types import TracebackType
from typing import Protocol, Self

from rich.console import Console
from rich.control import Control
from rich.live import Live
from rich.text import Text

from teleop.core.plain import plain

REDRAWS = 10  # a second
DRAW_TIMEOUT = 2.0  # s at the end for a terminal that takes nothing
ASCII = str.maketrans("─━●○│█", "-=*o|#")


@dataclass(frozen=True)
class Rows:
    """What there is to draw. Where there is no room the `notes` go first, from their end, then the `state`, the title,
    and the heading of the `axes`; what stops everything, the `banner`, and the keys at the `bottom` stay longest.
    """

    title: Text
    banner: Text = field(default_factory=Text)
    axes: Sequence[Text] = ()
    state: Sequence[Text] = ()
    notes: Sequence[Text] = ()
    bottom: Sequence[Text] = ()

    def fitted(self, width: int, height: int) -> list[Text]:
        """Exactly `height` rows, none longer than `width` cells, the last of them those of `bottom`."""
        bottom = list(self.bottom)[-height:] if self.bottom else []
        banner = [self.banner] if self.banner.plain.strip() else []
        room = height - len(bottom)
        banner = banner[:room]
        room -= len(banner)
        axes = list(self.axes) if room >= len(self.axes) else list(self.axes)[1:][:room]
        room -= len(axes)
        title = [self.title][:room]
        room -= len(title)
        if not banner and room > len(self.state):
            banner = [Text()]  # its place, so that nothing jumps when there is one
            room -= 1
        written = [row for row in self.state if row.plain.strip()]
        state = list(self.state) if room >= len(self.state) else written[:room]
        notes = list(self.notes)[: room - len(state)]
        blank = [Text() for _ in range(room - len(state) - len(notes))]
        rows = [_without_control(row) for row in (*title, *banner, *axes, *state, *notes, *blank, *bottom)]
        for row in rows:
            row.truncate(width)
        return rows


Draw = Callable[[int, int], Rows]
"""The rows for a terminal of so many columns and rows."""


class Sheet(Protocol):
    """What may lie over a drawing."""

    def over(self, rows: Rows, width: int, height: int) -> Rows: ...


@dataclass
class Picture:
    """`draw` on the terminal while it is entered, under the `sheet`.

    `possible` is False where there is none that a cursor moves on.
    """

    draw: Draw
    console: Console = field(default_factory=lambda: Console(stderr=True, highlight=False))
    sheet: Sheet | None = None

    def __post_init__(self) -> None:
        self._over = threading.Event()
        self._thread = threading.Thread(target=self._run, name="view", daemon=True)

    @property
    def possible(self) -> bool:
        return self.console.is_terminal and not self.console.is_dumb_terminal

    def __enter__(self) -> Self:
        self._thread.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._over.set()
        self._thread.join(DRAW_TIMEOUT)

    def text(self) -> Text:
        """The whole screen as it is now; never raises."""
        width, height = max(1, self.console.width), max(1, self.console.height)
        try:
            rows = self.draw(width, height)
            rows = (rows if self.sheet is None else self.sheet.over(rows, width, height)).fitted(width, height)
        except Exception as error:  # noqa: BLE001 - a broken picture is no reason to stop anything
            rows = Rows(Text(f"cannot draw the view ({type(error).__name__}: {error}); the run continues", "red"))
            rows = rows.fitted(width, height)
        if not self.console.encoding.lower().startswith("utf"):
            rows = [_in_ascii(row) for row in rows]
        return Text("\n").join(rows)

    def _refresh(self, live: Live) -> None:
        """Draw, and leave the cursor where what is typed and echoed meanwhile cannot scroll the screen."""
        live.update(self.text(), refresh=True)
        self.console.control(Control.home())

    def _run(self) -> None:
        try:
            with Live(console=self.console, auto_refresh=False, screen=True, transient=True) as live:
                self._refresh(live)
                while not self._over.wait(1 / REDRAWS):
                    self._refresh(live)
                self.console.control(Control.clear(), Control.home())  # for a terminal that has no second screen
        except (OSError, ValueError):
            return  # the terminal is gone, or its stream is closed


def _without_control(row: Text) -> Text:
    """A copy; one with a name that would act on the terminal loses its colors, not its meaning."""
    safe = plain(row.plain)
    return row.copy() if safe == row.plain else Text(safe, row.style)


def _in_ascii(row: Text) -> Text:
    """The same cells without what the terminal's encoding lacks."""
    text = row.plain.translate(ASCII).encode("ascii", "replace").decode("ascii")
    return Text(text, row.style, spans=list(row.spans))

"""What an operator sees while moving a rig by hand: a screen on a terminal, else a line each second.

It is drawn by a thread of its own, ten times a second, from the latest tick and the operator's latest status, both of
which nobody changes any more. A terminal that is slow, stopped or gone costs the picture and never the motion. All of
it goes to stderr; stdout is for the result.
"""

from __future__ import annotations

import math
import threading
from collections.abc import Callable, Mapping, Sequence
from contextlib import ExitStack
from types import TracebackType
from typing import Protocol, Self

from rich.console import Console, RenderableType
from rich.live import Live
from rich.text import Text

from teleop.cli.drone_rows import drone_rows, summary
from teleop.cli.lines import Lines
from teleop.cli.live_rows import Traffic, axis_rows, banner, help_rows, key_rows, said, state_rows, title_row
from teleop.motion import Axis, Limits, Tick
from teleop.sinks.drone_state import DroneState
from teleop.sources.keyboard import Keyboard
from teleop.sources.status import Said, Status

REDRAWS = 10  # a second
LEAST_WIDTH = 60


class Counted(Protocol):
    """A connection, as far as it is shown."""

    @property
    def counts(self) -> Mapping[str, int]: ...


class LiveView:
    """A sink that only shows, and has the terminal while it is entered: its screen, and its keys if there are any.

    `trouble` is asked for what is wrong with the recording of a take, "" for nothing, and `drone` for what is known of
    one, None where there is none.
    """

    def __init__(
        self,
        title: str,
        limits: Mapping[Axis, Limits],
        status: Callable[[], Status],
        connections: Mapping[str, Counted],
        keyboard: Keyboard | None,
        trouble: Callable[[], str] = lambda: "",
        silent: bool = False,
        drone: Callable[[], DroneState | None] = lambda: None,
    ) -> None:
        self._drone = drone
        self._title, self._limits, self._status = title, limits, status
        self._keyboard, self._trouble, self._silent = keyboard, trouble, silent
        self._traffic = {name: Traffic(connection) for name, connection in connections.items()}
        self._tick: Tick | None = None
        self._begin = math.nan
        self._console = Console(stderr=True)
        self._on_screen = self._console.is_terminal and not silent
        self._plain = Plain(title, drone)
        self._stack = ExitStack()
        self._over = threading.Event()
        self._word = ""  # what was said last

    def __enter__(self) -> Self:
        with ExitStack() as stack:
            if self._keyboard:
                stack.enter_context(self._keyboard)
            if self._on_screen:
                drawer = threading.Thread(target=self._redraw, name="view", daemon=True)
                drawer.start()
                stack.callback(drawer.join)
                stack.callback(self._over.set)
            elif not self._silent:
                self._plain.lines.say(self._title)
            self._stack = stack.pop_all()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._stack.close()
        self._plain.lines.finish()

    def write(self, tick: Tick) -> None:
        if self._tick is None:
            self._begin = tick.time
        self._tick = tick
        if not self._on_screen and not self._silent:
            self._plain.show(tick, tick.time - self._begin, self._status())

    def say(self, text: str) -> None:
        """Show a line above the messages, on a screen; safe to call from any thread."""
        self._word = text

    def release(self, now: float) -> float | None:  # noqa: ARG002 - nothing was taken over
        return None

    def _redraw(self) -> None:
        try:
            with Live(console=self._console, auto_refresh=False, screen=True, transient=True) as live:
                while not self._over.wait(1 / REDRAWS):
                    live.update(self._screen(), refresh=True)
        except OSError:
            return  # the terminal is gone: nobody is left to draw for

    def _screen(self) -> RenderableType:
        width, height = max(self._console.width, LEAST_WIDTH), self._console.height
        status, tick, keyboard = self._status(), self._tick, self._keyboard
        now = tick.time if tick else 0.0
        elapsed = now - self._begin if tick else 0.0
        top = [title_row(self._title, elapsed, status, self._trouble(), width), banner(status, now, width)]
        if tick is None:
            top.append(Text(" waiting for the first report of every axis", "yellow"))
        else:
            top += axis_rows(tick, self._limits, status, width)
        links = [traffic.row(name, now) for name, traffic in self._traffic.items()]
        drone = self._drone()
        flying = [] if drone is None else drone_rows(drone)
        middle = [Text(), *flying, *state_rows(status, links), Text()]
        question = keyboard.question if keyboard else ""
        helping = keyboard is not None and keyboard.helping
        word = [Text(f" {self._word}", "yellow")] if self._word else []
        messages = help_rows() if helping else word + [said(message, now) for message in status.messages]
        bottom = [] if helping and not question else key_rows(question, keyboard is not None)
        if helping and height < len(top) + len(middle) + len(messages) + len(bottom):
            middle = [Text()]  # a help that lacks a key is none, and it is open for a moment only
        room = max(1, height - len(top) - len(middle) - len(bottom))
        messages = (messages + [Text()] * room)[:room]
        rows = [*top, *middle, *messages, *bottom]
        for row in rows:
            row.truncate(width)
        return Text("\n").join(rows)


class Plain:
    """A line each second where there is no screen, and each message as it comes."""

    def __init__(self, title: str, drone: Callable[[], DroneState | None]) -> None:
        self.lines = Lines()
        self._title, self._drone = title, drone
        self._next = -math.inf
        self._last: Said | None = None

    def show(self, tick: Tick, elapsed: float, status: Status) -> None:
        for message in reversed(self._new(status.messages)):
            self.lines.say(f"{elapsed:6.1f} s  {message.text}")
        if tick.time >= self._next:
            self._next = tick.time + 1
            angles = (f"{axis} {round(state.position, 3) + 0.0:+.3f}" for axis, state in tick.motion.items())
            drone = self._drone()
            flying = "" if drone is None else f"  {summary(drone)}"
            self.lines.say(f"{elapsed:6.1f} s  {'  '.join(angles)}{flying}{'  E-STOP' * status.stopped}")

    def _new(self, messages: Sequence[Said]) -> Sequence[Said]:
        until = messages.index(self._last) if self._last in messages else len(messages)
        self._last = messages[0] if messages else self._last
        return messages[:until]

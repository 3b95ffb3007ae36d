"""What an operator sees while moving a rig by hand: a screen on a terminal, else a line each second.

It is drawn by a thread of its own, ten times a second, from the latest tick and the operator's latest status, both of
which no longer changes. A terminal that is slow, stopped or gone costs the picture and never the motion. All of
it goes to stderr; stdout is for the result.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from contextlib import ExitStack
from types import TracebackType
from typing import Protocol, Self

from rich.text import Text

from teleop.cli.screens.axis_table import axis_rows
from teleop.cli.screens.drone_rows import drone_rows, summary
from teleop.cli.screens.live_rows import Traffic, banner, help_rows, key_rows, message_row, state_rows, title_row
from teleop.cli.screens.picture import Picture, Rows, Sheet
from teleop.cli.screens.stderr_writer import StderrWriter
from teleop.core.axes import Axis, Limits
from teleop.core.events import Tick
from teleop.core.run_status import stop_state
from teleop.devices.drone.state import DroneState
from teleop.inputs.keyboard import Keyboard
from teleop.manual.status import Message, OperatorStatus

LOW = 14  # rows of a terminal from which on the keys have two of them
STOP_WORDS = {"": "", "stopping": "  stopping", "stopped": "  STOPPED"}


class Counted(Protocol):
    """A connection, as far as it is shown."""

    @property
    def counts(self) -> Mapping[str, int]: ...


class LiveView:
    """A sink that only shows, and has the terminal while it is entered: its screen, and its keys if there are any.

    `take` is asked for a few words about the take that is written, "" for none, and `drone` for what is known of one,
    None where there is none.
    """

    def __init__(
        self,
        title: str,
        limits: Mapping[Axis, Limits],
        status: Callable[[], OperatorStatus],
        connections: Mapping[str, Counted],
        keyboard: Keyboard | None,
        take: Callable[[], str] = lambda: "",
        silent: bool = False,
        drone: Callable[[], DroneState | None] = lambda: None,
        sheet: Sheet | None = None,
    ) -> None:
        self._drone = drone
        self._title, self._limits, self._status = title, limits, status
        self._keyboard, self._take, self._silent = keyboard, take, silent
        self._traffic = {name: Traffic(connection) for name, connection in connections.items()}
        self._tick: Tick | None = None
        self._begin = math.nan
        self._picture = Picture(self._draw, sheet=sheet)
        self._on_screen = self._picture.possible and not silent
        self._plain = Plain(title, drone)
        self._stack = ExitStack()
        self._word = ""  # what was reported last, outside the operator's messages

    def __enter__(self) -> Self:
        with ExitStack() as stack:
            if self._keyboard:
                stack.enter_context(self._keyboard)
            if self._on_screen:
                stack.enter_context(self._picture)
            elif not self._silent:
                self._plain.lines.notify(self._title)
            self._stack = stack.pop_all()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._stack.close()
        self._plain.lines.finish()

    def observe(self, tick: Tick) -> None:
        if self._tick is None:
            self._begin = tick.time
        self._tick = tick
        if not self._on_screen and not self._silent:
            self._plain.show(tick, tick.time - self._begin, self._status())

    def notify(self, text: str) -> None:
        """Show a line above the messages, on a screen; safe to call from any thread."""
        self._word = text

    def _draw(self, width: int, height: int) -> Rows:
        status, tick, keyboard = self._status(), self._tick, self._keyboard
        now = tick.time if tick else 0.0
        elapsed = now - self._begin if tick else 0.0
        question = keyboard.question if keyboard else ""
        helping = keyboard is not None and keyboard.helping
        if tick is None:
            axes = [Text(" waiting for the first report of every axis", "yellow")]
        else:
            axes = axis_rows(tick, self._limits, width, status.deflections)
        word = [Text(f" {self._word}", "yellow")] if self._word else []
        messages = word + [message_row(message, now) for message in status.messages]
        return Rows(
            title=title_row(self._title, elapsed, status, self._take(), width),
            banner=banner(status, tick.motion if tick else {}, now, width),
            axes=axes,
            state=[Text(), *help_rows()] if helping else [Text(), *self._state(status, now), Text()],
            notes=[] if helping else messages,
            bottom=key_rows(question, keyboard is not None, width, 2 if height >= LOW else 1),
        )

    def _state(self, status: OperatorStatus, now: float) -> list[Text]:
        """Speed, inputs, links; first what a drone does."""
        drone = self._drone()
        flying = [] if drone is None else drone_rows(drone)
        return [*flying, *state_rows(status, [traffic.row(name, now) for name, traffic in self._traffic.items()])]


class Plain:
    """A line each second where there is no screen, and each message as it comes."""

    def __init__(self, title: str, drone: Callable[[], DroneState | None]) -> None:
        self.lines = StderrWriter()
        self._title, self._drone = title, drone
        self._next = -math.inf
        self._last: Message | None = None

    def show(self, tick: Tick, elapsed: float, status: OperatorStatus) -> None:
        for message in reversed(new_messages(status.messages, self._last)):
            self.lines.notify(f"{elapsed:6.1f} s  {message.text}")
        self._last = status.messages[0] if status.messages else self._last
        if tick.time >= self._next:
            self._next = tick.time + 1
            angles = (f"{axis} {round(state.position, 3) + 0.0:+.3f}" for axis, state in tick.motion.items())
            drone = self._drone()
            flying = "" if drone is None else f"  {summary(drone)}"
            stop = STOP_WORDS[stop_state(status.stopped, tick.motion)]
            self.lines.notify(f"{elapsed:6.1f} s  {'  '.join(angles)}{flying}{stop}")


def new_messages(messages: Sequence[Message], last: Message | None) -> Sequence[Message]:
    """Those that came after `last`, newest first. One that comes again takes the place of the one before."""
    if last is None:
        return messages
    if last in messages:
        return messages[: messages.index(last)]
    return [message for message in messages if message.time > last.time]

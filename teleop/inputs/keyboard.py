"""The terminal's keys as an input: read by a thread of their own, handed over when the control thread asks.

The terminal is set to hand over each key as it is pressed, and is put back whatever happens. Ctrl-Z and Ctrl-S mean
nothing meanwhile: one would freeze the program in mid pan, the other the view and with it the way out. A terminal that
closes takes its operator away, so the run ends: the keyboard also looks on as a sink, which says so.
"""

from __future__ import annotations

import os
import select
import sys
import threading
from collections import deque
from collections.abc import Iterator
from types import TracebackType
from typing import Protocol, Self

from teleop.core.axes import Axis
from teleop.core.errors import LinkError
from teleop.core.events import Tick
from teleop.core.operator_input import Held, Press
from teleop.inputs.keymaps import Act, KeyReader

ESCAPE_TIME = 0.05  # s within which the rest of an escape sequence comes, over a slow line too
READ_TIMEOUT = 1.0  # s at the end for a read that another program on the terminal has left without its key
CLOSED = "the terminal was closed"


def terminal() -> int | None:
    """The descriptor of the terminal that this was started on, if there is one to read keys from."""
    if sys.stdin is None or sys.stdin.closed or not sys.stdin.isatty() or not is_ours(sys.stdin.fileno()):
        return None
    return sys.stdin.fileno()


def is_ours(descriptor: int) -> bool:
    """Whether it is a terminal that this program may read: in the background, that would suspend it."""
    try:
        return has_keys() and os.isatty(descriptor) and os.tcgetpgrp(descriptor) == os.getpgrp()
    except OSError:
        return False


def has_keys() -> bool:
    """Whether this system hands over single keys of a terminal: Windows does it otherwise."""
    try:
        import termios  # noqa: F401
    except ImportError:
        return False
    return hasattr(os, "tcgetpgrp")


class KeyInput(Protocol):
    """From what a terminal sends to what is asked for; `KeyReader` says what its parts mean."""

    question: str
    helping: bool
    inviting: bool

    @property
    def is_waiting(self) -> bool: ...

    def settle(self) -> None: ...

    def feed(self, text: str) -> Iterator[Act]: ...


class Keyboard:
    """The terminal open at a descriptor; keys count from when it is entered until it is left.

    `reader` says what they ask for; without one, what an operator's do.
    """

    name = "keys"

    def __init__(self, descriptor: int, reader: KeyInput | None = None) -> None:
        self._descriptor = descriptor
        self._reader: KeyInput = reader or KeyReader()
        self._asked: deque[Act] = deque()
        self._closed = ""
        self._wake: tuple[int, int] = (-1, -1)
        self._before: list | None = None
        self._thread: threading.Thread | None = None

    @property
    def question(self) -> str:
        """What the operator has to answer with a second key, "" for nothing."""
        return self._reader.question

    @property
    def helping(self) -> bool:
        return self._reader.helping

    @property
    def inviting(self) -> bool:
        """Whether the operator wants to see how others open the console."""
        return self._reader.inviting

    def __enter__(self) -> Self:
        import termios

        self._before = termios.tcgetattr(self._descriptor)
        changed = termios.tcgetattr(self._descriptor)
        changed[0] &= ~termios.IXON
        changed[3] &= ~(termios.ICANON | termios.ECHO)
        changed[6][termios.VMIN], changed[6][termios.VTIME] = 1, 0
        changed[6][termios.VSUSP] = os.fpathconf(self._descriptor, "PC_VDISABLE").to_bytes(1, "little")
        termios.tcsetattr(self._descriptor, termios.TCSADRAIN, changed)
        self._wake = os.pipe()
        self._thread = threading.Thread(target=self._run, name="keys", daemon=True)
        self._thread.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        import termios

        os.write(self._wake[1], b".")
        if self._thread:
            self._thread.join(READ_TIMEOUT)
        if not (
            self._thread and self._thread.is_alive()
        ):  # one that hangs in a read would read what comes to be open there
            for descriptor in self._wake:
                os.close(descriptor)
        try:
            termios.tcsetattr(self._descriptor, termios.TCSAFLUSH, self._before or [])
        except termios.error:
            self._closed = CLOSED  # and there is nothing to put back

    def read(self, now: float) -> Held:  # noqa: ARG002 - keys are pressed, not held
        presses: list[Press] = []
        steps: dict[Axis, float] = {}
        click: dict[Axis, float] = {}
        while self._asked:
            asked = self._asked.popleft()
            if isinstance(asked, Press):
                presses.append(asked)
            else:
                steps[asked.axis] = steps.get(asked.axis, 0.0) + asked.units
                click[asked.axis] = max(click.get(asked.axis, 0.0), abs(asked.units))
        return Held(steps=steps, presses=presses, trouble=self._closed, click=click)

    def observe(self, tick: Tick) -> None:  # noqa: ARG002 - only whether anybody is left to see it
        """Raises LinkError when the terminal has closed."""
        if self._closed:
            raise LinkError(self._closed)

    def _run(self) -> None:
        while True:
            ready, _, _ = select.select(
                [self._descriptor, self._wake[0]], [], [], ESCAPE_TIME if self._reader.is_waiting else None
            )
            if self._wake[0] in ready:
                return
            if not ready:
                self._reader.settle()
                continue
            try:
                data = os.read(self._descriptor, 1024)
            except OSError:
                data = b""
            if not data:
                self._closed = CLOSED
                return
            self._asked.extend(self._reader.feed(data.decode("latin-1")))

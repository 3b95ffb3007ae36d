"""A real terminal of a given size with a command in it, and what its user sees: pyte is the terminal.

`look` says what is wrong with a screen that any user would call broken: a traceback, a row that was wrapped.
"""

from __future__ import annotations

import fcntl
import os
import select
import shutil
import signal
import struct
import subprocess
import termios
import threading
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager
from pathlib import Path

import pyte
from command import TELEOP

PATIENCE = 40.0  # s: far beyond anything here, on a machine that does much else
SIZES = [(80, 24), (120, 40)]
HOME = b"\x1b[H"  # with which each picture of a view begins
BROKEN = ("Traceback (most recent call last)", "AttributeError", "UnicodeEncodeError", "cannot draw the view")


class Wrapping(pyte.HistoryScreen):
    """A screen that remembers what was wrapped: drawn on beyond its right edge."""

    def __init__(self, columns: int, lines: int) -> None:
        self.wrapped: list[str] = []
        super().__init__(columns, lines, history=2000, ratio=0.5)

    def draw(self, data: str) -> None:
        for char in data:
            if self.cursor.x == self.columns:
                self.wrapped.append("".join(self.buffer[self.cursor.y][x].data for x in range(self.columns)))
            super().draw(char)

    @property
    def past(self) -> list[str]:
        """The rows that have left it at the top, oldest first."""
        return ["".join(row[x].data for x in range(self.columns)).rstrip() for row in self.history.top]


class TerminalScreen:
    """`command` is run on the terminal, stdin, stdout and stderr of it, as a shell does."""

    def __init__(
        self,
        command: Sequence[str],
        folder: Path,
        size: tuple[int, int] = (80, 24),
        environment: Mapping[str, str | None] | None = None,
        cwd: Path | None = None,
    ) -> None:
        self.columns, self.lines = size
        self._master, slave = os.openpty()
        self._resize(self._master)
        self.screen = Wrapping(*size)
        self._stream = pyte.ByteStream(self.screen)
        self._lock, self._over = threading.Lock(), threading.Event()
        self._whole: list[str] = []
        self.raw = b""
        changed = {"TERM": "xterm-256color", "XDG_STATE_HOME": str(folder), "COLUMNS": None, "LINES": None}
        asked = {**os.environ, **changed, **(environment or {})}
        self.process = subprocess.Popen(
            command,
            stdin=slave,
            stdout=slave,
            stderr=slave,
            start_new_session=True,
            preexec_fn=lambda: fcntl.ioctl(0, termios.TIOCSCTTY, 0),
            env={name: value for name, value in asked.items() if value is not None},
            cwd=cwd,
        )
        self._slave = slave
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()

    @property
    def rows(self) -> list[str]:
        """What is on the screen, a string a row without the blanks at its end."""
        with self._lock:
            return [row.rstrip() for row in self.screen.display]

    @property
    def everything(self) -> list[str]:
        """What is on the screen and what has left it at the top."""
        with self._lock:
            return [*self.screen.past, *(row.rstrip() for row in self.screen.display)]

    @property
    def text(self) -> str:
        return "\n".join(self.rows)

    def wait_until(self, holds: Callable[[list[str]], object], what: str) -> list[str]:
        """The rows of the first whole screen for which it holds: a picture comes in pieces."""
        deadline = time.monotonic() + PATIENCE
        while not holds(rows := self._whole):
            assert time.monotonic() < deadline, f"{what} never held:\n" + "\n".join(self.everything)
            time.sleep(0.01)
        return rows

    def wait_for(self, text: str) -> list[str]:
        return self.wait_until(lambda rows: any(text in row for row in rows), f"{text!r} on the screen")

    def wait_for_keys(self) -> None:
        """Until the program reads single keys."""
        self.wait_until(lambda _rows: not termios.tcgetattr(self._slave)[3] & termios.ICANON, "single keys")

    def type(self, keys: str) -> None:
        os.write(self._master, keys.encode("latin-1"))

    def resize(self, columns: int, lines: int) -> None:
        """The window gets another size: the program is told, and what is wrapped from then on counts."""
        self.columns, self.lines = columns, lines
        with self._lock:
            self.screen.resize(lines, columns)
            self.screen.erase_in_display(2)  # a terminal reflows, which pyte does not
            self.screen.wrapped.clear()
        self._resize(self._master)
        os.killpg(self.process.pid, signal.SIGWINCH)

    def end(self) -> int:
        """Wait until the program has ended and all that it wrote is on the screen: its exit code."""
        code = self.process.wait(timeout=2 * PATIENCE)
        self._over.set()
        self._reader.join()
        return code

    def look(self, rows: Sequence[str] | None = None, key_line: str = "") -> None:
        """Fails on what nobody may see; with a `key_line` that has to be in the last row."""
        shown = "\n".join(self.everything if rows is None else rows)
        assert not [word for word in BROKEN if word in shown], shown
        assert not self.screen.wrapped, f"wrapped: {self.screen.wrapped}\n{shown}"
        if key_line:
            last = (self.rows if rows is None else rows)[-1]
            assert key_line in last, f"no {key_line!r} in the last row:\n{shown}"

    def close(self) -> None:
        if self.process.poll() is None:
            self.process.kill()
            self.process.wait()
        self._over.set()
        self._reader.join()
        for descriptor in (self._master, self._slave):
            os.close(descriptor)

    def _resize(self, descriptor: int) -> None:
        fcntl.ioctl(descriptor, termios.TIOCSWINSZ, struct.pack("HHHH", self.lines, self.columns, 0, 0))

    def _take(self, data: bytes) -> None:
        """What is on the screen where the next picture begins was a whole one, also while this comes far behind."""
        first, *others = data.split(HOME)
        with self._lock:
            self.raw += data
            self._stream.feed(first)
        for picture in others:
            self._whole = self.rows
            with self._lock:
                self._stream.feed(HOME + picture)

    def _read(self) -> None:
        changed = True
        while True:
            ended = self._over.is_set()  # before the look, so that nothing written until then is missed
            if select.select([self._master], [], [], 0 if ended else 0.005)[0]:
                self._take(os.read(self._master, 65536))
                changed = True
                continue
            if changed:
                self._whole, changed = self.rows, False
            if ended:
                return


@contextmanager
def screen(
    *arguments: str,
    folder: Path,
    size: tuple[int, int] = (80, 24),
    environment: Mapping[str, str | None] | None = None,
    cwd: Path | None = None,
    program: str = TELEOP,
) -> Iterator[TerminalScreen]:
    """`teleop ARGUMENTS` on a terminal of (columns, rows)."""
    opened = TerminalScreen([program, *arguments], folder, size, environment, cwd)
    try:
        yield opened
    finally:
        opened.close()


@contextmanager
def screens(*arguments: str, folder: Path) -> Iterator[list[TerminalScreen]]:
    """`teleop ARGUMENTS` at once on a terminal of each size, each in a copy of `folder`: what they wait for is time."""
    with ExitStack() as stack:
        opened = []
        for size in SIZES:
            own = folder.with_name(f"{folder.name}-{size[0]}x{size[1]}")
            shutil.copytree(folder, own)
            opened.append(stack.enter_context(screen(*arguments, folder=own, size=size, cwd=own)))
        yield opened

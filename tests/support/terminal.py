"""A terminal with a program in it, as a person has one: keys go in, a screen comes out, and it can be closed."""

from __future__ import annotations

import fcntl
import os
import re
import select
import struct
import subprocess
import termios
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from command import TELEOP
from waiting import DEADLINE, wait_until

END = "\x1b]end of the test\a"  # what no program here writes
_CONTROL = re.compile(r"\x1b\[[0-9;?]*[@-~]")


class Terminal:
    """`process` has it as its controlling terminal; its stdout is a pipe, as when the result goes into a file."""

    def __init__(self, *arguments: str, folder: Path, rows: int = 24, columns: int = 80) -> None:
        self.master, self.slave = os.openpty()
        fcntl.ioctl(self.slave, termios.TIOCSWINSZ, struct.pack("HHHH", rows, columns, 0, 0))
        self.before = termios.tcgetattr(self.slave)
        self.raw = ""
        self._over = threading.Event()
        self.process = subprocess.Popen(
            [TELEOP, *arguments],
            stdin=self.slave,
            stdout=subprocess.PIPE,
            stderr=self.slave,
            text=True,
            start_new_session=True,
            preexec_fn=lambda: fcntl.ioctl(0, termios.TIOCSCTTY, 0),
            env={**os.environ, "TERM": "xterm-256color", "XDG_STATE_HOME": str(folder)},
        )
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()

    @property
    def shown(self) -> str:
        """All that has been on the screen, without colours and movements of the cursor."""
        return _CONTROL.sub("", self.raw)

    def type(self, keys: str) -> None:
        os.write(self.master, keys.encode("latin-1"))

    def wait_for(self, text: str) -> None:
        """Until it has been shown, since the last key that was waited for."""
        wait_until(lambda: text in self.shown or self.process.poll() is not None, f"{text!r} on the terminal")
        if text not in self.shown:  # it has ended
            wait_until(lambda: text in self.shown, f"{text!r} in {self.shown!r}", patience=1.0)

    def wait_for_keys(self) -> None:
        """Until the program reads single keys."""
        wait_until(lambda: not termios.tcgetattr(self.slave)[3] & termios.ICANON, "single keys")

    def end(self) -> tuple[int, str]:
        """Wait until the program has ended and all that it has shown is on the screen: its exit code and its stdout."""
        out, _ = self.process.communicate(timeout=DEADLINE)
        if self.slave >= 0:  # unless the window was closed
            os.write(self.slave, END.encode())  # behind all that the program wrote: once it is here, so is that
            wait_until(lambda: END in self.raw, "the end of what was shown")
            self.raw = self.raw.replace(END, "")
        return self.process.returncode, out

    @property
    def restored(self) -> bool:
        return termios.tcgetattr(self.slave) == self.before

    def hang_up(self) -> None:
        """The window is closed."""
        self._stop_reading()
        os.close(self.slave)
        os.close(self.master)
        self.master = self.slave = -1

    def close(self) -> None:
        self.process.kill()
        self.process.communicate()
        self._stop_reading()
        for descriptor in {self.master, self.slave} - {-1}:
            os.close(descriptor)

    def _stop_reading(self) -> None:
        """Before anything is closed: while a thread reads it, a terminal stays open."""
        self._over.set()
        self._reader.join()

    def _read(self) -> None:
        while not self._over.is_set():
            if select.select([self.master], [], [], 0.02)[0]:
                self.raw += os.read(self.master, 65536).decode("utf-8", "replace")


@contextmanager
def terminal(*arguments: str, folder: Path) -> Iterator[Terminal]:
    opened = Terminal(*arguments, folder=folder)
    try:
        yield opened
    finally:
        opened.close()

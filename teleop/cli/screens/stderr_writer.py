"""Lines on stderr while something moves, written by the control thread, which must not wait for who reads them.

A pipe that nobody empties (`teleop play FILE 2>&1 | less`) would hold up the loop in the middle of a move, and no
signal would end it. So a line is written only where there is room for it; the others come once there is, or at the end.
"""

from __future__ import annotations

import select
import sys
import threading
from collections import deque

from teleop.cli.screens.folded import spelled

MOST = 1000  # lines that wait; beyond that the oldest are left out
LONGEST = 4096  # bytes for which a pipe that takes anything has room: PIPE_BUF


class StderrWriter:
    def __init__(self) -> None:
        self._waiting: deque[str] = deque(maxlen=MOST)
        self._writing = threading.Lock()  # a signal's hint comes from a thread of its own

    def notify(self, text: str) -> None:
        self._waiting.append(text[: LONGEST // 4 - 1])  # a character has four bytes at most, and the line its end
        with self._writing:
            while self._waiting and _has_room():
                print(spelled(self._waiting.popleft()), file=sys.stderr)

    def finish(self) -> None:
        """Write what still waits, and wait for it; to be called when nothing moves any more."""
        while self._waiting:
            print(spelled(self._waiting.popleft()), file=sys.stderr)


def _has_room() -> bool:
    try:
        return bool(select.select([], [sys.stderr], [], 0)[1])
    except (OSError, ValueError):  # nothing that can be asked: a test's stderr, or a pipe on Windows
        return True

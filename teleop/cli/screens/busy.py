"""A sign of life on a terminal, for work that is usually over before one is needed."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial
from threading import Event
from typing import TextIO

from teleop.cli.meanwhile import meanwhile
from teleop.core.plain import plain

PATIENCE = 0.5  # s without a word, and between two
ERASE = "\r\x1b[K"


@contextmanager
def busy(what: str, stream: TextIO | None = None, patience: float = PATIENCE) -> Iterator[None]:
    """Say `what` is being done and for how long already, in one line of stderr that is gone afterwards.

    Nothing is written into a pipe or a file, nor on a terminal that cannot erase a line.
    """
    stream = stream or sys.stderr
    if stream is None or stream.closed or not stream.isatty() or os.environ.get("TERM", "dumb") == "dumb":
        yield
        return
    with meanwhile(partial(_tell, what, stream, patience), "busy"):
        yield


def _tell(what: str, stream: TextIO, patience: float, over: Event) -> None:
    periods = 0
    while not over.wait(patience):
        periods += 1
        print(f"{ERASE}{plain(what)}: {periods * patience:.0f} s", end="", file=stream, flush=True)
    if periods:
        print(ERASE, end="", file=stream, flush=True)

"""Lines for people that fit their terminal: folded between words there, and left as they are for a pipe or a file."""

from __future__ import annotations

import shutil
import sys
import textwrap
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TextIO

from teleop.core.plain import plain

INDENT = "  "  # of what is left of a line in the next one
NARROWEST = 20  # cells


def spelled(text: str) -> str:
    """Lines in which a name from a file cannot act on the terminal."""
    return "\n".join(map(plain, text.split("\n")))


def folded(text: str, stream: TextIO) -> str:
    """`text` in as many lines as it takes on the terminal that `stream` is; what would act on a terminal is spelled."""
    text = spelled(text)
    try:
        if not stream.isatty():
            return text
    except ValueError:  # closed
        return text
    width = max(NARROWEST, shutil.get_terminal_size().columns)
    return "\n".join(
        textwrap.fill(line, width, subsequent_indent=INDENT, break_long_words=False, break_on_hyphens=False)
        if len(line) > width
        else line
        for line in text.split("\n")
    )


def tell(text: str) -> None:
    """A line of the result, on stdout."""
    print(folded(text, sys.stdout))


def warn(text: str) -> None:
    """A warning on stderr."""
    complain(f"teleop: warning: {text}")


@contextmanager
def after_the_run() -> Iterator[Callable[[str], object]]:
    """Takes lines while a view is on the terminal, and prints them on stderr when the block is left."""
    lines: list[str] = []
    try:
        yield lines.append
    finally:
        for line in lines:
            complain(line)


def complain(text: str) -> None:
    """A line on stderr."""
    print(folded(text, sys.stderr), file=sys.stderr)

"""Which files of the user's were read, and when each had been saved: for who waits for a change of one of them."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from pathlib import Path

Saved = tuple[int, int]  # when (ns), and how large it was then (bytes)

_read: ContextVar[dict[Path, Saved | None] | None] = ContextVar("files read", default=None)


@contextmanager
def files_read() -> Iterator[dict[Path, Saved | None]]:
    """What is read within, as it was before it was read; None for what was looked for and not there."""
    found: dict[Path, Saved | None] = {}
    before = _read.set(found)
    try:
        yield found
    finally:
        _read.reset(before)


def note(file: Path) -> None:
    """`file` is about to be read."""
    found = _read.get()
    if found is not None:
        found.setdefault(file.resolve(), saved(file))


def saved(file: Path) -> Saved | None:
    try:
        state = file.stat()
    except OSError:
        return None
    return state.st_mtime_ns, state.st_size

"""Work in a thread of its own, for as long as a block is under way."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from threading import Event, Thread


@contextmanager
def meanwhile(work: Callable[[Event], object], name: str) -> Iterator[None]:
    """`work` runs beside the block; it gets an event that is set once the block is left, which waits for its end."""
    over = Event()
    thread = Thread(target=work, args=(over,), name=name, daemon=True)
    thread.start()
    try:
        yield
    finally:
        over.set()
        thread.join()

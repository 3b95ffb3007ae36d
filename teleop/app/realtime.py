"""The control thread as a real-time thread of the system, where that is permitted."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress

PRIORITY = 50  # of 99: above everything that is not real-time, below the kernel's own threads
HOW = "the control thread runs as any other; on Linux, allow it with CAP_SYS_NICE or an rtprio of 50 in limits.conf"


@contextmanager
def realtime(asked: bool, notify: Callable[[str], object]) -> Iterator[None]:
    """The calling thread is scheduled first in, first out (SCHED_FIFO) until the block is left, if it is `asked` for.

    Threads and processes that it starts are ordinary ones. `notify` gets a line where it is not permitted.
    """
    if not asked:
        yield
        return
    if not hasattr(os, "sched_setscheduler") or not hasattr(os, "SCHED_RESET_ON_FORK"):
        notify(f"--realtime: this system has no SCHED_FIFO for it: {HOW}")
        yield
        return
    before = os.sched_getscheduler(0), os.sched_getparam(0)
    try:
        os.sched_setscheduler(0, os.SCHED_FIFO | os.SCHED_RESET_ON_FORK, os.sched_param(PRIORITY))
    except OSError as error:
        notify(f"--realtime: not permitted ({error.strerror}): {HOW}")
        yield
        return
    try:
        yield
    finally:
        with suppress(OSError):
            os.sched_setscheduler(0, *before)

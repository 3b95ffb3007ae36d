"""The control thread as a real-time thread of the system, where that is permitted, and the others of its process too.

Only one thread of a process runs Python at a time. An ordinary thread that another program's work interrupts in the
middle of some Python keeps the control thread from running, however high its priority is: measured beside 30 busy
processes, 5 ms of such work took 470 ms, and the start of a child 80 ms. So every other thread is a real-time one too,
below the control thread: then nothing that is not real-time interrupts it, and the same took 3 ms.
"""

from __future__ import annotations

import os
import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from typing import Any

PRIORITY = 50  # of 99: above everything that is not real-time, below the kernel's own threads
OTHERS = 1  # of the other threads, which take turns (SCHED_RR)
HOW = "the control thread runs as any other; on Linux, allow it with CAP_SYS_NICE or an rtprio of 50 in limits.conf"


@contextmanager
def realtime(asked: bool, notify: Callable[[str], object]) -> Iterator[None]:
    """The calling thread is scheduled first in, first out (SCHED_FIFO) until the block is left, if it is `asked` for.

    The other threads of this process, those that start meanwhile too, are real-time ones of the lowest priority.
    Processes that it starts are ordinary ones. `notify` gets a line where it is not permitted.
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
        with _others():
            yield
    finally:
        with suppress(OSError):
            os.sched_setscheduler(0, *before)


@contextmanager
def _others() -> Iterator[None]:
    """The other threads are real-time ones as well, those that are there and those that start."""
    before = threading.getprofile()
    found = [number for number in _threads() if _schedule(number, os.SCHED_OTHER, os.SCHED_RR, OTHERS)]
    threading.setprofile(_begun)  # type: ignore[arg-type] - the only hook that Python has for the start of a thread
    try:
        yield
    finally:
        threading.setprofile(before)  # type: ignore[arg-type] - None too
        for number in {*found, *_threads()}:
            _schedule(number, os.SCHED_RR, os.SCHED_OTHER, 0)


def _begun(*_: Any) -> None:
    """Called once, in each thread that starts."""
    sys.setprofile(None)
    _schedule(0, os.SCHED_OTHER, os.SCHED_RR, OTHERS)


def _threads() -> list[int]:
    """Those of this process, but for the calling one."""
    return [each.native_id for each in threading.enumerate() if each.native_id not in (None, threading.get_native_id())]


def _schedule(number: int, before: int, after: int, priority: int) -> bool:
    """Whether that thread, which has to be scheduled as `before`, is so as `after` from now on."""
    with suppress(OSError):  # it has ended
        if os.sched_getscheduler(number) & ~os.SCHED_RESET_ON_FORK == before:
            reset = os.SCHED_RESET_ON_FORK if after != os.SCHED_OTHER else 0
            os.sched_setscheduler(number, after | reset, os.sched_param(priority))
            return True
    return False

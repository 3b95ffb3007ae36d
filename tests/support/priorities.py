"""Which of a test's processes come first on a busy machine."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path

BEHIND = 5  # nice


def children_in_real_time() -> None:
    """All threads of this process's children take turns before everything that is not real-time."""
    for process in _children("self"):
        for thread in _threads(process):
            with suppress(OSError):  # not permitted, or ended
                os.sched_setscheduler(thread, os.SCHED_RR, os.sched_param(1))


def browser_gives_way() -> None:
    """A browser is many busy processes: the runs in real time of the tests beside it come first."""
    below = list(_children("self"))
    for process in below:
        with suppress(OSError):
            below += _children(process)
            if "chrom" in Path(f"/proc/{process}/comm").read_text():
                for thread in _threads(process):
                    os.setpriority(os.PRIO_PROCESS, thread, BEHIND)


def _children(process: str) -> Iterator[str]:
    for children in Path(f"/proc/{process}/task").glob("*/children"):
        with suppress(OSError):
            yield from children.read_text().split()


def _threads(process: str) -> Iterator[int]:
    for task in Path(f"/proc/{process}/task").glob("*"):
        yield int(task.name)

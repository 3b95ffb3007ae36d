"""Children of a test that keep up on a busy machine: as real-time processes, where that is permitted."""

from __future__ import annotations

import os
from contextlib import suppress
from pathlib import Path


def children_in_real_time() -> None:
    """All threads of this process's children take turns before everything that is not real-time."""
    for children in Path("/proc/self/task").glob("*/children"):
        for process in children.read_text().split():
            for task in Path(f"/proc/{process}/task").glob("*"):
                with suppress(OSError):  # not permitted, or ended
                    os.sched_setscheduler(int(task.name), os.SCHED_RR, os.sched_param(1))

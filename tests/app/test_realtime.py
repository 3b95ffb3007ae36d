"""`--realtime`: the calling thread, and those beside it, put back afterwards, and a line where it is not permitted."""

from __future__ import annotations

import os
import subprocess
import sys
import threading
import time

import pytest

from teleop.app.realtime import realtime


def scheduler() -> int:
    return os.sched_getscheduler(0) & ~getattr(os, "SCHED_RESET_ON_FORK", 0)


@pytest.mark.skipif(not hasattr(os, "sched_setscheduler"), reason="this system has no SCHED_FIFO")
def test_it_is_scheduled_first_in_first_out_or_says_why_not() -> None:
    lines: list[str] = []
    before = scheduler()
    with realtime(True, lines.append):
        within = scheduler()
        child = subprocess.run([sys.executable, "-S", "-c", CHILD], capture_output=True, check=True)
    assert scheduler() == before
    assert (within == os.SCHED_FIFO) is not bool(lines)
    assert int(child.stdout) == os.SCHED_OTHER


CHILD = "import os; print(os.sched_getscheduler(0))"


@pytest.mark.skipif(not hasattr(os, "sched_setscheduler"), reason="this system has no SCHED_FIFO")
def test_the_other_threads_are_real_time_below_it_as_long_as_it_lasts() -> None:
    """One that was interrupted by another program, in the middle of some Python, would hold the control thread up."""
    lines: list[str] = []
    of_others: list[int] = []
    go, end = threading.Event(), threading.Event()

    def watch() -> None:
        go.wait()
        of_others.append(scheduler())
        end.wait()
        of_others.append(scheduler())

    early = threading.Thread(target=watch)
    early.start()
    with realtime(True, lines.append):
        go.set()
        late = threading.Thread(target=watch)
        late.start()
        while len(of_others) < 2:
            time.sleep(0.001)
    end.set()
    early.join()
    late.join()
    within = os.SCHED_OTHER if lines else os.SCHED_RR
    assert of_others == [within, within, os.SCHED_OTHER, os.SCHED_OTHER]
    assert threading.getprofile() is None


def test_what_is_not_permitted_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    def refused(*_: object) -> None:
        raise PermissionError(1, "Operation not permitted")

    monkeypatch.setattr(os, "sched_setscheduler", refused, raising=False)
    monkeypatch.setattr(os, "SCHED_RESET_ON_FORK", 1 << 30, raising=False)
    lines: list[str] = []
    with realtime(True, lines.append):
        pass
    assert lines[0].startswith("--realtime: not permitted (Operation not permitted): the control thread runs as any")


def test_nothing_changes_unless_it_is_asked_for() -> None:
    lines: list[str] = []
    with realtime(False, lines.append):
        pass
    assert not lines

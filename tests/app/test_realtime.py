"""`--realtime`: the calling thread alone, put back afterwards, and a line where it is not permitted."""

from __future__ import annotations

import os
import threading

import pytest

from teleop.app.realtime import realtime


def scheduler() -> int:
    return os.sched_getscheduler(0) & ~getattr(os, "SCHED_RESET_ON_FORK", 0)


@pytest.mark.skipif(not hasattr(os, "sched_setscheduler"), reason="this system has no SCHED_FIFO")
def test_it_is_scheduled_first_in_first_out_or_says_why_not() -> None:
    lines: list[str] = []
    of_another: list[int] = []
    before = scheduler()
    with realtime(True, lines.append):
        within = scheduler()
        thread = threading.Thread(target=lambda: of_another.append(scheduler()))
        thread.start()
        thread.join()
    assert scheduler() == before
    assert (within == os.SCHED_FIFO) is not bool(lines)
    assert of_another == [before]


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

"""What is said of a machine's timing: the verdict by the lateness at p99, and whether real time may be asked for."""

from __future__ import annotations

import os

import pytest

from teleop.cli.doctor import timing
from teleop.cli.doctor.finding import State


@pytest.mark.parametrize(
    ("late", "state"), [(0.0019, State.OK), (0.0021, State.NOTE), (0.0099, State.NOTE), (0.0101, State.PROBLEM)]
)
def test_the_verdict_is_by_the_lateness_at_p99(late: float, state: State, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(timing, "sleep_late", lambda ticks: [0.0] * (ticks - 5) + [late] * 5)
    (finding,) = timing.lateness()
    assert finding.state is state
    assert (finding.todo == "") == (state is State.OK)


def test_one_late_tick_in_many_spoils_only_the_most(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(timing, "sleep_late", lambda ticks: [0.0] * (ticks - 1) + [0.5])
    (finding,) = timing.lateness()
    assert finding.state is State.OK
    assert "0.00 / 0.00 / 500.00 ms" in finding.found


def test_percentiles_are_of_what_was_measured_in_ms_whatever_the_order():
    late = [number / 1000 for number in reversed(range(100))]
    assert timing.percentiles(late) == pytest.approx((50, 99, 99))
    assert timing.percentiles([0.004]) == pytest.approx((4, 4, 4))


def test_each_tick_is_measured_and_none_is_early():
    late = timing.sleep_late(5)
    assert len(late) == 5
    assert min(late) >= 0


@pytest.mark.skipif(not hasattr(os, "sched_setscheduler"), reason="no SCHED_FIFO on this system")
def test_a_user_who_may_not_ask_for_real_time_is_told_how_to(monkeypatch: pytest.MonkeyPatch):
    def refuse(*_: object) -> None:
        raise PermissionError

    monkeypatch.setattr(os, "sched_setscheduler", refuse)
    monkeypatch.setattr(os, "nice", lambda _by: 5)
    found = list(timing.scheduling())
    assert "SCHED_FIFO not permitted" in found[0].found
    assert "rtprio 50" in found[0].todo
    assert any(each.found.startswith("nice 5") for each in found)

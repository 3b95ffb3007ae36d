"""The automatic tuning: its progress is pushed until it is complete, or stopped."""

from __future__ import annotations

from typing import Any

from teleop.dji.gimbal.enums import CalibrationState
from teleop.dji.gimbal.messages import Calibrate
from teleop.sim.gimbal.autotune import Autotune


def due(tuning: Autotune, now: float) -> list[tuple[float, Any]]:
    """The pushes up to `now`, whose fields a test reads."""
    return list(tuning.due(now))


def order(tuning: Autotune, start: bool, now: float) -> None:
    tuning.handlers[Calibrate](Calibrate(start), now)


def test_its_progress_grows_to_complete_and_then_it_says_no_more() -> None:
    tuning = Autotune()
    assert tuning.due(5.0) == []
    order(tuning, True, 10.0)
    pushes = [push for look in range(40) for push in due(tuning, 10.0 + look / 2)]
    progress = [push.progress for _, push in pushes]
    assert progress == sorted(set(progress))
    assert [push.state for _, push in pushes] == [CalibrationState.RUNNING] * 19 + [CalibrationState.COMPLETE]
    assert progress[-1] == 100
    assert not tuning.running(30.0)
    assert tuning.due(99.0) == []


def test_a_stop_is_answered_by_one_push_and_ends_it() -> None:
    tuning = Autotune()
    order(tuning, True, 0.0)
    tuning.due(1.0)
    order(tuning, False, 1.2)
    [(time, push)] = due(tuning, 5.0)
    assert (time, push.state, push.progress) == (1.2, CalibrationState.NONE, 0)
    assert not tuning.running(1.3)


def test_a_stop_of_nothing_says_nothing() -> None:
    tuning = Autotune()
    order(tuning, False, 1.0)
    assert tuning.due(5.0) == []


def test_a_start_while_it_runs_begins_anew() -> None:
    tuning = Autotune()
    order(tuning, True, 0.0)
    order(tuning, True, 6.0)
    assert tuning.running(15.9)
    assert due(tuning, 6.5)[0][1].progress == 5

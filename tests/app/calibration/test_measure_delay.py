"""The delay of a simulated gimbal, as a value; what did not move or did not come to its end has none."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager

import pytest
from silent_screen import SilentScreen, no_signals

from teleop.app.calibration.measure_delay import SWINGS, DelayReport, measure_delay
from teleop.app.run import Signals
from teleop.config.profile import load_profile
from teleop.core.axes import Axis
from teleop.core.clock import VirtualClock
from teleop.core.errors import DeviceError, UsageError
from teleop.core.run_state import Result
from teleop.devices import rig
from teleop.monitors.delay_estimate import Delay
from teleop.sim.gimbal.device import SimulatedGimbal


def measured(axis: Axis = Axis.PAN, signals: Signals = no_signals) -> DelayReport:
    screen = SilentScreen()
    return measure_delay(
        load_profile("sim"), axis, VirtualClock(), lambda *_: screen, signals, screen.notify, None, virtual=True
    )


def test_a_gimbal_that_reacts_late_is_later_by_that(monkeypatch: pytest.MonkeyPatch):
    prompt = measured()
    monkeypatch.setattr(rig, "SimulatedGimbal", lambda **options: SimulatedGimbal(**{**options, "reaction": 0.1}))
    late = measured()
    assert late.result is Result.DONE
    assert len(late.delays) == SWINGS - 2
    assert late.seconds - prompt.seconds == pytest.approx(0.1, abs=0.01)
    assert late.scale == pytest.approx(1, abs=0.02)


def test_a_run_that_is_interrupted_has_no_delay():
    @contextmanager
    def signals(interrupt: Callable[[str], object], *_: object) -> Iterator[None]:
        interrupt("SIGTERM")
        yield

    report = measured(signals=signals)
    assert (report.result, list(report.reasons), list(report.delays)) == (Result.INTERRUPTED, ["SIGTERM"], [])


@pytest.mark.parametrize(
    ("found", "error"),
    [
        (Delay(0.1, 0.4, 0.01), r"the axis moved 0\.40 times the commanded distance"),
        (Delay(0.1, 1.6, 0.01), r"the axis moved 1\.60 times the commanded distance"),
        (Delay(0.1, 1.0, 0.6), r"with an error of 0\.60 deg"),
        (None, "did not move, or sent too few readings"),
    ],
)
def test_what_is_no_delay_is_an_error(monkeypatch: pytest.MonkeyPatch, found: Delay | None, error: str):
    monkeypatch.setattr("teleop.app.calibration.measure_delay.estimate", lambda *_: found)
    with pytest.raises(DeviceError, match=error):
        measured()


def test_an_axis_that_no_gimbal_moves_is_refused():
    with pytest.raises(UsageError, match="--axis focus: no gimbal of Simulated rig moves it"):
        measured(Axis.FOCUS)


def test_a_gimbal_that_seems_early_is_set_to_be_on_time():
    def report(*seconds: float) -> DelayReport:
        return DelayReport(Result.DONE, [], "position", [Delay(each, 1.0, 0.0) for each in seconds])

    assert report(-0.02, -0.01).setting == 0.0
    assert report(0.1236, 0.1238).setting == pytest.approx(0.124)
    assert report(0.1, 0.2).spread == pytest.approx(0.0707, abs=1e-4)

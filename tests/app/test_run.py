"""One run on a simulated rig: observed, interrupted, recorded, reported; the process left as it was found."""

from __future__ import annotations

import gc
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest
from fakes import RecordingObserver, cruising
from silent_screen import SilentScreen, no_signals

from teleop.app.run import RunReport, Signals, commands, run, undisturbed
from teleop.app.switch_interval import SWITCH_INTERVAL
from teleop.config.profile import load_profile
from teleop.core.axes import Axis
from teleop.core.clock import VirtualClock
from teleop.core.run_state import Result
from teleop.devices.rig import open_rig
from teleop.monitors.tracking_error import TrackingErrorMonitor
from teleop.recording.reader import read_take
from teleop.recording.writer import recording

AXES = [Axis.PAN, Axis.TILT]


def ran(screen: SilentScreen, signals: Signals = no_signals, seconds: float = 0.5, **options) -> RunReport:
    source = cruising(Axis.PAN, 20.0, seconds)
    tracking = TrackingErrorMonitor(lambda: source.begin)
    with open_rig(load_profile("sim").in_use(AXES), VirtualClock()) as rig:
        return run(rig, AXES, [source], tracking, screen, signals, **options)


def test_a_run_is_shown_and_reported():
    screen, observer = SilentScreen(), RecordingObserver()
    report = ran(screen, observers=[observer])
    assert (report.result, list(report.reasons), report.drone, report.take) == (Result.DONE, [], None, None)
    assert (screen.entered, screen.left) == (1, 1)
    assert observer.ticks == screen.ticks
    assert report.tracking.scores[Axis.PAN].readings > 5
    assert report.links["gimbal"]["frames_out"] > 10


def test_a_stop_that_is_not_cleared_is_among_the_reasons():
    assert list(ran(SilentScreen(), stopped=lambda: "ended while stopped").reasons) == ["ended while stopped"]


def test_a_signal_interrupts_it():
    @contextmanager
    def signals(interrupt: Callable[[str], object], *_: object) -> Iterator[None]:
        interrupt("SIGTERM")
        yield

    report = ran(SilentScreen(), signals, seconds=100.0)
    assert (report.result, list(report.reasons)) == (Result.INTERRUPTED, ["SIGTERM"])


def test_a_take_has_the_end_of_the_run(tmp_path: Path):
    limits = {axis: load_profile("sim").limits[axis] for axis in AXES}
    with recording(tmp_path / "a.mcap", "Rig", "Cruise", limits, patient=True) as take:
        report = ran(SilentScreen(), take=take, stopped=lambda: "the last word")
    assert report.take is take
    ending = read_take(tmp_path / "a.mcap").ending
    assert ending is not None
    assert (ending.result, list(ending.reasons)) == ("done", ["the last word"])
    assert ending.links == report.links


def test_only_a_rig_with_a_gimbal_gets_a_sink_for_its_commands():
    profile = load_profile("sim")
    with open_rig(profile, VirtualClock()) as rig:
        assert len(commands(rig, AXES, print)[1]) == 1
    bare = profile.model_copy(update={"sinks": [each for each in profile.sinks if each.type != "gimbal"]})
    with open_rig(bare, VirtualClock()) as rig:
        assert commands(rig, [Axis.FOCUS], print)[1] == []


def test_the_process_is_left_as_it_was_found_whatever_is_raised():
    before = sys.getswitchinterval(), gc.get_freeze_count()

    @undisturbed()
    def fail() -> None:
        assert sys.getswitchinterval() == pytest.approx(SWITCH_INTERVAL)
        assert gc.get_freeze_count() > 0
        raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        fail()
    assert (sys.getswitchinterval(), gc.get_freeze_count()) == before


def test_what_somebody_else_has_frozen_stays_frozen():
    gc.freeze()
    try:
        with undisturbed():
            pass
        assert gc.get_freeze_count() > 0
    finally:
        gc.unfreeze()

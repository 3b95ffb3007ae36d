"""Recorded sticks on a simulated rig, alone and beside an operator; by hand something has to be in a hand."""

from __future__ import annotations

from pathlib import Path

import pytest
from fake_hid import FakeBackend
from silent_screen import SilentScreen, no_signals

from teleop.app import operator_inputs, stop_inputs
from teleop.app.live import NO_INPUT, LiveRun
from teleop.config.profile import load_profile
from teleop.core.axes import Axis
from teleop.core.clock import VirtualClock
from teleop.core.errors import UsageError
from teleop.core.run_state import Result
from teleop.core.run_status import RunStatus
from teleop.inputs.recorded_sticks import Sticks, SticksSource
from teleop.recording.reader import read_take

STICKS = Sticks([Axis.PAN], [0.0, 1.0, 1.5], [[0.5], [0.0], [0.0]])


@pytest.fixture(autouse=True)
def no_devices(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(stop_inputs, "AllDevices", FakeBackend)
    monkeypatch.setattr(operator_inputs, "AllDevices", FakeBackend)


def live(take: Path | None = None, recorded: Sticks | None = STICKS, speed: float = 0.3) -> LiveRun:
    profile = load_profile("sim").in_use([Axis.PAN])
    profile = profile.model_copy(update={"sticks": profile.sticks.model_copy(update={"speed": speed})})
    return LiveRun(profile, "Sticks", VirtualClock(), None, recorded, take=take, virtual=True)


def status(_source: SticksSource):
    return lambda _now: RunStatus("replaying")


def test_recorded_sticks_move_the_rig_to_their_last_row(tmp_path: Path):
    screen, seen = SilentScreen(), []

    def make(limits, shown, recorder):
        seen.append((list(limits), shown(0.0).phase, recorder is not None))
        return screen

    report = live(tmp_path / "a.mcap").unattended(status, make, no_signals, screen.notify)
    assert report.result is Result.DONE
    assert seen == [([Axis.PAN], "replaying", True)]
    assert screen.ticks[-1].motion[Axis.PAN].position > 10
    assert read_take(tmp_path / "a.mcap").about.title == "Sticks"


def test_the_profile_s_share_of_speed_scales_recorded_sticks():
    velocity = load_profile("sim").axes[Axis.PAN].velocity
    for share in (0.2, 0.8):
        run = live(speed=share)
        source = run.replay(STICKS)
        source.start(0.0, {})
        demand, _ = source.read(0.5, None)  # type: ignore[arg-type]  # sticks ask for no feedback
        assert demand[Axis.PAN].velocity == pytest.approx(0.5 * share * velocity)  # type: ignore[union-attr]


def test_by_hand_there_has_to_be_an_input():
    with pytest.raises(UsageError, match=NO_INPUT.partition(":")[0]):
        live(recorded=None).by_hand(lambda _parts: SilentScreen(), no_signals)

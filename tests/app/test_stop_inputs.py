"""The STOP of the profile's devices in runs that move by themselves: opened, counted, missed, lost."""

from __future__ import annotations

import threading
from collections.abc import Callable
from contextlib import ExitStack
from pathlib import Path

import pytest
from fake_hid import FakeBackend, FakeDevice, real
from waiting import wait_until

from teleop.app import stop_inputs
from teleop.cli.screens.folded import warn
from teleop.config.profile import Profile, load_profile
from teleop.config.resources import folder
from teleop.core.clock import SystemClock
from teleop.core.errors import DeviceError
from teleop.core.operator_input import Command, Held

F310 = real("Logitech F310")
REST, STOP, SLOWER = (bytes.fromhex(text) for text in ("7f7f7f7f08000000", "7f7f7f7f48000000", "7f7f7f7f08010000"))
HELD_OVER = bytes.fromhex("ff7f7f7f08000000")


def f310() -> FakeDevice:
    return FakeDevice(bytes.fromhex(F310["descriptor"]), (F310["vendor_id"], F310["product_id"]), "Pad")


def profile_with(tmp_path: Path, inputs: str) -> Profile:
    (tmp_path / "rig.yaml").write_text((folder("profiles") / "sim.yaml").read_text() + inputs)
    return load_profile(str(tmp_path / "rig.yaml"))


def opened(stack: ExitStack, profile: Profile, backend: FakeBackend, monkeypatch: pytest.MonkeyPatch) -> list:
    monkeypatch.setattr(stop_inputs, "AllDevices", lambda: backend)
    return list(stop_inputs.open_stop_inputs(stack, profile, SystemClock(), warn))


@pytest.mark.parametrize("inputs", ["", "inputs: [{device: any}]\n", "inputs: [{pad: logitech-gamepad}]\n"])
def test_only_what_stops_and_goes_on_is_read_of_a_pad(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, inputs: str
) -> None:
    pad = f310()
    with ExitStack() as stack:
        (hand,) = opened(stack, profile_with(tmp_path, inputs), FakeBackend(pad), monkeypatch)
        pad.told(HELD_OVER)
        held = hand.read(1e9)
        assert (held.deflections, held.trouble, held.stop) == ({}, "", "")
        pad.told(SLOWER, STOP)
        assert [press.command for press in hand.read(1e9).presses] == [Command.STOP]


def test_a_pad_that_is_pulled_out_is_a_stop_that_is_lost(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    pad = f310()
    backend = FakeBackend(pad)
    with ExitStack() as stack:
        (hand,) = opened(stack, profile_with(tmp_path, ""), backend, monkeypatch)
        pad.told(REST)
        assert hand.read(1e9).stop == ""
        backend.unplug(pad)
        seen: list[Held] = []
        read: Callable[[], bool] = lambda: bool(seen.append(hand.read(1e9)) or seen[-1].stop)  # noqa: E731
        wait_until(read, "that it is gone")
        assert seen[-1].stop == "Pad: unplugged"


def test_an_absent_one_is_a_warning_and_one_without_a_stop_is_not_opened(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    inputs = "inputs:\n  - {name: Left hand, pad: logitech-gamepad}\n  - {controls: {X: {axis: pan}}}\n"
    with ExitStack() as stack:
        (hand,) = opened(stack, profile_with(tmp_path, inputs), FakeBackend(), monkeypatch)
        assert hand.read(0.0).stop is None
    assert capsys.readouterr().err == "teleop: warning: Left hand: not plugged in, so it cannot STOP the run\n"


def test_without_inputs_and_without_a_joystick_nothing_is_opened_or_said(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    with ExitStack() as stack:
        assert opened(stack, profile_with(tmp_path, ""), FakeBackend(), monkeypatch) == []
    assert capsys.readouterr().err == ""
    assert not [thread for thread in threading.enumerate() if thread.name.startswith("hid")]


def test_a_system_that_reads_no_devices_blocks_nothing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def refuse() -> FakeBackend:
        raise DeviceError("hidapi is not there")

    monkeypatch.setattr(stop_inputs, "AllDevices", refuse)
    with ExitStack() as stack:
        assert stop_inputs.open_stop_inputs(stack, profile_with(tmp_path, ""), SystemClock(), warn) == []
        assert capsys.readouterr().err == ""
        named = profile_with(tmp_path, "inputs: [{device: any}]\n")
        assert stop_inputs.open_stop_inputs(stack, named, SystemClock(), warn) == []
    assert "hidapi is not there, so no input can be read" in capsys.readouterr().err

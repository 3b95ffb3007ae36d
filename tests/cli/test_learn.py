"""`teleop live --learn`: a dialogue with somebody at a real pad's reports, and the mapping that is printed."""

from __future__ import annotations

import itertools
from collections.abc import Mapping, Sequence
from pathlib import Path

import pytest
from command import teleop
from fake_hid import FakeBackend, FakeDevice, real

from teleop.cli.learn import learn
from teleop.config.profile import load_profile
from teleop.config.resources import folder
from teleop.core.axes import Axis
from teleop.core.errors import DeviceError, UsageError

REST = "7f7f7f7f08000000"
HAND: Mapping[str, Sequence[str]] = {
    "pan right": ["a07f7f7f08000000", "ff7f7f7f08000000"],
    "tilt up": ["7f007f7f08000000"],
    "focus farther": ["7f7f7f7f08080000"],
    "focus nearer": ["7f7f7f7f08040000"],
    "for: STOP": ["7f7f7f7f18000000"],
    "for: record": ["7f7f7f7f18000000"],
    "recall preset 1": ["7f7f7f7f00000000"],
    "must be held": ["7f7f7f7f08010000"],
}


class Hand:
    """Somebody who does with the pad what they are asked for, or presses Enter."""

    def __init__(self, pad: FakeDevice) -> None:
        self.pad, self.heard = pad, list[str]()
        self._presses = False

    def notify(self, text: str) -> None:
        self.heard.append(text)
        does = next((reports for words, reports in HAND.items() if words in text), None)
        if does is not None:
            self.pad.report(*map(bytes.fromhex, does))
        elif text.endswith(("release it", "release all controls.")):
            self.pad.report(bytes.fromhex(REST))
        elif "already" in text:
            self.pad.report(bytes.fromhex("7f7f7f7f28000000"))
        elif "Enter" in text:
            self._presses = True

    def skips(self) -> bool:
        pressed, self._presses = self._presses, False
        return pressed


def pad() -> FakeDevice:
    return FakeDevice(bytes.fromhex(real("Logitech F310")["descriptor"]), (0x046D, 0xC216), "Logitech Dual Action")


def test_a_mapping_by_moving_each_control(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    device = pad()
    device.report(bytes.fromhex(REST))
    hand, clock = Hand(device), itertools.count()
    assert learn([Axis.PAN, Axis.TILT, Axis.FOCUS], FakeBackend(device), hand, lambda: next(clock) * 0.1) == 0
    printed = capsys.readouterr().out
    assert (
        printed
        == """\
inputs:   # Logitech Dual Action
  - device: {vendor: 0x046d, product: 0xc216}
    enable: Button 5
    controls:
      X: {axis: pan}
      Y: {axis: tilt, invert: true}
      Button 8: {axis: focus}
      Button 7: {axis: focus, invert: true}
      Button 1: {press: stop}
      Button 2: {press: record}
      Hat switch:
        up: {press: recall, number: 1, hold: store}
"""
    )
    assert "  Button 1 is already in use: choose another" in hand.heard
    assert device.closed == 1
    rig = tmp_path / "rig.yaml"
    rig.write_text((folder("profiles") / "sim.yaml").read_text() + printed)
    assert load_profile(str(rig)).inputs[0].enable == "Button 5"


def test_a_stick_that_is_held_for_a_while_is_not_taken_for_a_slider(capsys: pytest.CaptureFixture[str]) -> None:
    device = pad()
    device.report(bytes.fromhex(REST))
    time = [0.0]

    def now() -> float:
        time[0] += 0.1
        return time[0]

    class Slow(Hand):
        """Lets go a second after being told to."""

        def notify(self, text: str) -> None:
            if not text.endswith("release it"):
                super().notify(text)
                return
            told, read = time[0], device.read

            def later(timeout: float) -> bytes:
                if time[0] - told > 1:
                    device.read = read
                    device.report(bytes.fromhex(REST))
                return read(timeout)

            device.read = later

    learn([Axis.PAN, Axis.TILT], FakeBackend(device), Slow(device), now)
    assert "X: {axis: pan}\n" in capsys.readouterr().out


def test_a_joystick_that_is_pulled_out_ends_it() -> None:
    device = pad()
    device.pull()
    with pytest.raises(DeviceError, match="Logitech Dual Action: unplugged; nothing was learned"):
        learn([Axis.PAN], FakeBackend(device), Hand(device))
    assert device.closed == 1


def test_without_a_joystick_it_says_so() -> None:
    with pytest.raises(UsageError, match="no joystick found: plug one in"):
        learn([Axis.PAN], FakeBackend(), Hand(pad()))


def test_it_wants_a_terminal() -> None:
    done = teleop("live", "--learn")
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr == "teleop: --learn asks questions: run it on a terminal\n"

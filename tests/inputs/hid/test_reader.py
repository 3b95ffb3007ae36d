"""The steps of a reader on the virtual clock: when it looks, reads and asks."""

from __future__ import annotations

from collections.abc import Callable

import pytest
from fake_hid import JOYSTICK, FakeDevice, real

from teleop.config.inputs_section import ControlSection, InputSection
from teleop.core.axes import Axis
from teleop.inputs.hid.backend import DeviceInfo
from teleop.inputs.hid.claims import Claims
from teleop.inputs.hid.descriptor.parser import parse_descriptor
from teleop.inputs.hid.mapping import Mapped
from teleop.inputs.hid.pads import Chosen
from teleop.inputs.hid.reader import HidReader, Plugged
from teleop.inputs.hid.recording import RecordedDevices, Recording, Row
from teleop.inputs.hid.state import HidState

X_PANS = {"X": ControlSection(axis=Axis.PAN)}
F310 = bytes.fromhex(real("Logitech F310")["descriptor"])
REST, RIGHT = bytes.fromhex("7f7f7f7f08000000"), bytes.fromhex("ff7f7f7f08000000")
PAD = DeviceInfo(b"/dev/hidraw0", 0x1234, 0x5678, "", "Pad", *JOYSTICK, 0, port="1-2")


def mapped(chosen: Chosen, state: HidState, info: DeviceInfo) -> Mapped:
    return Mapped(chosen.controls, guessed=chosen.guessed)


class Polled:
    """A reader of one recorded device, on a clock that a test moves."""

    def __init__(self, *rows: Row, claims: Claims | None = None) -> None:
        self.now = 0.0
        backend = RecordedDevices([Recording([PAD], F310, rows)], lambda: self.now, lambda: 0.0)
        self.reader = HidReader(InputSection(), backend, lambda: self.now, claims or Claims(), mapped)

    def x_at(self, now: float) -> float | None:
        """What its stick has reported by then, None where no device is there."""
        self.now = now
        self.reader.poll(now)
        plugged = self.reader.plugged
        return plugged.state.values["X"].value if plugged and plugged.state.values else None


def test_each_report_is_read_when_it_comes_and_a_device_that_is_back_at_the_next_look() -> None:
    polled = Polled(Row(0.5, REST), Row(0.7, RIGHT), Row(2.0, gone=True), Row(2.25), Row(3.5, REST))
    seen = [polled.x_at(now) for now in (0.4, 0.5, 0.69, 0.7, 1.9, 2.1, 2.9, 3.4, 3.5)]
    assert seen == [None, 127, 127, 255, 255, None, None, None, 127]
    assert polled.reader.last == PAD


def test_a_report_has_the_time_at_which_it_came_however_late_it_is_polled() -> None:
    polled = Polled(Row(0.5, REST))
    polled.reader.poll(0.0)
    polled.x_at(7.25)
    assert polled.reader.plugged is not None
    assert polled.reader.plugged.state.last == 0.5


def test_a_closed_reader_leaves_its_device_to_others() -> None:
    claims = Claims()
    polled = Polled(Row(0.5, REST), claims=claims)
    polled.x_at(1.0)
    assert not claims.take(PAD.path)
    polled.reader.close()
    assert claims.take(PAD.path)
    assert polled.reader.plugged is None


class Asked:
    """A device with a descriptor of one report, asked on a clock that a test moves."""

    def __init__(self, answers: Callable[[int], bytes] | None) -> None:
        self.now = 0.0
        self.device = FakeDevice(F310, answers=answers)
        self.plugged = Plugged(PAD, HidState(parse_descriptor(F310)), Chosen(reports="on-change"), Mapped(X_PANS))
        self.plugged.state.take(REST, 0.0)

    def at(self, *times: float) -> int:
        """How often it has been asked after these times."""
        for self.now in times:
            self.plugged.ask(self.device, lambda: self.now)
        return len(self.device.asked)


def test_a_quiet_device_is_asked_ten_times_a_second_and_its_answer_counts() -> None:
    asked = Asked(lambda _number: RIGHT)
    assert asked.at(0.05, 0.09) == 0
    assert asked.at(0.11, 0.15, 0.2) == 1
    assert asked.plugged.state.values["X"].value == 255
    assert asked.at(0.22, 0.25) == 2
    assert asked.plugged.state.last == 0.22


@pytest.mark.parametrize("answers", [None, lambda _number: b""])
def test_a_device_that_once_did_not_answer_is_not_asked_again(answers: Callable[[int], bytes] | None) -> None:
    asked = Asked(answers)
    assert asked.at(0.5, 1.0, 5.0) == 1
    assert asked.plugged.state.last == 0.0

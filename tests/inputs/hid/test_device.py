"""A HID device in the hand: found, read, lost and found again, trusted only while it can be. Bytes of real devices."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

import pytest
from fake_hid import GAMEPAD, JOYSTICK, KEYBOARD, FakeBackend, FakeDevice, real
from waiting import wait_until

from teleop.config.inputs_section import DeviceSection, InputSection
from teleop.core.axes import Axis
from teleop.core.operator_input import Command, Held, Press
from teleop.inputs.hid import reader as hid_reader
from teleop.inputs.hid.cadence import STEADY
from teleop.inputs.hid.device import HidInput, open_inputs

F310 = real("Logitech F310")
REST, RIGHT = bytes.fromhex("7f7f7f7f08000000"), bytes.fromhex("ff7f7f7f08000000")
STRONG = bytes.fromhex("e07f7f7f08000000")
STICKY, STOP = bytes.fromhex("807f7f7f08000000"), bytes.fromhex("7f7f7f7f48000000")
CENTERED = {Axis.PAN: 0.0, Axis.TILT: 0.0, Axis.ROLL: 0.0, Axis.FOCUS: 0.0}


@pytest.fixture(autouse=True)
def _look_often(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(hid_reader, "LOOK_EVERY", 0.01)


class Time:
    def __init__(self) -> None:
        self.now = 100.0

    def __call__(self) -> float:
        return self.now


class Hand:
    """Inputs on a fake backend, read at a time that passes only when a test says so."""

    def __init__(self, time: Time, inputs: list[HidInput]) -> None:
        self.time, self.inputs = time, inputs
        self.presses: list[Press] = []
        self.notes: list[str] = []

    def read(self, index: int = 0) -> Held:
        held = self.inputs[index].read(self.time.now)
        self.presses += held.presses
        self.notes += held.notes
        return held

    def until(self, holds: Callable[[Held], object], index: int = 0) -> Held:
        last: list[Held] = []

        def reads() -> object:
            last[:] = [self.read(index)]
            return holds(last[0])

        wait_until(reads, "what the hand is to say")
        return last[0]

    def until_trouble(self, ending: str, index: int = 0) -> Held:
        held = self.until(lambda held: held.trouble.endswith(ending), index)
        assert held.deflections == held.steps == {}
        return held

    def settle(self, device: FakeDevice, *reports: bytes) -> None:
        """Plugged in, at rest, its centres found; a device that was asked to reports all the time then does."""
        device.told(*reports or (REST,))
        self.until_trouble("finding its center: release the sticks")
        self.time.now += 0.3
        device.told(STICKY, REST)
        self.until(lambda held: held.trouble == "" and held.deflections == CENTERED)


@contextmanager
def in_hand(backend: FakeBackend, *sections: dict[str, Any]) -> Iterator[Hand]:
    time = Time()
    with open_inputs([InputSection.model_validate(each) for each in sections], time, backend) as inputs:
        yield Hand(time, inputs)


def f310(**more: Any) -> FakeDevice:
    defaults = {"ids": (F310["vendor_id"], F310["product_id"]), "name": "Logitech Dual Action"}
    return FakeDevice(bytes.fromhex(F310["descriptor"]), **{**defaults, **more})


def pan(held: Held) -> float | None:
    return held.deflections.get(Axis.PAN)


def test_any_joystick_is_found_and_moves_the_axes() -> None:
    pad = f310()
    with in_hand(FakeBackend(pad)) as hand:
        hand.until_trouble("no report yet")
        hand.settle(pad)
        pad.told(RIGHT)
        hand.until(lambda held: pan(held) == 1)
        assert hand.inputs[0].name == "Logitech Dual Action"
        assert hand.notes == []


def test_one_that_is_plugged_in_later_is_found_by_itself() -> None:
    backend, pad = FakeBackend(), f310()
    with in_hand(backend) as hand:
        hand.until_trouble("joystick: not plugged in")
        wait_until(lambda: backend.looks > 2)
        backend.plug(pad)
        hand.settle(pad)


def test_unplugged_in_mid_pan_it_is_locked_and_when_it_is_back_its_center_is_known() -> None:
    pad = f310(serial="A")
    backend = FakeBackend(pad)
    with in_hand(backend) as hand:
        hand.settle(pad)
        pad.told(RIGHT)
        hand.until(lambda held: pan(held) == 1)
        backend.unplug(pad)
        hand.until_trouble("Logitech Dual Action: unplugged")
        assert pad.closed == 1
        again = f310(serial="A", path=b"/dev/hidraw7")
        backend.plug(again)
        again.told(RIGHT)
        hand.until(lambda held: pan(held) == 1)


def test_after_an_unplugging_the_same_is_wanted_then_its_like_then_what_was_plugged_in_since() -> None:
    was = f310(serial="A").info
    like = f310(serial="B", path=b"1").info
    same = f310(serial="A", path=b"2").info
    other = f310(ids=(0x046D, 0xC219), path=b"0").info
    found = [other, like, same]
    assert list(hid_reader.wanted(DeviceSection(), found, None)) == [other, like, same]
    assert list(hid_reader.wanted(DeviceSection(), found, was)) == [same, like, other]
    assert list(hid_reader.wanted(DeviceSection(), found, was, {b"0"})) == [same, like]
    named = DeviceSection.model_validate({"vendor": 0x046D, "product": F310["product_id"]})
    assert list(hid_reader.wanted(named, found, was)) == [same, like]


def test_a_spare_of_another_model_that_is_plugged_in_afterwards_takes_its_place_and_is_centred_first() -> None:
    pad, spare = f310(), f310(ids=(0x046D, 0xC219), name="Spare", path=b"/dev/hidraw1")
    backend = FakeBackend(pad)
    with in_hand(backend, {"device": "any", "enable": "Button 9"}) as hand:
        hand.settle(pad)
        backend.unplug(pad)
        hand.until_trouble("Logitech Dual Action: unplugged")
        looks = backend.looks
        wait_until(lambda: backend.looks > looks + 3)
        backend.plug(spare)
        spare.told(RIGHT)
        hand.until_trouble("Spare: finding its center: release the sticks")
        hand.settle(spare)
        assert hand.read().enabled is False
        spare.told(RIGHT)
        hand.until(lambda held: pan(held) == 1)
        backend.plug(again := f310())
        backend.unplug(spare)
        hand.until_trouble("Spare: unplugged")
        assert again.opened == 0


def test_another_model_that_had_been_there_all_along_does_not_take_its_place() -> None:
    pad, other = f310(), f310(ids=(0x046D, 0xC219), path=b"/dev/hidraw1")
    backend = FakeBackend(pad)
    with in_hand(backend) as hand:
        hand.settle(pad)
        backend.plug(other)
        backend.unplug(pad)
        looks = backend.looks
        wait_until(lambda: backend.looks > looks + 3)
        hand.until_trouble("unplugged")
        assert other.opened == 0


def test_a_press_between_two_looks_and_right_before_an_unplugging_is_not_lost() -> None:
    pad = f310()
    backend = FakeBackend(pad)
    with in_hand(backend) as hand:
        hand.settle(pad)
        pad.report(STOP, REST)
        backend.unplug(pad)
        hand.until_trouble("unplugged")
        hand.read()
        assert hand.presses == [Press(Command.STOP)]


def test_a_device_that_reports_all_the_time_and_stops_is_silent_after_200_ms() -> None:
    pad = f310()
    with in_hand(FakeBackend(pad)) as hand:
        hand.settle(pad)
        pad.told(*[REST] * (STEADY + 1), STICKY)
        hand.until(lambda held: pan(held) == 0)
        hand.time.now += 0.19
        assert hand.read().trouble == ""
        hand.time.now += 0.02
        hand.until_trouble("Logitech Dual Action: no report for 0.2 s")
        pad.told(REST)
        hand.until(lambda held: held.trouble == "")


def test_one_that_reports_only_changes_may_be_silent_at_rest() -> None:
    pad = f310()
    with in_hand(FakeBackend(pad)) as hand:
        hand.settle(pad)
        hand.time.now += 3600
        assert hand.read() == Held(CENTERED, notes=[], presses=[])


def test_one_that_is_held_over_and_does_not_answer_is_silent() -> None:
    pad = f310()
    with in_hand(FakeBackend(pad)) as hand:
        hand.settle(pad)
        pad.told(RIGHT)
        hand.until(lambda held: pan(held) == 1)
        hand.time.now += 0.21
        hand.until_trouble("no report for 0.2 s")
        wait_until(lambda: pad.asked)
        hand.time.now += 10
        hand.until_trouble("no report for 0.2 s")
        assert len(pad.asked) == 1


@pytest.mark.parametrize("reports", ["auto", "on-change"])
def test_one_that_is_held_over_and_answers_is_alive(reports: str) -> None:
    answer = [REST]
    pad = f310(answers=lambda _number: answer[0])
    with in_hand(FakeBackend(pad), {"reports": reports}) as hand:
        hand.until_trouble("finding its center: release the sticks")
        hand.time.now += 0.3
        hand.until(lambda held: held.deflections == CENTERED)
        answer[0] = RIGHT
        hand.time.now += 0.15
        hand.until(lambda held: pan(held) == 1)
        for _ in range(5):
            asked = len(pad.asked)
            hand.time.now += 0.15
            assert pan(hand.read()) == 1
            wait_until(lambda before=asked: len(pad.asked) > before)
            reads = pad.reads
            wait_until(lambda before=reads: pad.reads > before, "that the answer is taken")


def test_one_that_is_said_to_report_all_the_time_is_not_asked() -> None:
    pad = f310(answers=lambda _number: RIGHT)
    with in_hand(FakeBackend(pad), {"reports": "continuous"}) as hand:
        hand.settle(pad)
        hand.time.now += 0.21
        hand.until_trouble("no report for 0.2 s")
        assert pad.asked == []


def test_the_very_same_report_for_ten_seconds_is_a_frozen_device_while_it_is_deflected() -> None:
    pad = f310()
    with in_hand(FakeBackend(pad)) as hand:
        hand.settle(pad)
        pad.told(*[REST] * (STEADY + 1))
        hand.until(lambda held: pan(held) == 0)
        for _ in range(120):
            hand.time.now += 0.1
            pad.told(REST)
            hand.until(lambda held: pan(held) == 0)
        pad.told(STRONG)
        hand.until(lambda held: pan(held) or 0)
        for _ in range(99):
            hand.time.now += 0.1
            pad.told(STRONG)
            hand.until(lambda held: pan(held) or 0)
        hand.time.now += 0.15
        pad.told(STRONG)
        hand.until_trouble("reports unchanged for 10 s; stuck_timeout in the profile changes it")
        pad.told(bytes.fromhex("fe7f7f7f08000000"))
        hand.until(lambda held: held.trouble == "")


def test_a_stop_counts_even_of_a_device_that_is_not_trusted() -> None:
    pad = f310()
    with in_hand(FakeBackend(pad), {"reports": "continuous"}) as hand:
        pad.told(REST, STOP)
        hand.until_trouble("finding its center: release the sticks")
        hand.until(lambda _held: hand.presses)
        assert hand.presses == [Press(Command.STOP)]


def test_a_stick_that_is_held_while_a_mapping_is_guessed_is_left_out_and_said() -> None:
    pad = f310(ids=(0x1111, 0x2222))
    with in_hand(FakeBackend(pad)) as hand:
        pad.told(RIGHT)
        hand.until_trouble("finding its center: release the sticks")
        hand.time.now += 0.3
        hand.until(lambda held: held.trouble == "")
        assert pan(hand.read()) is None
        assert hand.notes == ["Logitech Dual Action: X was not centered and is ignored until it is: release it"]


def test_a_pads_two_right_sticks_are_told_from_triggers_by_where_they_rest() -> None:
    ds4 = real("Sony DualShock 4", "usb")
    rest = bytes.fromhex("0180808080080000" + "0000" + "00" * 54)
    pad = FakeDevice(bytes.fromhex(ds4["descriptor"]), (0x1111, 0x2222))
    with in_hand(FakeBackend(pad)) as hand:
        pad.told(rest)
        hand.until_trouble("finding its center: release the sticks")
        hand.time.now += 0.3
        assert hand.until(lambda held: held.trouble == "").deflections == CENTERED
        pad.told(bytes.fromhex("0180808000080000" + "ff80" + "00" * 54))
        held = hand.until(lambda held: held.deflections[Axis.FOCUS])
        assert held.deflections == {**CENTERED, Axis.FOCUS: 1}
        assert hand.notes == []


def test_what_is_mapped_to_a_control_that_is_not_there_is_said_once() -> None:
    pad = f310()
    section = {
        "device": {"name": "*dual*"},
        "name": "Pan bars",
        "controls": {"Slider": {"axis": "pan"}, "X": {"axis": "tilt"}},
    }
    with in_hand(FakeBackend(pad), section) as hand:
        pad.told(REST)
        hand.until_trouble("finding its center: release the sticks")
        hand.time.now += 0.3
        hand.until(lambda held: held.deflections == {Axis.TILT: 0})
        assert hand.notes == ["Pan bars: no control Slider: its mapping is ignored"]


def test_a_device_that_may_not_be_opened_is_said_until_it_may() -> None:
    pad = f310()
    pad.may_be_opened = False
    with in_hand(FakeBackend(pad)) as hand:
        hand.until_trouble("Logitech Dual Action cannot be opened (open failed): check its udev rule: teleop doctor")
        pad.may_be_opened = True
        hand.settle(pad)


def test_a_pad_that_cannot_be_used_is_said_and_another_is_taken() -> None:
    pro = f310(ids=(0x057E, 0x2009), name="Pro Controller")
    backend = FakeBackend(pro)
    with in_hand(backend) as hand:
        hand.until_trouble("Pro Controller cannot be used: its reports are not what its descriptor says")
        pad = f310(path=b"/dev/hidraw9")
        backend.plug(pad)
        hand.settle(pad)


def test_keyboards_are_taken_only_by_their_ids() -> None:
    keyboard = f310(ids=(0x1, 0x2), usage=KEYBOARD, name="Keyboard")
    backend = FakeBackend(keyboard)
    with in_hand(backend, {}, {"device": {"name": "Key*"}}) as hand:
        wait_until(lambda: backend.looks > 6)
        hand.until_trouble("not plugged in")
        hand.until_trouble("not plugged in", 1)
        assert keyboard.opened == 0
    with in_hand(backend, {"device": {"vendor": 1, "product": 2}}) as hand:
        hand.until_trouble("no report yet")


def test_a_backend_that_cannot_say_what_a_device_is_for_offers_only_known_ones() -> None:
    unknown = f310(ids=(0x1, 0x2), usage=(0, 0))
    backend = FakeBackend(unknown)
    with in_hand(backend) as hand:
        wait_until(lambda: backend.looks > 3)
        assert unknown.opened == 0
        known = f310(usage=(0, 0), path=b"1-2:1.0")
        backend.plug(known)
        hand.settle(known)


def test_two_inputs_do_not_share_a_device_and_the_first_has_the_choice() -> None:
    one, other = f310(serial="A"), f310(serial="B", path=b"/dev/hidraw1")
    backend = FakeBackend(one)
    with in_hand(backend, {}, {"device": "any"}) as hand:
        wait_until(lambda: one.opened)
        wait_until(lambda: backend.looks > 4)
        backend.plug(other)
        wait_until(lambda: other.opened)
        assert (one.opened, other.opened) == (1, 1)
        for index in (0, 1):
            hand.until_trouble("Logitech Dual Action: no report yet", index)


def test_an_enable_button_is_off_when_nothing_is_known() -> None:
    pad = f310()
    with in_hand(FakeBackend(pad), {"pad": "logitech-gamepad", "enable": "Button 9"}) as hand:
        assert hand.read().enabled is False
        hand.settle(pad)
        assert hand.read().enabled is False
        pad.told(bytes.fromhex("7f7f7f7f08100000"))
        hand.until(lambda held: held.enabled)


@pytest.mark.parametrize(
    ("enable", "said"),
    [
        ("Button 99", "enable: it has no Button 99; it has Button 1, Button 2, Button 3, Button 4, Button 5, Button 6"),
        ("Button 5", "enable: Button 5 already is slower; take another"),
        ("Hat switch up", "enable: Hat switch up already is recall; take another"),
    ],
)
def test_an_enable_that_the_device_has_not_or_that_does_something_else_is_refused(enable: str, said: str) -> None:
    pad = f310()
    with in_hand(FakeBackend(pad), {"device": "any", "enable": enable}) as hand:
        pad.told(REST)
        hand.until(lambda held: said in held.trouble)
        pad.told(bytes.fromhex("7f7f7f7f48000000"))  # Button 3: its stop counts all the same
        assert [press.command for press in hand.read().presses] == [Command.STOP]


def test_a_reader_that_fails_is_trouble_and_not_silence() -> None:
    pad = f310()
    with in_hand(FakeBackend(pad)) as hand:
        hand.settle(pad)
        pad.report(12)  # type: ignore[arg-type]  # what no device sends
        hand.until_trouble("its reader failed: 'int' object is not subscriptable")


def test_leaving_closes_the_devices() -> None:
    pad = f310()
    with in_hand(FakeBackend(pad)) as hand:
        hand.settle(pad)
    assert pad.closed == 1
    assert hand.read().trouble == "Logitech Dual Action: unplugged"


def test_a_dial_that_is_no_joystick_is_taken_where_its_name_is_asked_for() -> None:
    dial = real("Huion KeyDial")
    device = FakeDevice(bytes.fromhex(dial["descriptor"]), (1, 2), "KeyDial K20", (1, 0x0E))
    section = {"device": {"name": "*keydial*"}, "controls": {"Dial": {"axis": "focus", "coarse": 0.5}}}
    with in_hand(FakeBackend(device), section) as hand:
        device.told(bytes.fromhex("110000000000000000"))
        hand.until(lambda held: held.trouble == "")
        device.told(*[bytes.fromhex("110001000000000000")] * 3)
        moved = [0.0]

        def turned(held: Held) -> bool:
            moved[0] += held.steps[Axis.FOCUS]
            return moved[0] == 1.5

        hand.until(turned)


def test_the_first_that_fits_is_the_one_that_says_it_is_for_hands() -> None:
    keys = f310(usage=KEYBOARD, path=b"/dev/hidraw0")
    pad = f310(usage=JOYSTICK, path=b"/dev/hidraw1")
    with in_hand(FakeBackend(keys, pad), {"device": {"vendor": F310["vendor_id"]}}) as hand:
        hand.settle(pad)
        assert (keys.opened, pad.opened) == (0, 1)
    assert pad.info[5:7] != GAMEPAD


def test_a_trigger_that_the_profile_takes_for_a_stick_is_said() -> None:
    pad = f310()
    with in_hand(FakeBackend(pad), {"controls": {"X": {"axis": "focus"}}}) as hand:
        pad.told(bytes.fromhex("007f7f7f08000000"))
        hand.until_trouble("finding its center: release the sticks")
        hand.time.now += 0.3
        hand.until(lambda _held: hand.notes)
        assert hand.notes == [
            "Logitech Dual Action: X was not centered; a trigger or a throttle needs rest: low or high"
        ]

"""`live --learn` from its questions to the profile, on a virtual clock, with pads that speak bytes."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from fake_hid import JOYSTICK
from learn_bench import (
    BUTTON_1,
    BUTTON_2,
    F310,
    HAT_UP,
    LEFT,
    REST,
    RIGHT,
    SHOULDER,
    SIM,
    TRIGGERS,
    UP,
    LearnBench,
    Pad,
    Pads,
    Time,
    learning,
)

from teleop.app.learn.session import Stage
from teleop.config.profile import load_profile
from teleop.core.errors import DeviceError, UsageError
from teleop.core.operator_input import Command
from teleop.inputs.hid.descriptor.parser import parse_descriptor
from teleop.inputs.hid.recording import RecordedDevices, read_recording
from teleop.inputs.hid.state import HidState

RECORDINGS = Path(__file__).parents[2] / "data" / "hid-recordings"


def test_every_answer_is_in_the_profile_and_all_else_is_as_it_was(bench: LearnBench, pad: Pad, rig: Path) -> None:
    bench.answer("PAN RIGHT", pad, RIGHT, REST)
    bench.answer("TILT UP", pad, UP, REST)
    bench.answer("FOCUS FARTHER", pad, TRIGGERS[0], REST)
    bench.answer("FOCUS NEARER", pad, TRIGGERS[1], REST)
    bench.answer("ENABLES", pad, SHOULDER, REST)
    bench.answer("STOP", pad, BUTTON_1, REST)
    assert bench.answer("RECORD", pad, BUTTON_1, REST) == "Button 1 is already in use: choose another"
    bench.answer("RECORD", pad, BUTTON_2, REST)
    bench.answer("RECALL PRESET 1", pad, HAT_UP, REST)
    bench.tried()
    assert rig.read_text() == SIM, "nothing is written before it is accepted"
    bench.turn(0.1, Command.GO)
    assert bench.session.stage is Stage.WRITTEN
    assert (
        rig.read_text()
        == SIM
        + """\
inputs:
  - device: {vendor: 0x046d, product: 0xc216}  # Logitech F310
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
    assert load_profile(str(rig)).inputs[0].enable == "Button 5"


def test_the_trial_shows_what_each_control_does_with_its_sign(bench: LearnBench, pad: Pad) -> None:
    bench.answer("PAN RIGHT", pad, RIGHT, REST)
    bench.answer("TILT UP", pad, UP, REST)
    bench.answer("STOP", pad, BUTTON_1, REST)
    bench.tried()
    pad.report(REST)
    bench.turn(1)
    assert [bench.row(name) for name in ("X", "Y", "Button 1")] == ["pan +0.00", "tilt +0.00", ""]
    pad.report("003f7f7f08000000")
    bench.turn(0.1)
    assert bench.row("X") == "pan -1.00"
    assert float(bench.row("Y").removeprefix("tilt ")) > 0.3, "HID counts down, and up is up"
    pad.report(BUTTON_1)
    bench.turn(0.1)
    assert bench.row("Button 1") == "STOP"
    bench.turn(1.2)
    assert bench.row("Button 1") == ""


def test_a_control_that_goes_the_wrong_way_is_asked_for_again(bench: LearnBench, pad: Pad, rig: Path) -> None:
    bench.answer("PAN RIGHT", pad, LEFT, REST)
    bench.answer("TILT UP", pad, UP, REST)
    bench.tried()
    pad.report(REST)
    bench.turn(1)
    pad.report(RIGHT)
    bench.turn(0.1)
    assert bench.row("X") == "pan -1.00"
    pad.report(REST)
    bench.turn(0.1, Command.RECALL)
    assert bench.session.stage is Stage.QUESTIONS
    bench.asked("PAN RIGHT")
    pad.report(RIGHT)
    bench.turn(0.5)
    pad.report(REST)
    bench.until(lambda: bench.session.stage is Stage.TRIAL, "the trial")
    bench.turn(0.1, Command.GO)
    controls = load_profile(str(rig)).inputs[0].controls
    assert {name: each and (each.axis, each.invert) for name, each in controls.items()} == {
        "Y": ("tilt", True),
        "X": ("pan", False),
    }


def test_of_several_devices_the_one_that_is_moved_is_meant(rig: Path, time: Time, pad: Pad) -> None:
    twin = Pad(time, F310, name="Logitech F310", usage=JOYSTICK, serial="B7")
    twin.report(REST)
    with learning(rig, time, Pads([pad, twin])) as bench:
        bench.answer("PAN RIGHT", twin, RIGHT, REST)
        bench.answer("FOCUS FARTHER", pad, UP, REST)
        bench.tried()
        bench.turn(0.1, Command.GO)
    first, second = load_profile(str(rig)).inputs
    assert (first.device.serial, list(first.controls)) == ("B7", ["X"])
    assert (second.device.serial, list(second.controls)) == (None, ["Y"])


def test_the_device_that_the_profile_names_is_meant_and_no_other(rig: Path, time: Time, pad: Pad) -> None:
    named = Pad(time, F310, name="Logitech F310", usage=JOYSTICK, serial="B7")
    named.report(REST)
    rig.write_text(SIM + "inputs:\n  - {device: {serial: B7}, controls: {Y: {axis: tilt}}}\n")
    with learning(rig, time, Pads([pad, named])) as bench:
        bench.asked("PAN RIGHT")
        pad.report(LEFT, REST)
        bench.turn(2)
        assert "PAN RIGHT" in bench.session.dialogue.page.text
        bench.answer("PAN RIGHT", named, RIGHT, REST)
        bench.tried()
        bench.turn(0.1, Command.GO)
    assert rig.read_text() == SIM + "inputs:\n  - {device: {serial: B7}, controls: {Y: {axis: tilt}, X: {axis: pan}}}\n"


def test_a_profile_whose_device_is_not_there_is_an_error_with_its_cure(rig: Path, time: Time, pad: Pad) -> None:
    rig.write_text(SIM + "inputs:\n  - {device: {serial: B7}}\n")
    with pytest.raises(UsageError, match=r"no device of the profile is plugged in \(serial B7\): plug it in"):
        learning(rig, time, Pads([pad])).__enter__()


def test_a_second_control_of_a_second_collection_is_found_and_loads(rig: Path, time: Time) -> None:
    recording = read_recording(RECORDINGS / "empty-port-of-an-adapter.jsonl")
    rest = bytes([2, *recording.rows[0].report[1:]])
    pushed = {name: report for report in _changed(rest) for name in _pressed(recording.descriptor, report)}
    second = Pad(time, recording.descriptor.hex(), name="Twin", usage=JOYSTICK)
    second.report(rest.hex())
    with learning(rig, time, Pads([second])) as bench:
        for words, name in {"STOP": "joystick 2: Button 1", "PRESET 1": "joystick 2: Hat switch up"}.items():
            bench.answer(words, second, pushed[name].hex(), rest.hex())
        bench.tried()
        bench.turn(0.1, Command.GO)
    controls = load_profile(str(rig)).inputs[0].controls
    assert list(controls) == ["joystick 2: Button 1", "joystick 2: Hat switch"]


def _changed(rest: bytes) -> Iterator[bytes]:
    """The report with each of its bytes another one."""
    for index in range(1, len(rest)):
        for value in range(256):
            yield bytes([*rest[:index], value, *rest[index + 1 :]])


def _pressed(descriptor: bytes, report: bytes) -> list[str]:
    """The one button or direction that is pressed in a report."""
    state = HidState(parse_descriptor(descriptor))
    state.take(report, 0.0)
    on = [name for name, sample in state.values.items() if sample[:3] == (1, 0, 1)]
    return on if len(on) == 1 else []


@pytest.mark.parametrize(
    ("name", "line"),
    [
        ("second-slider", "Slider 2: {axis: pan, by: position}"),
        ("heartbeat-pad", "X: {axis: pan}"),
        ("undescribed-pad-thumb-at-start", "X: {axis: pan}"),
    ],
)
def test_recordings_are_learned_from(name: str, line: str, rig: Path, time: Time) -> None:
    recording = read_recording(RECORDINGS / f"{name}.jsonl")
    with learning(rig, time, RecordedDevices([recording], lambda: time[0], lambda: 0.0)) as bench:
        bench.turn(recording.end + 3)
        bench.tried()
        bench.turn(0.1, Command.GO)
    assert f"      {line}\n" in rig.read_text()


def test_an_unplugged_device_that_was_used_ends_it_and_nothing_is_written(
    bench: LearnBench, pad: Pad, rig: Path
) -> None:
    bench.answer("PAN RIGHT", pad, RIGHT, REST)
    pad.report(None)
    with pytest.raises(DeviceError, match="Logitech F310: unplugged; nothing was written"):
        bench.turn(1)
    assert rig.read_text() == SIM


def test_unplugged_in_the_trial_it_is_the_same(bench: LearnBench, pad: Pad, rig: Path) -> None:
    bench.answer("PAN RIGHT", pad, RIGHT, REST)
    bench.tried()
    bench.turn(0.5)
    pad.report(None)
    with pytest.raises(DeviceError, match="unplugged; nothing was written"):
        bench.turn(1)
    assert rig.read_text() == SIM


def test_leaving_writes_nothing(bench: LearnBench, pad: Pad, rig: Path) -> None:
    bench.answer("PAN RIGHT", pad, RIGHT, REST)
    bench.tried()
    bench.turn(0.1, Command.QUIT)
    assert bench.session.stage is Stage.LEFT
    assert rig.read_text() == SIM


def test_one_question_back(bench: LearnBench, pad: Pad) -> None:
    bench.answer("PAN RIGHT", pad, LEFT, REST)
    bench.asked("TILT UP")
    bench.turn(0.02, Command.PREVIOUS)
    bench.answer("PAN RIGHT", pad, RIGHT, REST)
    (answer,) = bench.session.answers.given
    assert answer.found.towards == 1


def test_enter_while_a_control_is_released_skips_only_what_it_cannot_answer(bench: LearnBench, pad: Pad) -> None:
    for asked, follows in (("PAN RIGHT", "TILT UP"), ("TILT UP", "ROLL CLOCKWISE")):
        bench.asked(asked)
        pad.report(RIGHT)
        bench.turn(0.1)
        bench.turn(0.1, Command.GO)
        pad.report(REST)
        bench.until(lambda: bench.session.dialogue.asks, "the next question")
        assert follows in bench.session.dialogue.page.text
    assert [answer.found.name for answer in bench.session.answers.given] == ["X"]


def test_the_enable_button_of_the_profile_gets_no_other_use(rig: Path, time: Time, pad: Pad) -> None:
    rig.write_text(SIM + "inputs:\n  - {enable: Button 1, controls: {X: {axis: pan}}}\n")
    with learning(rig, time, Pads([pad])) as bench:
        assert bench.answer("STOP", pad, BUTTON_1, REST) == "Button 1 is the enable button: choose another"

"""A control is a field of a report of a collection: no two of a device share a name."""

from __future__ import annotations

import json
from pathlib import Path

from teleop.inputs.hid.descriptor.identity import primary
from teleop.inputs.hid.descriptor.parser import Descriptor, parse_descriptor
from teleop.inputs.hid.descriptor.report import read_report
from teleop.inputs.hid.state import HidState

RECORDINGS = Path(__file__).parents[3] / "data" / "hid-recordings"
MOUSE, KEYBOARD, JOYSTICK, GAMEPAD = (1, 2), (1, 6), (1, 4), (1, 5)


def recorded(name: str) -> Descriptor:
    return parse_descriptor(bytes.fromhex(json.loads((RECORDINGS / name).read_text().splitlines()[0])["descriptor"]))


def test_the_gamepad_of_a_keyboard_mouse_and_gamepad_has_the_bare_names() -> None:
    descriptor = recorded("keyboard-mouse-gamepad.jsonl")
    assert list(descriptor.collections) == [KEYBOARD, MOUSE, GAMEPAD]
    assert descriptor.purpose == GAMEPAD
    names = {field.name: field.report_id for field in descriptor.fields}
    assert len(names) == len(descriptor.fields)
    assert (names["X"], names["mouse: X"], names["Button 1"], names["mouse: Button 1"]) == (4, 2, 4, 2)
    state = HidState(descriptor)
    assert {"X", "Hat switch", "Button 1"} <= state.guessable
    assert not {"mouse: X", "Left shift"} & state.guessable
    assert "mouse: X" in state.relative
    assert "X" not in state.relative


def test_the_second_port_of_an_adapter_is_another_joystick() -> None:
    descriptor = recorded("empty-port-of-an-adapter.jsonl")
    first = {control.name: control.value for control in read_report(descriptor, bytes.fromhex("0180818283080000"))}
    second = {control.name: control.value for control in read_report(descriptor, bytes.fromhex("0200010203080000"))}
    assert {"X", "Y", "Hat switch", "Button 1"} <= first.keys()
    assert not first.keys() & second.keys()
    assert all(name.startswith("joystick 2: ") for name in second)


def test_the_second_control_of_a_usage_has_a_number() -> None:
    names = [field.name for field in recorded("second-slider.jsonl").fields]
    assert names[-2:] == ["Slider", "Slider 2"]
    assert len(names) == len(set(names))


def test_a_guess_takes_the_first_joystick_or_gamepad_and_never_a_mouse() -> None:
    assert primary([MOUSE, KEYBOARD, GAMEPAD, JOYSTICK]) == 2
    assert primary([MOUSE, (0x0C, 1)]) == 1
    assert primary([MOUSE, KEYBOARD]) is None
    assert parse_descriptor(b"").purpose == (0, 0)

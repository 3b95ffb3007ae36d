"""Event codes as HID controls: the names that the same control has by hidraw, and the values it sends."""

from __future__ import annotations

import pytest
from fake_evdev import ABS, KEY, RX, XBOX_BUTTONS, Axis, X, Y, xbox_axes

from teleop.inputs.evdev.layout import REL, Layout
from teleop.inputs.hid.descriptor.parser import parse_descriptor
from teleop.inputs.hid.descriptor.report import Control, read_report

HAT_X, HAT_Y = 16, 17


def controls(layout: Layout, values: dict[tuple[int, int], int]) -> dict[str, Control]:
    descriptor = parse_descriptor(layout.descriptor)
    assert not descriptor.warnings
    return {control.name: control for control in read_report(descriptor, layout.report(values))}


def names(**layout: object) -> set[str]:
    return set(controls(Layout(**{"axes": {}, "keys": (), **layout}), {}))  # type: ignore[arg-type]


def test_an_xbox_pad_has_the_names_of_its_bluetooth_descriptor_for_its_buttons() -> None:
    expected = {f"Button {number}" for number in (1, 2, 4, 5, 7, 8, 11, 12, 13, 14, 15)}
    assert names(axes=xbox_axes(), keys=XBOX_BUTTONS) == expected | {"X", "Y", "Z", "Rx", "Ry", "Rz", "Hat switch"}


def test_a_value_arrives_as_it_was_sent_with_the_range_of_its_axis() -> None:
    layout = Layout(xbox_axes(), XBOX_BUTTONS)
    found = controls(layout, {(ABS, X): -32768, (ABS, Y): 32767, (ABS, 5): 1023, (KEY, 0x131): 1})
    assert (found["X"].value, found["X"].minimum, found["X"].maximum) == (-32768, -32768, 32767)
    assert (found["Y"].value, found["Rz"].value, found["Rz"].minimum, found["Rz"].maximum) == (32767, 1023, 0, 1023)
    assert (found["Button 1"].value, found["Button 2"].value) == (0, 1)


def test_a_value_below_a_range_that_begins_at_0_is_no_full_deflection() -> None:
    assert controls(Layout(xbox_axes(), ()), {(ABS, 2): -5})["Z"].value == 0


@pytest.mark.parametrize(
    ("across", "along", "place"),
    [(0, -1, 0), (1, -1, 1), (1, 0, 2), (1, 1, 3), (0, 1, 4), (-1, 1, 5), (-1, 0, 6), (-1, -1, 7)],
)
def test_a_hat_of_two_axes_is_one_control_with_eight_places(across: int, along: int, place: int) -> None:
    layout = Layout(xbox_axes(), ())
    hat = controls(layout, {(ABS, HAT_X): across, (ABS, HAT_Y): along})["Hat switch"]
    assert (hat.value, hat.null) == (place, False)
    assert controls(layout, {})["Hat switch"].null


def test_a_d_pad_of_four_buttons_is_a_hat_where_a_driver_has_named_it() -> None:
    buttons = [0x130, 0x2C0, 0x2C1, 0x2C2, 0x2C3]  # xpad's left, right, up, down
    layout = Layout({X: Axis(0, -1, 1)}, buttons)
    assert set(controls(layout, {})) == {"X", "Button 1", "Hat switch"}
    places = [controls(layout, {(KEY, code): 1})["Hat switch"].value for code in buttons[1:]]
    assert places == [6, 2, 0, 4]
    kept = Layout({}, [0x220, 0x221, 0x222, 0x223], keeps_names=True)
    assert set(controls(kept, {})) == {"D-pad up", "D-pad down", "D-pad left", "D-pad right"}
    assert controls(kept, {(KEY, 0x222): 1})["D-pad left"].value == 1


def test_the_kernels_codes_of_hid_usages_are_turned_back() -> None:
    """drivers/hid/hid-input.c: usages 0x30 to 0x38 are ABS 0 to 8, accelerator and brake ABS_GAS and ABS_BRAKE."""
    axes = {code: Axis(0, 0, 255) for code in range(11)}
    expected = {"X", "Y", "Z", "Rx", "Ry", "Rz", "Slider", "Dial", "Wheel", "Accelerator", "Brake"}
    assert names(axes=axes, keeps_names=True) == expected
    assert names(axes=axes) == (expected - {"Slider", "Dial", "Wheel"}) | {"Throttle", "Rudder", "Steering"}


def test_a_joysticks_buttons_are_counted_from_its_trigger_on_beyond_sixteen() -> None:
    assert names(keys=[0x120, 0x12F, 0x2C0, 0x2C1], keeps_names=True) == {
        "Button 1", "Button 16", "Button 17", "Button 18"
    }  # fmt: skip


def test_an_elites_paddles_and_share_have_names_on_kernels_before_and_after_6_17() -> None:
    paddles = {f"Button {number}" for number in (1, 21, 22, 23, 24)}
    assert names(keys=[0x130, 0x2C4, 0x2C5, 0x2C6, 0x2C7]) == paddles
    assert names(keys=[0x130, 0x224, 0x225, 0x226, 0x227, 167]) == paddles | {"Record"}


def test_no_two_controls_share_a_name_and_a_keyboards_keys_are_left_out() -> None:
    assert names(keys=[30, 0x120, 0x130]) == {"Button 1", "Button 304"}
    assert names(axes={X: Axis(0, 0, 1)}, wheels=[0, 7]) == {"X", "Dial"}


def test_a_wheel_counts() -> None:
    dial = controls(Layout({}, [0x130], [7]), {(REL, 7): -3})["Dial"]
    assert (dial.value, dial.relative) == (-3, True)


def test_an_axis_that_nothing_names_has_its_code() -> None:
    assert names(axes={0x28: Axis(0, 0, 1), 0x35: Axis(0, 0, 1), RX: Axis(0, 0, 1)}) == {
        "Rx", "Generic desktop 0x1:0x128"
    }  # fmt: skip

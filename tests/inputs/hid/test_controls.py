"""Each kind of control by itself: where mappings do not look, what is lost or said by mistake."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import pytest

from teleop.config.inputs_section import ControlSection
from teleop.core.axes import Axis
from teleop.core.operator_input import Command, Press
from teleop.inputs.hid.controls import Button, ControlReader, ControlValues, Lever, Stick, Wheel
from teleop.inputs.hid.state import Change, Sample


def section(**control: Any) -> ControlSection:
    return ControlSection.model_validate(control)


def look(reader: ControlReader, sample: Sample, *changes: tuple[float, Sample], now: float = 0.0) -> ControlValues:
    values = ControlValues()
    reader.read(sample, [Change(time, "control", each) for time, each in changes], now, False, values)
    return values


def stick(**control: Any) -> Stick:
    return Stick(section(axis="pan", **control), dead_zone=0.0, expo=0.0, guessed=False)


@pytest.mark.parametrize(
    ("rest", "value", "deflection"), [("low", 0, 0), ("low", 255, 1), ("high", 255, 0), ("high", 0, 1)]
)
def test_a_trigger_deflects_from_the_end_where_it_rests(rest: str, value: int, deflection: float) -> None:
    assert look(stick(rest=rest), Sample(value, 0, 255)).deflections == {Axis.PAN: deflection}


def test_a_stick_is_inside_only_while_it_is_off_its_center_and_not_at_an_end() -> None:
    x = stick(center=128)
    inside = []
    for value in (128, 192, 255, 192):
        look(x, Sample(value, 0, 255))
        inside.append(x.is_inside)
    assert inside == [False, True, False, True]
    look(x, Sample(192, 0, 255, null=True))
    assert not x.is_inside


def test_controls_of_one_axis_add_up_to_full_deflection_at_most() -> None:
    values = ControlValues()
    for deflection in (0.75, 0.75):
        values.deflect(section(axis="pan"), deflection)
    values.deflect(section(axis="tilt", speed=0.5, invert=True), 1.0)
    values.deflect(section(dial=True), -3.0)
    assert (values.deflections, values.dial) == ({Axis.PAN: 1, Axis.TILT: -0.5}, -1)


def test_an_inverted_lever_is_measured_from_its_other_end() -> None:
    lever = Lever(section(axis="focus", by="position", invert=True, range=[0, 200]))
    assert look(lever, Sample(50, 0, 255)).positions == {Axis.FOCUS: 0.75}
    assert look(lever, Sample(200, 0, 255)).positions == {Axis.FOCUS: 0}
    assert look(lever, Sample(50, 0, 255, null=True)).positions == {}


def counter() -> Wheel:
    return Wheel(section(axis="pan", value_type="counter", coarse=1), counter=True)


def count(value: float, null: bool = False) -> Sample:
    return Sample(value, 0, 15, null=null)


@pytest.mark.parametrize("first", [count(3), count(0, null=True)])
def test_a_counter_without_a_value_for_a_while_makes_no_clicks_of_it(first: Sample) -> None:
    wheel = counter()
    look(wheel, first)
    look(wheel, count(3), (0.1, count(3)))
    assert look(wheel, count(9, null=True), (0.2, count(9, null=True))).steps == {Axis.PAN: 0}
    assert look(wheel, count(4), (0.3, count(4))).steps == {Axis.PAN: 1}


def test_a_counter_whose_first_value_comes_late_begins_there() -> None:
    wheel = counter()
    look(wheel, count(0, null=True))
    assert look(wheel, count(5), (0.1, count(5))).steps == {Axis.PAN: 0}


def buttons(*presses: tuple[float, int]) -> Sequence[tuple[float, Sample]]:
    return [(time, Sample(pressed, 0, 1)) for time, pressed in presses]


def test_a_button_that_is_held_asks_once_while_it_is_still_down() -> None:
    button = Button(section(press="recall", hold="store", number=2))
    look(button, Sample(0, 0, 1))
    assert look(button, Sample(1, 0, 1), *buttons((1.0, 1)), now=1.0).presses == []
    assert look(button, Sample(1, 0, 1), now=1.99).presses == []
    assert look(button, Sample(1, 0, 1), now=2.0).presses == [Press(Command.STORE, 2)]
    assert look(button, Sample(1, 0, 1), now=3.5).presses == []
    assert look(button, Sample(0, 0, 1), *buttons((4.0, 0)), now=4.0).presses == []

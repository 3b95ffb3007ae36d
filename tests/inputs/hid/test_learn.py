"""Learning a mapping: which control was meant, and what the profile then says. Values as devices report them."""

import itertools
from collections.abc import Mapping, Sequence

import pytest

from teleop.config.inputs_section import ControlSection
from teleop.core.axes import Axis
from teleop.inputs.hid.learn import Found, Kind, Watch, still
from teleop.inputs.hid.state import Change, Sample


def byte(value: float) -> Sample:
    return Sample(value, 0, 255)


OFF, ON = Sample(0, 0, 1), Sample(1, 0, 1)
REST = {
    "X": byte(128),
    "Y": byte(127),
    "Rx": byte(0),
    "Button 7": OFF,
    "Hat switch": Sample(8, 0, 7),
    "Hat switch up": OFF,
}


def answer(smooth: bool, *looks: Mapping[str, Sample], rest: Mapping[str, Sample] = REST) -> Found | None:
    """What is meant after these looks, a tenth of a second apart, the last of them for a second."""
    watch = Watch(rest, smooth)
    last = itertools.repeat(looks[-1], 10)
    found = (watch.see({**rest, **look}, (), at * 0.1) for at, look in enumerate((*looks, *last)))
    return next((each for each in found if each), None)


def test_the_control_that_moves_the_furthest_is_meant_and_its_way() -> None:
    assert answer(True, {"X": byte(150)}, {"X": byte(255), "Y": byte(90)}) == Found("X", Kind.STICK, 1)
    assert answer(True, {"X": byte(190), "Y": byte(0)}) == Found("Y", Kind.STICK, -1)


def test_less_than_half_a_push_is_not_meant() -> None:
    assert answer(True, {"X": byte(180), "Y": byte(60)}) is None


def test_a_trigger_with_a_button_beside_it_is_meant_as_a_trigger_for_an_axis_and_as_a_button_for_a_press() -> None:
    looks = ({"Button 7": ON, "Rx": byte(20)}, {"Button 7": ON, "Rx": byte(255)})
    assert answer(True, *looks) == Found("Rx", Kind.TRIGGER, 1)
    assert answer(False, *looks) == Found("Button 7", Kind.BUTTON, 1)


def test_a_button_for_an_axis_and_a_trigger_for_a_press_are_taken_after_a_moment() -> None:
    assert answer(True, {"Hat switch": Sample(0, 0, 7), "Hat switch up": ON}) == Found("Hat switch up", Kind.BUTTON, 1)
    assert answer(False, {"Rx": byte(255)}) == Found("Rx", Kind.TRIGGER, 1)


def test_a_control_that_has_not_reported_before_is_at_rest_when_it_does() -> None:
    assert answer(False, {"Button 2": ON}, rest={}) == Found("Button 2", Kind.BUTTON, 1)
    assert answer(True, {"X": byte(130)}, {"X": byte(0)}, rest={}) == Found("X", Kind.STICK, -1)


def test_three_clicks_of_a_wheel_are_meant() -> None:
    watch = Watch({}, smooth=True)
    dial = Sample(-1, -127, 127, relative=True)
    click: Sequence[Change] = [Change(0, "Dial", dial)]
    assert watch.see({"Dial": dial}, click, 0) is None
    assert watch.see({"Dial": dial}, click, 1) is None
    assert watch.see({"Dial": dial}, click, 2) == Found("Dial", Kind.WHEEL, -1)


def test_what_stays_where_it_was_put_is_a_lever() -> None:
    watch = Watch(REST, smooth=True)
    found = watch.see({**REST, "Rx": byte(255)}, (), 0)
    assert found is not None
    assert watch.settled(found, {**REST, "Rx": byte(10)}) == found
    assert watch.settled(found, {**REST, "Rx": byte(250)}).kind is Kind.LEVER


def test_everything_is_still_when_nothing_moves_and_no_button_is_held() -> None:
    assert still(REST, {**REST, "X": byte(131), "Hat switch": Sample(2, 0, 7)})
    assert not still(REST, {**REST, "X": byte(140)})
    assert not still(REST, {**REST, "Button 7": ON})


def test_a_switch_that_is_on_rests_and_only_its_next_press_is_meant() -> None:
    switched = {**REST, "Button 7": ON}
    assert not still(switched, switched)
    assert still(switched, switched, switches=True)
    assert answer(False, switched, REST, rest=switched) is None
    assert answer(False, REST, switched, rest=switched) == Found("Button 7", Kind.BUTTON, 1)


def test_a_stick_that_was_held_and_is_released_has_not_answered() -> None:
    held = {**REST, "X": byte(255)}
    watch = Watch(held, smooth=True)
    found = watch.see(REST, (), 0)
    assert found is not None
    assert watch.was_released(found, REST)
    pushed = Watch(REST, smooth=True)
    assert not pushed.was_released(found, REST)
    assert not pushed.was_released(found, held)


@pytest.mark.parametrize("name", ["Dial", "joystick 2: Dial", "Wheel 2"])
def test_a_wheel_that_sends_a_number_that_runs_on_is_a_counter(name: str) -> None:
    looks = [{name: byte(value)} for value in (254, 255, 0, 1)]
    assert answer(True, *looks[1:], rest=looks[0]) == Found(name, Kind.COUNTER, 1)
    assert answer(True, *looks, rest={}) == Found(name, Kind.COUNTER, 1), "one that reports only changes"


def test_a_steering_wheel_is_a_stick() -> None:
    looks = [{"Wheel": byte(value)} for value in (140, 170, 255)]
    assert answer(True, *looks, rest={"Wheel": byte(128)}) == Found("Wheel", Kind.STICK, 1)


def test_what_a_shipped_mapping_says_of_a_control_counts() -> None:
    known = {"Wheel": ControlSection(axis=Axis.PAN, value_type="absolute", range=[-7, 7])}
    watch = Watch({"Wheel": Sample(0, -128, 127)}, smooth=True, known=known)
    assert watch.see({"Wheel": Sample(6, -128, 127)}, (), 0) == Found("Wheel", Kind.STICK, 1)
    counter = {"Dial": ControlSection(axis=Axis.FOCUS, value_type="counter")}
    watch = Watch({"Dial": byte(200)}, smooth=True, known=counter)
    assert watch.see({"Dial": byte(197)}, (), 0) == Found("Dial", Kind.COUNTER, -1)

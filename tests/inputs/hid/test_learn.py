"""Learning a mapping: which control was meant, and what the profile then says. Values as devices report them."""

import itertools
from collections.abc import Mapping, Sequence
from pathlib import Path

import pytest

from teleop.config.documents.yaml_loader import read_document
from teleop.config.inputs_section import InputSection, input_rules
from teleop.core.axes import Axis
from teleop.core.operator_input import Command
from teleop.inputs.hid.descriptor.names import USAGES
from teleop.inputs.hid.learn import Found, Kind, Learned, Question, Watch, other_way, questions, still
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


def test_the_rigs_axes_are_asked_for_and_a_way_back_where_one_is_needed() -> None:
    asked = questions([Axis.PAN, Axis.FOCUS])
    assert [question.axis for question in asked if question.axis] == [Axis.PAN, Axis.FOCUS]
    assert asked[0].text == "Move the control for: pan right"
    assert other_way(asked[1]).text == "Move the control for: focus nearer"
    assert {question.press for question in asked} >= {Command.STOP, Command.CLEAR, Command.RECALL}
    assert asked[-1].enable


def test_the_answers_become_the_inputs_of_a_profile() -> None:
    pan, tilt, focus = (Question("", axis=axis) for axis in (Axis.PAN, Axis.TILT, Axis.FOCUS))
    learned = Learned()
    learned.add(pan, Found("X", Kind.STICK, 1))
    learned.add(tilt, Found("Y", Kind.STICK, -1))
    learned.add(focus, Found("Ry", Kind.TRIGGER, 1))
    learned.add(focus, Found("Rx", Kind.TRIGGER, 1), back=True)
    learned.add(Question("", axis=Axis.ROLL), Found("Slider", Kind.LEVER, -1))
    learned.add(Question("", press=Command.RECALL, number=2), Found("Hat switch up", Kind.BUTTON, 1))
    learned.add(Question("", press=Command.STOP), Found("Button 1", Kind.BUTTON, 1))
    learned.add(Question("", enable=True), Found("Button 5", Kind.BUTTON, 1))
    assert learned.has("Button 5")
    assert learned.has("Hat switch up")
    assert (
        learned.text(0x54C, 0x9CC, "Wireless Controller")
        == """\
inputs:   # Wireless Controller
  - device: {vendor: 0x054c, product: 0x09cc}
    enable: Button 5
    controls:
      X: {axis: pan}
      Y: {axis: tilt, invert: true}
      Ry: {axis: focus, rest: low}
      Rx: {axis: focus, rest: low, invert: true}
      Slider: {axis: roll, by: position, invert: true}
      Hat switch:
        up: {press: recall, number: 2, hold: store}
      Button 1: {press: stop}
"""
    )


def test_whatever_a_control_is_called_the_profile_holds_that_name(tmp_path: Path) -> None:
    names = [name for usages in USAGES.values() for name in usages.values() if name != "Hat switch"]
    learned = Learned()
    for name in names:
        learned.add(Question("", axis=Axis.PAN), Found(name, Kind.STICK, 1))
    learned.add(Question("", enable=True), Found("Key non-US #", Kind.BUTTON, 1))
    file = tmp_path / "inputs.yaml"
    file.write_text(learned.text(1, 2, "A keyboard"))
    (section,) = read_document(file).data["inputs"]
    assert list(section["controls"]) == names
    assert section["enable"] == "Key non-US #"


kinds = [Found("A", kind, towards) for kind in Kind for towards in (1, -1)]


@pytest.mark.parametrize("found", kinds, ids=lambda found: f"{found.kind.value} {found.towards}")
@pytest.mark.parametrize("back", [False, True])
def test_every_answer_is_one_that_a_profile_may_hold(found: Found, back: bool) -> None:
    learned = Learned()
    learned.add(Question("", axis=Axis.PAN), found, back)
    section = {"controls": dict(learned.nested())}
    assert list(input_rules({"axes": {"pan": {}}, "inputs": [section]})) == []
    InputSection.model_validate(section)

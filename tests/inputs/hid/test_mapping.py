"""Mappings: what controls say, by the values they report; never beyond full, never a click or a press lost."""

from collections.abc import Mapping, Sequence
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from teleop.config.inputs_section import ControlSection
from teleop.core.axes import Axis
from teleop.core.events import DeviceCommand
from teleop.core.operator_input import Command, Held, Press
from teleop.inputs.hid.mapping import Mapped
from teleop.inputs.hid.state import Change, Sample


def mapped(controls: Mapping[str, Any], **more: Any) -> Mapped:
    sections = {name: ControlSection.model_validate(control) for name, control in controls.items()}
    return Mapped(sections, **more)


def byte(value: float) -> Sample:
    return Sample(value, 0, 255)


def button(pressed: bool) -> Sample:
    return Sample(int(pressed), 0, 1)


def settled(mapping: Mapped, rest: Mapping[str, Sample]) -> Mapped:
    """After its sticks have lain still for as long as it takes to find their centres."""
    for index in range(40):
        mapping.read(rest, (), index * 0.01)
    assert not mapping.finding
    return mapping


def changes(name: str, *samples: tuple[float, Sample]) -> Sequence[Change]:
    return [Change(time, name, sample) for time, sample in samples]


def look(mapping: Mapped, at: float = 1.0, **values: Sample) -> Held:
    return mapping.read(values, (), at)


def test_a_stick_moves_its_axis_from_where_it_rests_to_its_ends() -> None:
    stick = settled(mapped({"X": {"axis": "pan"}, "Y": {"axis": "tilt", "invert": True}}), {"X": byte(131)})
    assert look(stick, X=byte(131), Y=byte(127)).deflections[Axis.PAN] == 0
    assert look(stick, X=byte(255)).deflections[Axis.PAN] == 1
    assert look(stick, X=byte(0)).deflections[Axis.PAN] == -1


def test_up_is_up_when_inverted_and_two_axes_are_swapped_by_their_names() -> None:
    rest = {"X": byte(128), "Y": byte(128)}
    stick = settled(mapped({"X": {"axis": "tilt", "invert": True}, "Y": {"axis": "pan"}}), rest)
    assert look(stick, X=byte(0), Y=byte(255)).deflections == {Axis.TILT: 1, Axis.PAN: 1}


def test_dead_zone_expo_and_speed_are_the_controls_own_or_the_devices() -> None:
    rest = {"X": byte(127.5), "Y": byte(127.5)}
    controls = {"X": {"axis": "pan", "dead_zone": 0, "expo": 0, "speed": 0.5}, "Y": {"axis": "tilt"}}
    stick = settled(mapped(controls, dead_zone=0.06, expo=0.4), rest)
    held = look(stick, X=byte(127.5 * 1.5), Y=byte(127.5 * 1.53)).deflections
    assert held[Axis.PAN] == pytest.approx(0.25)
    assert held[Axis.TILT] == pytest.approx(0.6 * 0.5 + 0.4 * 0.125)
    assert look(stick, X=byte(127.5), Y=byte(127.5 * 1.05)).deflections[Axis.TILT] == 0


def test_nothing_is_said_of_a_stick_while_its_centre_is_found_and_of_one_without_a_value() -> None:
    stick = mapped({"X": {"axis": "pan"}})
    assert look(stick, at=0, X=byte(0)).deflections == {}
    assert stick.finding
    settled(stick, {"X": byte(0)})
    assert look(stick, X=Sample(300, 0, 255, null=True)).deflections == {}
    assert look(stick).deflections == {}


def test_a_stick_that_is_held_when_first_seen_counts_from_the_middle_unless_the_mapping_is_a_guess() -> None:
    held = settled(mapped({"X": {"axis": "pan"}}), {"X": byte(255)})
    assert look(held, X=byte(255)).deflections == {Axis.PAN: 1}
    assert list(held.uncentered) == ["X"]
    guessed = settled(mapped({"X": {"axis": "pan"}}, guessed=True), {"X": byte(255)})
    assert look(guessed, X=byte(255)).deflections == {}


def test_two_triggers_move_one_axis_each_its_way() -> None:
    controls = {"Rx": {"axis": "focus", "rest": "low", "invert": True}, "Ry": {"axis": "focus", "rest": "low"}}
    triggers = mapped(controls)
    assert look(triggers, Rx=byte(0), Ry=byte(0)).deflections == {Axis.FOCUS: 0}
    assert look(triggers, Rx=byte(255), Ry=byte(0)).deflections == {Axis.FOCUS: -1}
    assert look(triggers, Rx=byte(0), Ry=byte(255)).deflections == {Axis.FOCUS: 1}
    assert look(triggers, Rx=byte(255), Ry=byte(255)).deflections == {Axis.FOCUS: 0}


def test_a_range_in_the_devices_numbers_replaces_its_own() -> None:
    ring = mapped({"Wheel": {"axis": "pan", "range": [-7, 7], "center": 0}})
    assert look(ring, Wheel=Sample(-7, -128, 127)).deflections == {Axis.PAN: -1}
    assert look(ring, Wheel=Sample(0, -128, 127)).deflections == {Axis.PAN: 0}


def test_a_slider_is_where_it_was_first_seen_until_it_has_been_moved() -> None:
    slider = mapped({"Slider": {"axis": "focus", "by": "position"}})
    assert look(slider, Slider=byte(51)).positions == {Axis.FOCUS: 0.2}
    assert look(slider, Slider=byte(52)).positions == {Axis.FOCUS: 0.2}
    assert look(slider, Slider=byte(102)).positions == {Axis.FOCUS: 0.4}
    assert look(slider, Slider=byte(51)).positions == {Axis.FOCUS: 0.2}


def clicks(*counts: float) -> Sequence[Change]:
    return changes("Dial", *((1.0, Sample(count, -127, 127, relative=True)) for count in counts))


def test_every_click_of_a_wheel_moves_its_axis_on() -> None:
    dial = mapped(
        {"Dial": {"axis": "focus", "coarse": 0.01, "fine": 0.001, "fine_button": "Button 1"}}, relative=["Dial"]
    )
    values = {"Dial": Sample(1, -127, 127, relative=True), "Button 1": button(False)}
    assert dial.read(values, clicks(1, 1, -3), 1).steps == {Axis.FOCUS: pytest.approx(-0.01)}
    assert dial.read(values, (), 1.01).steps == {Axis.FOCUS: 0}
    fine = {**values, "Button 1": button(True)}
    assert dial.read(fine, clicks(2), 1.02).steps == {Axis.FOCUS: pytest.approx(0.002)}
    assert {"Dial"} == dial.watched
    assert {"Dial", "Button 1"} == dial.names


def test_a_wheel_by_rate_deflects_by_clicks_per_second_and_stops_with_them() -> None:
    wheel = mapped(
        {"Dial": {"axis": "pan", "by": "rate", "coarse": 0.05}, "Wheel": {"dial": True}}, relative=["Dial", "Wheel"]
    )
    values = {"Dial": Sample(0, -127, 127, relative=True)}
    assert wheel.read(values, clicks(2), 1).deflections == {Axis.PAN: pytest.approx(0.05 * 2 / 0.25)}
    assert wheel.read(values, (), 1.24).deflections == {Axis.PAN: pytest.approx(0.4)}
    assert wheel.read(values, (), 1.26).deflections == {Axis.PAN: 0}
    assert wheel.read(values, clicks(100), 1.2).deflections == {Axis.PAN: 1}


def test_a_wheel_or_a_stick_may_be_the_gimbals_dial() -> None:
    wheel = mapped({"Dial": {"dial": True, "invert": True}}, relative=["Dial"])
    held = wheel.read({"Dial": Sample(0, -1, 1, relative=True)}, clicks(1, 1), 1)
    assert held.dial == pytest.approx(-0.05 * 2 / 0.25)
    assert held.deflections == {}
    ring = mapped({"Wheel": {"dial": True, "center": 0, "coarse": 0.5}})
    assert look(ring, Wheel=Sample(127, -127, 127)).dial == 0.5


@given(st.lists(st.integers(-100, 100), max_size=20), st.integers(0, 255))
def test_a_running_counter_gives_the_clicks_between_its_numbers(turns: list[int], at: int) -> None:
    jog = mapped({"Dial": {"axis": "pan", "value_type": "counter", "coarse": 1}}, relative=["Dial"])
    jog.read({"Dial": byte(at)}, (), 0)
    total = 0.0
    for turn in turns:
        at = (at + turn) % 256
        total += jog.read({"Dial": byte(at)}, changes("Dial", (1.0, byte(at))), 1).steps[Axis.PAN]
    assert total == sum(turns)
    assert jog.counting == {"Dial": False}


def test_a_button_asks_when_it_is_pressed_even_between_two_looks() -> None:
    record = mapped({"Button 1": {"press": "record"}})
    assert record.read({"Button 1": button(False)}, (), 0).presses == []
    tapped = changes("Button 1", (0.001, button(True)), (0.002, button(False)), (0.003, button(True)))
    assert record.read({"Button 1": button(True)}, tapped, 0.01).presses == [Press(Command.RECORD)] * 2
    assert record.read({"Button 1": button(True)}, (), 0.02).presses == []


def test_a_button_that_was_down_when_first_seen_has_not_been_pressed() -> None:
    stop = mapped({"Button 1": {"press": "stop"}})
    assert stop.read({"Button 1": button(True)}, (), 0).presses == []
    late = mapped({"Button 1": {"press": "stop"}})
    assert late.read({"Button 1": button(False)}, changes("Button 1", (0, button(False))), 0).presses == []


@pytest.mark.parametrize(
    ("released", "looks", "asked"),
    [(0.5, [0.3, 0.6], ["recall"]), (1.5, [0.3, 1.05, 1.6], ["store"]), (1.5, [1.6], ["store"])],
)
def test_a_preset_is_recalled_by_a_press_and_stored_by_a_second_of_it(
    released: float, looks: list[float], asked: list[str]
) -> None:
    preset = mapped({"Button 1": {"press": "recall", "number": 3, "hold": "store"}})
    preset.read({"Button 1": button(False)}, (), -1)
    pending = list(changes("Button 1", (0.0, button(True)), (released, button(False))))
    presses: list[Press] = []
    for now in looks:
        due = [change for change in pending if change.time <= now]
        pending = pending[len(due) :]
        presses += preset.read({"Button 1": button(bool(pending))}, due, now).presses
    assert presses == [Press(Command(word), 3) for word in asked]


def test_directions_of_a_hat_press_or_nudge() -> None:
    hat = mapped(
        {
            "Hat switch": {
                "up": {"axis": "tilt", "speed": 0.2},
                "down": {"axis": "tilt", "speed": 0.2, "invert": True},
                "left": {"press": "tell", "command": "gimbal follow lock"},
            }
        }
    )
    assert hat.names == {"Hat switch up", "Hat switch down", "Hat switch left"}
    values = {name: button(False) for name in hat.names}
    assert hat.read(values, (), 0).deflections == {Axis.TILT: 0}
    assert hat.read({**values, "Hat switch up": button(True)}, (), 1).deflections == {Axis.TILT: 0.2}
    assert hat.read({**values, "Hat switch down": button(True)}, (), 2).deflections == {Axis.TILT: -0.2}
    told = hat.read(values, changes("Hat switch left", (3, button(True))), 3)
    assert told.presses == [Press(Command.TELL, device_command=DeviceCommand("gimbal", "follow lock"))]


def test_the_enable_button_is_held_or_not_and_none_without_one() -> None:
    assert look(mapped({}), X=byte(0)).enabled is None
    guarded = mapped({}, enable="Button 5")
    assert look(guarded).enabled is False
    assert guarded.read({"Button 5": button(True)}, (), 0).enabled is True


controls = st.fixed_dictionaries(
    {"axis": st.sampled_from([axis.value for axis in Axis])},
    optional={
        "invert": st.booleans(),
        "dead_zone": st.floats(0, 0.3),
        "expo": st.floats(0, 0.75),
        "speed": st.floats(0.01, 1),
        "rest": st.sampled_from(["low", "middle", "high"]),
        "range": st.lists(st.floats(-1e6, 1e6), min_size=2, max_size=2),
        "center": st.floats(-1e6, 1e6),
        "coarse": st.floats(1e-3, 1e3),
        "by": st.sampled_from(["rate", "position"]),
        "value_type": st.sampled_from(["absolute", "relative", "counter"]),
    },
)
samples = st.builds(Sample, st.integers(-70000, 70000), st.integers(-40000, 0), st.integers(0, 70000))


@given(
    st.dictionaries(st.sampled_from(["X", "Y", "Z"]), controls, min_size=1), st.lists(samples, min_size=1, max_size=9)
)
def test_no_mapping_says_more_than_full(sections: Mapping[str, Any], reported: list[Sample]) -> None:
    mapping = mapped(sections)
    for index, sample in enumerate(reported):
        now = index * 0.2
        said = [Change(now, name, sample) for name in sections]
        held = mapping.read(dict.fromkeys(sections, sample), said, now)
        assert all(-1 <= deflection <= 1 for deflection in held.deflections.values())
        assert all(0 <= position <= 1 for position in held.positions.values())
        assert -1 <= held.dial <= 1


def test_where_a_stick_is_counts_as_no_clicks() -> None:
    wheel = mapped({"X": {"axis": "pan", "by": "position"}}, relative=["X"])
    assert not wheel.read({"X": byte(200)}, changes("X", (1.0, byte(200))), 1.0).steps[Axis.PAN]


def test_a_puck_rests_at_zero() -> None:
    puck = Mapped({"Rz": ControlSection(axis=Axis.PAN)}, puck=True)
    held = puck.read({"Rz": Sample(70, -350, 350)}, (), 0.0)
    assert held.deflections == {Axis.PAN: pytest.approx(0.2)}
    assert not puck.finding
    assert puck.read({"Rz": Sample(0, -350, 350)}, (), 1.0).deflections == {Axis.PAN: 0}


def test_a_guessed_trigger_that_is_held_at_the_start_never_becomes_a_stick() -> None:
    guessed = mapped({"Rx": {"axis": "roll"}, "Ry": {"axis": "focus"}}, guessed=True)
    for index in range(60):
        guessed.read({"Rx": byte(0), "Ry": byte(255)}, (), index / 100)
    for index in range(60, 120):
        assert not guessed.read({"Rx": byte(0), "Ry": byte(128)}, (), index / 100).deflections
    assert not guessed.read({"Rx": byte(0), "Ry": byte(0)}, (), 2.0).deflections


def test_what_each_control_asks_for_adds_up_to_what_all_do() -> None:
    controls = {
        "X": {"axis": "pan"},
        "Z": {"axis": "pan", "rest": "low"},
        "Dial": {"axis": "focus", "coarse": 0.01},
        "Slider": {"axis": "roll", "by": "position"},
        "Wheel": {"dial": True},
        "Button 1": {"press": "stop"},
    }
    values = {"X": byte(128), "Z": byte(0), "Slider": byte(9), "Button 1": button(False)}
    clicks = [Change(1.0, name, Sample(2, -127, 127, relative=True)) for name in ("Dial", "Wheel")]
    seen = [*clicks, *changes("Button 1", (1.0, button(True)))]
    moved = {**values, "X": byte(200), "Z": byte(90), **{change.name: change.sample for change in seen}}
    together, apart = (settled(mapped(controls, relative={"Dial", "Wheel"}), values) for _ in range(2))
    apart.each = {}
    expected = together.read(moved, seen, 1.0)
    assert apart.read(moved, seen, 1.0) == expected
    assert expected.deflections[Axis.PAN] > apart.each["X"].deflections[Axis.PAN] > 0
    assert {name: each.presses for name, each in apart.each.items() if each.presses} == {
        "Button 1": [Press(Command.STOP)]
    }


def test_two_deflections_that_cancel_each_other_out_are_no_rest() -> None:
    triggers = mapped({"Z": {"axis": "focus", "rest": "low", "invert": True}, "Rz": {"axis": "focus", "rest": "low"}})
    both = look(triggers, Z=byte(128), Rz=byte(128))
    assert both.deflections == {Axis.FOCUS: 0}
    assert both.deflected
    assert not look(triggers, Z=byte(0), Rz=byte(0)).deflected


def test_a_stick_that_comes_later_than_the_first_report_has_to_be_seen_at_rest() -> None:
    puck = mapped({"Rz": {"axis": "pan", "center": 0}, "Rx": {"axis": "tilt", "center": 0}})
    look(puck, Rx=Sample(300, -350, 350))
    assert not puck.is_unrested, "the interlock waits for what is in the first report"
    look(puck, Rx=Sample(0, -350, 350), Rz=Sample(350, -350, 350))
    assert puck.is_unrested
    look(puck, Rx=Sample(0, -350, 350), Rz=Sample(0, -350, 350))
    look(puck, Rx=Sample(0, -350, 350), Rz=Sample(350, -350, 350))
    assert not puck.is_unrested

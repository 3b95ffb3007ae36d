"""The `inputs:` of a profile: what is refused, and where it is said to stand."""

from pathlib import Path

import pytest

from teleop.config.documents.document import DocumentError
from teleop.config.profile import Profile, load_profile
from teleop.core.operator_input import Command

RIG = """\
name: Test rig
links: {gimbal: "virtual:test"}
axes:
  pan:  {min: null, max: null, velocity: 120, acceleration: 240, jerk: 1200}
  tilt: {min: -56, max: 146, velocity: 90, acceleration: 180, jerk: 900}
sinks:
  - {type: gimbal, link: gimbal, mode: position, rate: 50}
"""


def rig(tmp_path: Path, inputs: str) -> Profile:
    file = tmp_path / "rig.yaml"
    file.write_text(RIG + inputs)
    return load_profile(str(file))


def problems(tmp_path: Path, inputs: str) -> list[str]:
    with pytest.raises(DocumentError) as caught:
        rig(tmp_path, inputs)
    return [problem.removeprefix(f"{tmp_path}/rig.yaml:") for problem in caught.value.problems]


def test_a_rig_may_have_several_inputs_in_their_order(tmp_path: Path) -> None:
    profile = rig(
        tmp_path,
        """\
inputs:
  - device: {vendor: 0x054c, product: 0x09cc}
    pad: dualshock4
    enable: Button 5
    reports: continuous
    controls:
      X: {axis: tilt, invert: true, dead_zone: 0.1, expo: 0.5, range: [0, 255], speed: 0.5}
      Button 2: null
      Button 5: null
      Button 7: {press: tell, command: gimbal follow lock}
      Hat switch:
        up: {press: recall, number: 1, hold: store}
        down: {axis: tilt, speed: 0.2, invert: true}
  - device: any
  - {device: {name: "*Dial*"}, controls: {Dial: {axis: pan, by: rate, coarse: 0.1}, Wheel: {dial: true}}}
""",
    )
    first, second, third = profile.inputs
    assert (first.device.vendor, first.device.product, first.enable) == (0x54C, 0x9CC, "Button 5")
    assert first.controls["Button 2"] is None
    up = first.controls["Hat switch"].up  # type: ignore[union-attr]  # it is there
    assert up is not None
    assert (up.press, up.number, up.hold) == (Command.RECALL, 1, Command.STORE)
    assert second.device.any
    assert str(third.device) == "*Dial*"


def test_a_rig_without_inputs_has_none(tmp_path: Path) -> None:
    assert rig(tmp_path, "").inputs == []


@pytest.mark.parametrize(
    ("section", "column", "problem"),
    [
        (
            "{controls: {X: {axis: roll}}}",
            27,
            "controls.X.axis is roll, which this rig does not have; it has pan, tilt",
        ),
        (
            "{controls: {X: {axs: pan}}}",
            21,
            "controls.X: unknown key `axs`; did you mean `axis`?",
        ),
        (
            "{controls: {X: {}}}",
            20,
            "controls.X needs an axis, a press, or dial: true; null leaves it out",
        ),
        (
            "{controls: {X: {invert: true}}}",
            20,
            "controls.X needs an axis, a press, or dial: true; null leaves it out",
        ),
        (
            "{controls: {X: {axis: pan, press: stop}}}",
            20,
            "controls.X can do one thing, not axis and press",
        ),
        (
            "{controls: {X: {press: halt}}}",
            28,
            "controls.X.press must be one of stop, clear, enable, slower, faster, range, recall, "
            "store, delete, recenter, record, shutter, tell, engage, disengage, quit, pause, next, previous, go, keep, "
            "not 'halt'",
        ),
        (
            "{controls: {X: {press: recall}}}",
            20,
            "controls.X needs a number: which preset to recall",
        ),
        (
            "{controls: {X: {press: stop, number: 1}}}",
            42,
            "controls.X.number is for recall, store and delete",
        ),
        (
            "{controls: {X: {press: tell}}}",
            20,
            "controls.X needs a command: gimbal follow lock",
        ),
        (
            "{controls: {X: {press: stop, command: hm}}}",
            43,
            "controls.X.command is for tell",
        ),
        (
            "{controls: {X: {press: tell, command: gimbal folow lock}}}",
            43,
            "controls.X.command: unknown command gimbal folow lock; did you mean gimbal follow lock?",
        ),
        (
            "{controls: {H: {up: {press: store}}}}",
            25,
            "controls.H.up needs a number: which preset to store",
        ),
        (
            "{controls: {X: {axis: pan, hold: stop}}}",
            38,
            "controls.X.hold needs a press beside it, for a short press",
        ),
        (
            "{controls: {X: {axis: pan, dead_zone: 0.5}}}",
            43,
            "controls.X.dead_zone must be at most 0.3",
        ),
        (
            "{controls: {X: {axis: pan, range: [7, 7]}}}",
            39,
            "controls.X.range must have two different ends",
        ),
        (
            "{controls: {X: {axis: pan, fine: 0.1}}}",
            38,
            "controls.X.fine needs a fine_button",
        ),
        (
            "{device: {}}",
            14,
            "device must be any, or have a vendor and product, or a name",
        ),
        (
            "{device: {product: 3}}",
            24,
            "device.product needs a vendor beside it",
        ),
        (
            "{device: all}",
            14,
            "device must be a mapping, not 'all'",
        ),
        (
            "{pad: dualshock}",
            11,
            "pad must be a mapping that exists: dualshock: no pad of that name is shipped; did you "
            "mean dualshock4?; a file needs its ending, dualshock.yaml",
        ),
        (
            "{reports: sometimes}",
            15,
            "reports must be one of auto, continuous, on-change, not 'sometimes'",
        ),
    ],
)
def test_what_is_wrong_is_said_where_it_stands(tmp_path: Path, section: str, column: int, problem: str) -> None:
    assert problems(tmp_path, f"inputs:\n  - {section}\n") == [f"9:{column}: inputs[0].{problem}"]


def test_all_of_it_comes_at_once(tmp_path: Path) -> None:
    found = problems(
        tmp_path, "inputs:\n  - {device: {}, pad: nix}\n  - {controls: {X: {press: store}, Y: {axis: 3}}}\n"
    )
    assert [problem.split(":")[0] for problem in found] == ["9", "9", "10", "10"]


@pytest.mark.parametrize(
    "inputs",
    ["3", "[3]", "[{controls: 7}]", "[{controls: {X: [1]}}]", "[{controls: {X: {press: [1], axis: {}}}}]"],
)
def test_what_has_another_shape_is_an_error_and_no_exception(tmp_path: Path, inputs: str) -> None:
    assert problems(tmp_path, f"inputs: {inputs}\n")


DRONE = """
  stick_pitch: {min: -1, max: 1, velocity: 4, acceleration: 20, jerk: 200}
sinks:
  - {type: gimbal, link: gimbal, mode: position, rate: 50}
  - {type: virtual-rc, link: drone}
"""


@pytest.mark.parametrize(
    ("control", "problem"),
    [
        ("{press: engage}", "controls.X must be held: use `hold` to engage a drone or command it"),
        ("{press: tell, command: drone arm}", "controls.X must be held"),
        ("{axis: stick_pitch, by: position}", "controls.X must return to its center when released"),
        ("{axis: stick_pitch, rest: high}", "controls.X must return to its center when released"),
        ("{press: disengage, hold: engage}", ""),
        ("{press: disengage, hold: tell, command: drone arm}", ""),
        ("{axis: stick_pitch}", ""),
    ],
)
def test_a_drone_is_told_by_holding_and_flown_by_what_is_let_go(tmp_path: Path, control: str, problem: str) -> None:
    links = RIG.replace('"virtual:test"}', '"virtual:test", drone: "sim:"}')
    text = links[: links.index("sinks:")].rstrip() + DRONE
    (tmp_path / "rig.yaml").write_text(f"{text}inputs: [{{controls: {{X: {control}}}}}]\n")
    found = []
    try:
        load_profile(str(tmp_path / "rig.yaml"))
    except DocumentError as error:
        found = error.problems
    assert [problem in each for each in found] == ([True] if problem else [])


@pytest.mark.parametrize(
    ("inputs", "said"),
    [
        ("{pad: dualshock4, enable: Button 5}", "inputs[0].enable Button 5 already is slower"),
        ("{enable: Button 1, controls: {Button 1: {press: stop}}}", "inputs[0].enable Button 1 already is stop"),
        ("{enable: X, controls: {X: {axis: pan}}}", "inputs[0].enable X already is pan"),
        (
            "{enable: Button 2, controls: {X: {axis: pan, fine: 0.1, fine_button: Button 2}}}",
            "inputs[0].enable Button 2 already is the fine button of X",
        ),
        (
            "{enable: Hat switch up, controls: {Hat switch: {up: {press: record}}}}",
            "inputs[0].enable Hat switch up already is record",
        ),
        (
            "{controls: {Button 2: {press: enable}}}",
            "inputs[0].controls.Button 2 is a press, and enable is a button to",
        ),
    ],
)
def test_an_enable_is_one_thing_and_a_button_that_does_something_else_is_refused(
    tmp_path: Path, inputs: str, said: str
) -> None:
    (problem,) = problems(tmp_path, f"inputs: [{inputs}]\n")
    assert said in problem


def test_a_button_of_a_pad_is_free_to_enable_once_it_is_left_out(tmp_path: Path) -> None:
    profile = rig(tmp_path, "inputs: [{pad: dualshock4, enable: Button 5, controls: {Button 5: null}}]\n")
    assert profile.inputs[0].enable == "Button 5"

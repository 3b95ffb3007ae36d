"""Which mapping a device gets: shipped ones fit the descriptors of the devices they name, guessed ones fit any."""

from typing import Any

import pytest
from fake_hid import GAMEPAD, JOYSTICK, PLUGGED, vectors

from teleop.config.documents.document import DocumentError
from teleop.config.inputs_section import DeviceSection, InputSection
from teleop.config.pad_file import load_pad
from teleop.core.axes import Axis
from teleop.core.operator_input import Command
from teleop.inputs.hid.backend import DeviceInfo
from teleop.inputs.hid.descriptor.parser import parse_descriptor
from teleop.inputs.hid.mapping import Mapped
from teleop.inputs.hid.pads import MULTI_AXIS, choose, fits, pad_for, shipped
from teleop.inputs.hid.state import HidState

DEVICES = vectors()["devices"]


def info(ids: tuple[int, int], usage: tuple[int, int] = GAMEPAD, name: str = "") -> DeviceInfo:
    return DeviceInfo(PLUGGED, *ids, "", name, *usage, 0)


def ids_of(device: dict[str, Any]) -> tuple[int, int]:
    return device["vendor_id"], device["product_id"]


def state_of(device: dict[str, Any]) -> HidState:
    return HidState(parse_descriptor(bytes.fromhex(device["descriptor"])))


def label(device: dict[str, Any]) -> str:
    return f"{device['name']} {device['bus']}"


@pytest.mark.parametrize("device", [each for each in DEVICES if pad_for(info(ids_of(each)))], ids=label)
def test_a_shipped_mapping_names_only_controls_that_its_device_has(device: dict[str, Any]) -> None:
    state = state_of(device)
    chosen = choose(InputSection(), info(ids_of(device)), state.names)
    assert chosen.controls
    assert Mapped(chosen.controls).names <= state.names


def test_the_known_devices_with_a_shipped_mapping_are_these() -> None:
    known = {pad.name for device in DEVICES if (pad := pad_for(info(ids_of(device))))}
    assert known == {
        "DualShock 4", "KeyDial", "Logitech gamepad", "SpaceMouse", "Stadia", "Surface Dial", "T.16000M", "Xbox",
    }  # fmt: skip


def test_every_device_has_one_shipped_mapping() -> None:
    devices = [(device.vendor, device.product, device.driver) for pad in shipped() for device in pad.devices]
    assert len(devices) == len(set(devices))


@pytest.mark.parametrize("pad", shipped(), ids=lambda pad: pad.name)
def test_whoever_can_be_stopped_by_a_pad_can_go_on_with_it(pad: Any) -> None:
    asked = [control.press for control in pad.controls.values() if control]
    assert (Command.STOP in asked) == (Command.CLEAR in asked)


def test_a_dualsense_is_known_by_its_published_controls() -> None:
    """Its descriptor (github:DJm00n/ControllersInfo, dualsense) has X, Y, Z, Rz, Rx, Ry, a hat and 15 buttons."""
    axes = {"X", "Y", "Z", "Rz", "Rx", "Ry", *(f"Hat switch {way}" for way in ("up", "right", "down", "left"))}
    chosen = choose(InputSection(), info((0x054C, 0x0CE6)), axes)
    assert Mapped(chosen.controls).names <= axes | {f"Button {number}" for number in range(1, 16)}


def test_a_pad_nobody_described_is_flown_by_its_sticks() -> None:
    names = {"X", "Y", "Z", "Rz", "Button 1", "Button 2", "Button 5", "Hat switch"}
    chosen = choose(InputSection(), info((1, 2)), names)
    assert chosen.guessed
    assert {name: control.axis for name, control in chosen.controls.items() if control.axis} == {
        "X": Axis.PAN,
        "Y": Axis.TILT,
        "Z": Axis.ROLL,
        "Rz": Axis.FOCUS,
    }
    assert chosen.controls["Y"].invert
    assert chosen.controls["Button 1"].press is Command.STOP
    assert chosen.controls.keys() <= names


def test_a_joysticks_twist_is_roll() -> None:
    chosen = choose(InputSection(), info((1, 2), JOYSTICK), {"X", "Y", "Rz", "Slider"})
    assert chosen.controls["Rz"].axis is Axis.ROLL
    assert "Slider" not in chosen.controls


def test_the_puck_of_a_multi_axis_controller_turns_the_head() -> None:
    chosen = choose(InputSection(), info((1, 2), MULTI_AXIS), {"X", "Y", "Z", "Rx", "Ry", "Rz", "Button 1"})
    assert {name: control.axis for name, control in chosen.controls.items() if control.axis} == {
        "Rx": Axis.TILT,
        "Ry": Axis.ROLL,
        "Rz": Axis.PAN,
    }
    assert chosen.reports == "on-change"


def test_a_profile_may_change_a_shipped_mapping_or_write_its_own() -> None:
    changed = {"pad": "dualshock4", "reports": "continuous", "controls": {"X": {"axis": "roll"}, "Button 2": None}}
    chosen = choose(InputSection.model_validate(changed), info((1, 2)), ())
    assert chosen.controls["X"].axis is Axis.ROLL
    assert "Button 2" not in chosen.controls
    assert chosen.controls["Y"].axis is Axis.TILT
    assert chosen.reports == "continuous"
    own = InputSection.model_validate({"controls": {"Z": {"axis": "pan"}}})
    assert set(choose(own, info((0x054C, 0x09CC)), ()).controls) == {"Z"}


def test_a_device_whose_reports_are_not_as_described_is_refused() -> None:
    assert "not what its descriptor says" in choose(InputSection(), info((0x057E, 0x2009)), ()).unreadable


def test_a_mapping_at_a_path_is_checked_like_a_shipped_one(tmp_path: Any) -> None:
    file = tmp_path / "pad.yaml"
    file.write_text(
        "name: Mine\ndevices: [{vendor: 1, product: 2}]\ncontrols:\n  X: {axis: pam}\n  Y: {press: recall}\n"
    )
    with pytest.raises(DocumentError) as caught:
        load_pad(str(file))
    assert [problem.removeprefix(f"{tmp_path}/") for problem in caught.value.problems] == [
        "pad.yaml:4:13: controls.X.axis must be one of pan, tilt, roll, focus, stick_roll, stick_pitch, "
        "stick_throttle, stick_yaw, not 'pam'; did you mean pan?",
        "pad.yaml:5:6: controls.Y needs a number: which preset to recall",
    ]


@pytest.mark.parametrize(("written", "fitting"), [("dial [usb]", True), ("Dial *", True), ("Dial", False)])
def test_a_device_fits_by_its_whole_name_even_one_with_brackets(written: str, fitting: bool) -> None:
    assert fits(DeviceSection(name=written), info((1, 2), name="Dial [USB]")) is fitting

"""What sysfs says of event devices: which are for a hand, whose they are, and which are read by hidraw instead."""

from __future__ import annotations

from pathlib import Path

import pytest
from fake_evdev import XBOX_BUTTONS, Axis, FakeEvents, FakeMachine, X, Y, xbox_axes

from teleop.inputs.evdev.nodes import VIRTUAL, EventNode, event_nodes
from teleop.inputs.hid.pads import pad_for

HID = "0003:046D:C216.0001"


@pytest.fixture
def machine(tmp_path: Path) -> FakeMachine:
    return FakeMachine(tmp_path)


def nodes(machine: FakeMachine) -> list[EventNode]:
    return list(event_nodes(machine.sys, machine.dev))


def test_a_wired_xbox_pad_is_listed_with_its_driver_and_no_hidraw(machine: FakeMachine) -> None:
    path = machine.plug(FakeEvents(), serial="3032")
    [node] = nodes(machine)
    assert (node.path, node.driver, node.hidraw, node.is_hid, node.keeps_names) == (path, "xpad", (), False, False)
    info = node.info
    assert (info.vendor_id, info.product_id, info.serial, info.name) == (
        0x45E,
        0x2EA,
        "3032",
        "Microsoft X-Box One pad",
    )
    assert (info.usage_page, info.usage, info.driver, info.path) == (1, 5, "xpad", bytes(path))
    assert info.port == "1-1"


def test_a_device_that_a_program_made_has_no_driver_but_uinput(machine: FakeMachine) -> None:
    machine.plug(FakeEvents(), parent="")
    assert [node.driver for node in nodes(machine)] == [VIRTUAL]


@pytest.mark.parametrize(
    ("events", "properties"),
    [
        (FakeEvents({}, [1, 30, 57]), 0),  # a keyboard
        (FakeEvents({}, [0x110, 0x111], [0, 1]), 0),  # a mouse
        (FakeEvents({X: Axis(0, 0, 9), Y: Axis(0, 0, 9)}, [0x140, 0x14A]), 0),  # a tablet, a touch pad
        (FakeEvents({X: Axis(0, 0, 9), Y: Axis(0, 0, 9)}, []), 1 << 6),  # motion sensors
    ],
)
def test_what_is_for_no_stick_is_not_listed(machine: FakeMachine, events: FakeEvents, properties: int) -> None:
    machine.plug(events, properties=properties)
    assert nodes(machine) == []


def test_pedals_have_axes_alone_and_a_stick_is_no_gamepad(machine: FakeMachine) -> None:
    machine.plug(FakeEvents({X: Axis(0, 0, 9)}, []), 4)
    machine.plug(FakeEvents({X: Axis(0, 0, 9)}, [0x120]), 12, parent="1-2:1.0")
    assert [(node.path.name, node.info.usage) for node in nodes(machine)] == [("event4", 4), ("event12", 4)]


def test_a_device_with_a_hidraw_node_that_may_be_opened_is_not_read_here(machine: FakeMachine) -> None:
    machine.plug(FakeEvents(), parent=HID, driver="hid-generic", hidraw=["hidraw0"])
    [node] = nodes(machine)
    assert node.hidraw == (machine.dev / "hidraw0",)
    assert (node.keeps_names, node.info.driver, node.is_preferred) == (True, "", False)


def test_a_device_whose_hidraw_node_is_shut_is_read_here_unless_it_is_shut_here_too(
    machine: FakeMachine, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = machine.plug(FakeEvents(), parent=HID, driver="hid-generic", hidraw=["hidraw0"])
    shut = {machine.dev / "hidraw0"}
    monkeypatch.setattr("os.access", lambda node, mode: node not in shut)
    [node] = nodes(machine)
    assert node.is_preferred
    shut.add(path)
    assert not node.is_preferred


@pytest.mark.parametrize(
    ("driver", "bus", "preferred"),
    [
        ("playstation", 3, False),
        ("playstation", 5, True),
        ("sony", 5, True),
        ("nintendo", 3, True),
        ("hid-generic", 5, False),
    ],
)
def test_a_driver_that_switches_its_device_to_undescribed_reports_is_read_here(
    machine: FakeMachine, driver: str, bus: int, preferred: bool
) -> None:
    machine.plug(FakeEvents(), parent=HID, driver=driver, bus=bus, hidraw=["hidraw0"])
    [node] = nodes(machine)
    assert node.is_preferred == preferred
    assert node.info.driver == ("" if driver == "hid-generic" else driver)


def test_a_machine_without_sysfs_has_none(tmp_path: Path) -> None:
    assert list(event_nodes(tmp_path / "sys", tmp_path / "dev")) == []


PLAYSTATION_BUTTONS = (*XBOX_BUTTONS, 0x138, 0x139)
GENERIC_BUTTONS = range(0x130, 0x13A)


@pytest.mark.parametrize(
    ("axes", "keys", "mapping"),
    [
        (xbox_axes(), XBOX_BUTTONS, "Xbox"),
        (xbox_axes(), PLAYSTATION_BUTTONS, None),
        (xbox_axes(), GENERIC_BUTTONS, None),
        ({code: axis for code, axis in xbox_axes().items() if code not in (3, 4)}, XBOX_BUTTONS, None),
        ({code: axis for code, axis in xbox_axes().items() if code < 2}, [0x120, 0x121], None),
    ],
    ids=["as xpad", "as hid-playstation", "buttons in a row", "no right stick", "a joystick"],
)
def test_a_pad_that_a_program_made_is_an_xbox_pad_only_with_the_controls_of_one(
    machine: FakeMachine, axes: dict[int, Axis], keys: list[int], mapping: str | None
) -> None:
    machine.plug(FakeEvents(axes, list(keys)), parent="")
    [node] = nodes(machine)
    pad = pad_for(node.info)
    assert (pad and pad.name) == mapping
    assert node.info.driver == ("xpad" if mapping else VIRTUAL), "its names are no descriptor's either way"

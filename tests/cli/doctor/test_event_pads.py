"""`teleop doctor` of pads that hidraw has not: which driver has each, and the rule or group that is missing."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest
from fake_evdev import FakeEvents, FakeMachine

from teleop.cli.doctor import devices as doctor_devices
from teleop.cli.doctor.event_pads import event_pads, xbox_without_driver
from teleop.cli.doctor.finding import Finding, State
from teleop.inputs.evdev.nodes import event_nodes


@pytest.fixture
def machine(tmp_path: Path) -> FakeMachine:
    return FakeMachine(tmp_path)


def findings(machine: FakeMachine) -> list[Finding]:
    return list(event_pads(machine.sys, machine.dev))


def test_a_wired_pad_that_may_be_opened_is_named_with_its_driver(machine: FakeMachine) -> None:
    path = machine.plug(FakeEvents())
    [finding] = findings(machine)
    assert (finding.state, finding.found) == (
        State.OK,
        f"Microsoft X-Box One pad (driver xpad, evdev): {path} may be opened",
    )


def test_one_that_may_not_be_opened_gets_its_group_and_its_rule_exactly(
    machine: FakeMachine, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = machine.plug(FakeEvents())
    monkeypatch.setattr("os.access", lambda node, mode: node != path)
    [finding] = findings(machine)
    assert finding.state is State.PROBLEM
    assert finding.found.endswith(f"no permission to open {path}")
    assert "sudo usermod -aG input $USER" in finding.todo
    assert finding.rules == [
        'SUBSYSTEM=="input", KERNEL=="event*", ATTRS{id/vendor}=="045e", ATTRS{id/product}=="02ea",'
        ' MODE="0660", GROUP="input", TAG+="uaccess"'
    ]


def test_without_the_evdev_package_what_to_install_is_said(
    machine: FakeMachine, monkeypatch: pytest.MonkeyPatch
) -> None:
    machine.plug(FakeEvents())
    monkeypatch.setattr("teleop.cli.doctor.event_pads.has_package", lambda: False)
    [finding] = findings(machine)
    assert (finding.state, finding.todo) == (State.PROBLEM, "pip install 'rs-teleop[evdev]'")


def test_one_without_a_node_is_a_missing_module_or_a_container(machine: FakeMachine) -> None:
    path = machine.plug(FakeEvents())
    path.unlink()
    [finding] = findings(machine)
    assert finding.state is State.PROBLEM
    assert f"there is no {path}" in finding.found
    assert "modprobe evdev" in finding.todo


def test_a_pad_of_hidraw_is_not_named_here(machine: FakeMachine) -> None:
    machine.plug(FakeEvents(), parent="0003:046D:C216.0001", driver="hid-generic", hidraw=["hidraw0"])
    assert findings(machine) == []


def test_an_xbox_pad_that_no_driver_has_is_found_on_the_usb_bus(machine: FakeMachine) -> None:
    device = machine.sys / "devices/usb1/1-1"
    interface = device / "1-1:1.0"
    interface.mkdir(parents=True)
    files = {"bInterfaceClass": "ff", "bInterfaceSubClass": "47", "bInterfaceProtocol": "d0"}
    for name, text in files.items():
        (interface / name).write_text(text + "\n")
    for name, text in {"product": "Controller", "idVendor": "045e", "idProduct": "02ea"}.items():
        (device / name).write_text(text + "\n")
    (machine.sys / "bus/usb/devices").mkdir(parents=True)
    (machine.sys / "bus/usb/devices/1-1:1.0").symlink_to(interface)
    [finding] = findings(machine)
    assert (finding.state, finding.found) == (
        State.PROBLEM,
        "Controller (045e:02ea): an Xbox pad, and no driver has it",
    )
    assert "modprobe xpad" in finding.todo
    (interface / "driver").symlink_to(machine.sys)
    assert xbox_without_driver(machine.sys) == []


def test_with_a_wired_pad_nobody_is_asked_to_plug_one_in(machine: FakeMachine, monkeypatch: pytest.MonkeyPatch) -> None:
    machine.plug(FakeEvents())
    monkeypatch.setattr(doctor_devices, "HIDRAW", machine.sys / "class/hidraw")
    monkeypatch.setattr(doctor_devices, "event_nodes", lambda: event_nodes(machine.sys, machine.dev))
    [finding] = doctor_devices.hid()
    assert "plug a pad in" not in finding.todo
    monkeypatch.setattr(doctor_devices, "event_nodes", list)
    [finding] = doctor_devices.hid()
    assert "plug a pad in" in finding.todo


def test_a_hidraw_node_that_is_shut_is_no_problem_where_the_event_device_is_read(
    machine: FakeMachine, monkeypatch: pytest.MonkeyPatch
) -> None:
    machine.plug(FakeEvents(), parent="0005:054C:0CE6.0001", driver="playstation", bus=5, hidraw=["hidraw0"])
    (machine.sys / "class/hidraw/hidraw0").mkdir(parents=True)
    monkeypatch.setattr(doctor_devices, "HIDRAW", machine.sys / "class/hidraw")
    monkeypatch.setattr(doctor_devices, "event_nodes", lambda: event_nodes(machine.sys, machine.dev))
    assert [finding.state for finding in doctor_devices.hid()] == [State.NOTE]
    assert [finding.state for finding in findings(machine)] == [State.OK]


def test_elsewhere_than_on_linux_there_are_none(machine: FakeMachine, monkeypatch: pytest.MonkeyPatch) -> None:
    machine.plug(FakeEvents())
    monkeypatch.setattr(sys, "platform", "darwin")
    assert findings(machine) == []

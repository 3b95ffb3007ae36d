import json
import os
import sys
import types
from pathlib import Path

import pytest
from fake_evdev import FakeEvents, FakeMachine
from pty_lines import NullModem

from teleop.cli import devices, run
from teleop.cli.devices import Device, event_devices, hid_devices, kernel_can, serial_ports, vendor_can
from teleop.inputs.evdev.nodes import event_nodes
from teleop.links import parse


def interface(net: Path, name: str, kind: str, flags: str) -> None:
    (net / name).mkdir()
    (net / name / "type").write_text(kind + "\n")
    (net / name / "flags").write_text(flags + "\n")


def test_only_the_can_interfaces_of_the_kernel_are_listed(tmp_path: Path) -> None:
    interface(tmp_path, "eth0", "1", "0x1003")
    interface(tmp_path, "can0", "280", "0x40080")
    interface(tmp_path, "vcan0", "280", "0xc1")
    interface(tmp_path, "vcan1", "280", "0xc0")
    (tmp_path / "bonding_masters").write_text("")
    listing = kernel_can(tmp_path)
    assert listing.devices == [
        Device("can", ("socketcan:can0",), "down: sudo ip link set can0 up type can bitrate 1000000"),
        Device("can", ("socketcan:vcan0",), "up"),
        Device("can", ("socketcan:vcan1",), "down: sudo ip link set vcan1 up"),
    ]
    assert listing.notes == []


def test_what_vendors_libraries_report_is_a_link_url() -> None:
    program = "print('a driver greets'); print('[[\"pcan\", \"PCAN_USBBUS1\"]]')"
    listing = vendor_can(program)
    assert [parse(device.names[0]).interface for device in listing.devices] == ["pcan"]
    assert listing.notes == []


def test_a_vendors_library_that_python_can_gave_up_is_a_note() -> None:
    program = "import sys; print('[]'); print('Timeout (3.00s) reached for interfaces: kvaser', file=sys.stderr)"
    assert vendor_can(program).notes == ["CAN: Timeout (3.00s) reached for interfaces: kvaser"]


@pytest.mark.parametrize(
    ("program", "note"),
    [
        ("import threading; threading.Event().wait()", "did not answer within 1 s"),
        ("raise SystemError('driver broken')", "SystemError: driver broken"),
        ("import os; os.abort()", "exit code -6"),
    ],
)
def test_a_vendors_library_that_hangs_or_dies_is_a_note(program: str, note: str) -> None:
    listing = vendor_can(program, patience=1)
    assert listing.devices == []
    assert [note in each for each in listing.notes] == [True]


def test_an_interpreter_that_may_not_be_started_again_is_a_note(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("sys.executable", "/nowhere/python3")
    assert vendor_can().notes == [
        "CAN: vendors' libraries cannot be asked: /nowhere/python3: No such file or directory"
    ]


def test_the_real_question_to_python_can_is_answered() -> None:
    assert vendor_can(patience=60).notes == []


def test_serial_ports_are_named_for_both_uses(monkeypatch: pytest.MonkeyPatch) -> None:
    from serial.tools import list_ports, list_ports_common

    cable = NullModem()
    port = list_ports_common.ListPortInfo(cable.ports[0])
    port.description = "USB Serial"
    monkeypatch.setattr(list_ports, "comports", lambda: [port])
    (device,) = serial_ports().devices
    cable.close()
    assert [parse(name).channel for name in device.names] == [cable.ports[0]] * 2
    assert [parse(name).kind for name in device.names] == ["can", "serial"]
    assert device.description == "USB Serial"


def pad(path: bytes) -> dict[str, object]:
    return {"vendor_id": 0x54C, "product_id": 0x9CC, "product_string": "Wireless Controller", "path": path}


def test_a_pad_that_both_backends_see_is_listed_once(monkeypatch: pytest.MonkeyPatch) -> None:
    for backend, path in (("hidraw", b"/dev/null"), ("hid", b"1-2:1.3")):
        monkeypatch.setitem(sys.modules, backend, types.SimpleNamespace(enumerate=lambda path=path: [pad(path)]))
    listing = hid_devices()
    assert listing.devices == [Device("hid", ("054c:09cc",), "Wireless Controller (hidraw)")]
    assert listing.notes == []


def test_the_name_of_a_device_is_no_command_for_the_terminal(monkeypatch: pytest.MonkeyPatch) -> None:
    evil = pad(b"1-2:1.3") | {"product_string": "P\x1b[2Jad\n"}
    monkeypatch.setitem(sys.modules, "hid", types.SimpleNamespace(enumerate=lambda: [evil]))
    assert hid_devices(["hid"]).devices[0].description == "P[2Jad (hid, port 1-2)"


def test_pads_of_one_model_are_told_apart_by_their_ports(monkeypatch: pytest.MonkeyPatch) -> None:
    found = [pad(path) for path in (b"1-2:1.3", b"1-2:1.0", b"1-4.1:1.3")]
    monkeypatch.setitem(sys.modules, "hid", types.SimpleNamespace(enumerate=lambda: found))
    [device] = hid_devices(["hid"]).devices
    assert device.description == "Wireless Controller (hid, port 1-2, port 1-4.1)"


def test_what_keeps_hid_devices_from_being_listed_is_said(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "hidraw", None)
    monkeypatch.setitem(sys.modules, "hid", types.SimpleNamespace(enumerate=lambda: [pad(b"/dev/hidraw7")]))
    monkeypatch.setattr(os, "access", lambda *_: False)
    listing = hid_devices()
    assert listing.notes == [
        "HID: no module hidraw: pip install hidapi",
        'HID: no permission to open /dev/hidraw7: add a udev rule with TAG+="uaccess"',
    ]


def test_a_wired_pad_is_listed_with_the_driver_that_has_it_and_what_keeps_it_shut(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    machine = FakeMachine(tmp_path)
    path = machine.plug(FakeEvents())
    machine.plug(FakeEvents(), 7, parent="0003:046D:C216.0001", driver="hid-generic", hidraw=["hidraw0"])
    expected = Device("evdev", ("045e:02ea",), f"Microsoft X-Box One pad (driver xpad, {path}, port 1-1)")
    assert event_devices(machine.sys, machine.dev) == devices.Listing([expected])
    monkeypatch.setattr(os, "access", lambda node, mode: node != path)
    assert event_devices(machine.sys, machine.dev).notes == [
        f"evdev: no permission to open {path}: join the group input, or add the rule of teleop doctor"
    ]
    monkeypatch.setattr(devices, "has_package", lambda: False)
    [*_, note] = event_devices(machine.sys, machine.dev).notes
    assert note == "evdev: no package evdev: pip install 'rs-teleop[evdev]'"


def test_a_pad_that_is_read_by_its_event_device_is_no_hid_device_too(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    machine = FakeMachine(tmp_path)
    machine.plug(FakeEvents(), parent="0005:054C:0CE6.0001", driver="playstation", bus=5, hidraw=["hidraw0"])
    monkeypatch.setattr(devices, "event_nodes", lambda: event_nodes(machine.sys, machine.dev))
    path = bytes(machine.dev / "hidraw0")
    monkeypatch.setitem(sys.modules, "hidraw", types.SimpleNamespace(enumerate=lambda: [pad(path)]))
    assert hid_devices(["hidraw"]).devices == []


def test_json_is_one_object_and_the_table_names_everything(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    interface(tmp_path, "can0", "280", "0x1")
    can0 = kernel_can(tmp_path)
    monkeypatch.setattr(devices, "kernel_can", lambda: can0)
    for other in ("vendor_can", "serial_ports", "hid_devices", "event_devices"):
        monkeypatch.setattr(devices, other, devices.Listing)
    assert run(["devices", "--json"]) == 0
    assert json.loads(capsys.readouterr().out) == {
        "devices": [{"kind": "can", "names": ["socketcan:can0"], "description": "up"}],
        "notes": [],
    }
    assert run(["devices"]) == 0
    assert "socketcan:can0" in capsys.readouterr().out

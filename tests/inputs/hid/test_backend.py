"""hidapi as it is: lists of integers, empty strings and n/a for what it does not know, a report id of 0 in front."""

from __future__ import annotations

import sys
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest

from teleop.core.errors import DeviceError
from teleop.inputs.hid.backend import DeviceInfo, Hidapi, described, unit, usb_port


class Device:
    """In the shape of hidapi's own class."""

    def __init__(self) -> None:
        self.calls: list[Any] = []

    def open_path(self, path: bytes) -> None:
        self.calls.append(("open", path))

    def read(self, length: int, timeout_ms: int) -> list[int]:
        self.calls.append(("read", length, timeout_ms))
        return [1, 127, 255]

    def get_report_descriptor(self) -> list[int]:
        return [0x05, 0x01]

    def get_input_report(self, number: int, length: int) -> list[int]:
        self.calls.append(("ask", number, length))
        return [number, 10, 20][:length]

    def close(self) -> None:
        self.calls.append("closed")


@pytest.fixture
def hidapi(monkeypatch: pytest.MonkeyPatch) -> ModuleType:
    module: Any = ModuleType("made_hidapi")
    known = {"vendor_id": 0x54C, "product_id": 0x9CC, "usage_page": 1, "usage": 5, "interface_number": 3}
    module.opened = Device()
    module.device = lambda: module.opened
    module.enumerate = lambda: [
        {**known, "path": b"/dev/hidraw2", "serial_number": "ab", "product_string": "Wireless Controller"},
        {**known, "path": b"/dev/hidraw3", "serial_number": None, "product_string": "n/a"},
    ]
    monkeypatch.setitem(sys.modules, "made_hidapi", module)
    return module


def test_what_is_plugged_in(hidapi: ModuleType) -> None:
    first, second = Hidapi(["no_such_module", "made_hidapi"]).enumerate()
    assert first == DeviceInfo(b"/dev/hidraw2", 0x54C, 0x9CC, "ab", "Wireless Controller", 1, 5, 3)
    assert (second.serial, second.name) == ("", "")
    assert (described(first), described(second)) == ("Wireless Controller", "054c:09cc")


def test_bytes_come_from_a_device(hidapi: Any) -> None:
    device = Hidapi(["made_hidapi"]).open(b"/dev/hidraw2")
    assert device.get_report_descriptor() == b"\x05\x01"
    assert device.read(0.05) == b"\x01\x7f\xff"
    assert device.get_input_report(7, 3) == b"\x07\x0a\x14"
    assert device.get_input_report(0, 2) == b"\x0a\x14"
    device.close()
    assert hidapi.opened.calls == [
        ("open", b"/dev/hidraw2"),
        ("read", 4096, 50),
        ("ask", 7, 3),
        ("ask", 0, 3),
        "closed",
    ]


def test_without_hidapi_it_says_what_to_install() -> None:
    with pytest.raises(
        DeviceError, match="joysticks cannot be read: No module named 'no_such_module': pip install hidapi"
    ):
        Hidapi(["no_such_module"])


@pytest.mark.parametrize(
    ("device", "port"),
    [
        ("devices/pci0000:00/0000:00:14.0/usb1/1-2/1-2:1.0/0003:046D:C216.0001", "1-2"),
        ("devices/pci0000:00/0000:00:14.0/usb1/1-2/1-2.3/1-2.3.4/1-2.3.4:1.1/0003:046D:C52B.0002", "1-2.3.4"),
        ("devices/virtual/misc/uhid/0005:054C:0CE6.0003", ""),
    ],
)
def test_the_port_is_that_of_the_usb_interface_in_sysfs(tmp_path: Path, device: str, port: str) -> None:
    (tmp_path / device).mkdir(parents=True)
    (tmp_path / "class/hidraw/hidraw3").mkdir(parents=True)
    (tmp_path / "class/hidraw/hidraw3/device").symlink_to(tmp_path / device)
    assert usb_port(b"/dev/hidraw3", tmp_path / "class/hidraw") == port


def test_without_sysfs_there_is_no_port_and_libusb_has_it_in_its_path(tmp_path: Path) -> None:
    assert usb_port(b"/dev/hidraw3", tmp_path) == ""
    assert usb_port(b"1-2.3:1.0", tmp_path) == "1-2.3"


def test_a_unit_is_told_by_serial_number_without_one_by_port_and_without_that_by_path() -> None:
    pad = DeviceInfo(b"/dev/hidraw0", 1, 2, "", "Pad", 1, 4, 0)
    moved = pad._replace(path=b"/dev/hidraw7")
    assert unit(pad) != unit(moved)
    assert unit(pad._replace(port="1-2")) == unit(moved._replace(port="1-2"))
    assert unit(pad._replace(serial="A", port="1-2")) == unit(moved._replace(serial="A", port="1-3"))
    assert unit(pad._replace(port="1-2")) != unit(pad._replace(port="1-3"))

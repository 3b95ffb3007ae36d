"""hidapi as it is: lists of integers, empty strings and n/a for what it does not know, a report id of 0 in front."""

from __future__ import annotations

import sys
from types import ModuleType
from typing import Any

import pytest

from teleop.core.errors import DeviceError
from teleop.inputs.hid.backend import DeviceInfo, Hidapi, described


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

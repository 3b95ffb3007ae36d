"""HID devices by hidapi, behind a protocol that a test's fake can speak as well.

PyPI's hidapi has two modules on Linux: `hidraw`, the kernel's, sees every pad, Bluetooth and virtual ones included, and
says what each is for; `hid` is libusb's, which sees USB alone, does not say what a device is for, and takes it away
from the kernel while it is open. So the first is preferred, and of the second only devices are opened that are asked
for by their ids, or known as pads. Elsewhere `hid` is all there is, and the system's own.
"""

from __future__ import annotations

import importlib
import os
import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple, Protocol

from teleop.core.errors import DeviceError

_BACKENDS = ("hidraw", "hid")
_LONGEST = 4096  # bytes of one report: more than any transport here carries
_PORT = re.compile(r"(?:^|/)(\d+-[\d.]+):\d+\.\d+(?=/|$)")  # of a USB interface in sysfs, or libusb's path of it
_NAMELESS = frozenset({"", "n/a"})
_LONGEST_NAME = 256  # letters; USB has 126 of them, the kernel's names 255


class DeviceInfo(NamedTuple):
    """A device that is plugged in. `usage_page` and `usage` are what it is for, 0 where the system does not say.

    `port` is the USB port that it is in, as the kernel names it (`1-2.3`), "" where that is not known.
    """

    path: bytes
    vendor_id: int
    product_id: int
    serial: str
    name: str
    usage_page: int
    usage: int
    interface: int
    port: str = ""
    driver: str = ""
    """Kernel driver that named its controls (xpad); "": its own descriptor did."""


class MissingPackageError(OSError):
    """A device that is read by a package that is not installed; its text has the cure."""


class HidDevice(Protocol):
    """An open device. Every call raises OSError once it is unplugged."""

    def get_report_descriptor(self) -> bytes: ...

    def read(self, timeout: float) -> bytes:
        """The next report, its id in front where the device numbers them; b"" when none comes within `timeout` s."""
        ...

    def get_input_report(self, report_id: int, length: int) -> bytes:
        """The report as `read` would give it, asked for; raises OSError where the device does not answer."""
        ...

    def close(self) -> None: ...


class HidBackend(Protocol):
    def enumerate(self) -> Sequence[DeviceInfo]:
        """What is plugged in; a device that is for several things is there once for each."""
        ...

    def open(self, path: bytes) -> HidDevice:
        """Raises OSError when it may not be opened, or is gone."""
        ...


class Hidapi:
    """The devices that hidapi sees; raises DeviceError when it is not installed."""

    def __init__(self, names: Sequence[str] = _BACKENDS) -> None:
        self._module = _first(names)

    def enumerate(self) -> Sequence[DeviceInfo]:
        return [_info(each) for each in self._module.enumerate()]

    def open(self, path: bytes) -> HidDevice:
        device = self._module.device()
        device.open_path(path)
        return _Open(device)


class _Open:
    def __init__(self, device: Any) -> None:
        self._device = device

    def get_report_descriptor(self) -> bytes:
        return bytes(self._device.get_report_descriptor())

    def read(self, timeout: float) -> bytes:
        return bytes(self._device.read(_LONGEST, max(1, round(timeout * 1000))))

    def get_input_report(self, report_id: int, length: int) -> bytes:
        answer = bytes(self._device.get_input_report(report_id, length + (report_id == 0)))
        return answer if report_id else answer[1:]  # hidapi puts a 0 in front where there are no ids

    def close(self) -> None:
        self._device.close()


def _first(names: Sequence[str]) -> Any:
    reasons = []
    for name in names:
        try:
            return importlib.import_module(name)
        except ImportError as error:
            reasons.append(str(error))
    raise DeviceError(f"joysticks cannot be read: {reasons[-1]}: pip install hidapi")


def _info(each: Mapping[str, Any]) -> DeviceInfo:
    name = shown(each["product_string"] or "")
    return DeviceInfo(
        path=each["path"],
        vendor_id=each["vendor_id"],
        product_id=each["product_id"],
        serial=shown(each["serial_number"] or ""),
        name="" if name in _NAMELESS else name,
        usage_page=each["usage_page"],
        usage=each["usage"],
        interface=each["interface_number"],
        port=usb_port(each["path"]),
    )


def shown(text: str) -> str:
    """What a device says of itself, without what a terminal would take for a command."""
    return "".join(filter(str.isprintable, text[:_LONGEST_NAME]))


def usb_port(path: bytes, sysfs: Path = Path("/sys/class/hidraw")) -> str:
    """The USB port of the device at this path of hidapi's; "" for one that is not on USB."""
    place = os.fsdecode(path)
    if place.startswith("/dev/"):
        place = os.path.realpath(sysfs / place.rpartition("/")[2] / "device")
    ports = _PORT.findall(place)
    return ports[-1] if ports else ""


Unit = tuple[int, int, int, str]


def unit(info: DeviceInfo) -> Unit:
    """What tells a device from all others of its model, before and after an unplugging too.

    Its serial number, without one its port, without that its path.
    """
    where = f"serial {info.serial}" if info.serial else f"port {info.port}" if info.port else f"path {info.path!r}"
    return info.vendor_id, info.product_id, info.interface, where


def same_model(one: DeviceInfo, two: DeviceInfo) -> bool:
    return (one.vendor_id, one.product_id) == (two.vendor_id, two.product_id)


def same_device(one: DeviceInfo, two: DeviceInfo) -> bool:
    """Whether these are surely one device, or two interfaces of one."""
    return unit(one)[3] == unit(two)[3] and same_model(one, two)


def described(info: DeviceInfo) -> str:
    """The name of a device on the screen."""
    return info.name or f"{info.vendor_id:04x}:{info.product_id:04x}"


def identified(info: DeviceInfo) -> str:
    """The device with all that tells it from others of its model."""
    ids = f"{info.vendor_id:04x}:{info.product_id:04x}"
    parts = [f"serial {info.serial}" if info.serial else "", f"port {info.port}" if info.port else ""]
    interface = f"interface {info.interface}" if info.interface > 0 else ""
    return ", ".join(part for part in (f"{described(info)} ({ids})", *parts, interface) if part)

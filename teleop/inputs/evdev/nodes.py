"""The event devices of joysticks and gamepads, as sysfs lists them: which driver has each, and who may open it.

Nothing is opened here, so that a device that this user may not open is listed too. Whether a device has a hidraw node
as well is seen from its parent in sysfs, which both nodes share.
"""

from __future__ import annotations

import os
import re
import struct
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

from teleop.inputs.hid.backend import DeviceInfo, shown, usb_port

SYS, DEV = Path("/sys"), Path("/dev")
VIRTUAL = "uinput"  # the driver of a device that a program made
XPAD = "xpad"
_WORD = 8 * struct.calcsize("l")  # bits of a word of a mask in sysfs
_BLUETOOTH = 0x05
_ACCELEROMETER = 1 << 0x06  # of an event device's properties: a pad's motion sensors are no sticks
_GAMEPAD = range(0x130, 0x140)  # BTN_GAMEPAD and what follows
_JOYSTICK = (range(0x120, 0x130), _GAMEPAD, range(0x220, 0x228), range(0x2C0, 0x2E8))
_AXES = (1 << 0x0B) - 1  # ABS_X to ABS_BRAKE
_XPAD_AXES = frozenset(range(6))  # ABS_X to ABS_RZ
_XPAD_BUTTONS = frozenset({0x130, 0x131, 0x133, 0x134, 0x136, 0x137})  # BTN_SOUTH, EAST, NORTH, WEST, TL, TR
_NOT_XPAD = frozenset({0x132, 0x135, 0x138, 0x139})  # BTN_C, Z, TL2, TR2: other drivers' pads, and those of HID
_HID = re.compile(r"[0-9A-F]{4}:[0-9A-F]{4}:[0-9A-F]{4}\.[0-9A-F]{4}")
_RENAMING = frozenset({"playstation", "sony", "nintendo", "hid-steam", "wiimote", "xpadneo"})
"""HID drivers that give the controls names of their own, instead of those of the descriptor."""


class EventNode(NamedTuple):
    """A joystick's or gamepad's event device; `driver` has it in the kernel, `hidraw` are its hidraw nodes."""

    path: Path
    name: str
    vendor: int
    product: int
    serial: str
    bus: int
    driver: str
    is_hid: bool
    is_gamepad: bool
    hidraw: tuple[Path, ...]
    port: str
    is_like_xpad: bool
    """Whether it has the controls of an Xbox pad under the codes that xpad gives them."""

    @property
    def is_readable(self) -> bool:
        return os.access(self.path, os.R_OK)

    @property
    def keeps_names(self) -> bool:
        """Whether its controls have the names that its HID descriptor gives them."""
        return self.is_hid and self.driver not in _RENAMING

    @property
    def has_open_hidraw(self) -> bool:
        return any(os.access(node, os.R_OK | os.W_OK) for node in self.hidraw)

    @property
    def is_preferred(self) -> bool:
        """Whether it is read here: hidraw has it not, is shut, or sends what the descriptor does not describe."""
        if not self.hidraw or not self.is_readable:
            return not self.hidraw
        switched = self.driver == "nintendo" or (self.driver in ("playstation", "sony") and self.bus == _BLUETOOTH)
        return switched or not self.has_open_hidraw

    @property
    def namer(self) -> str:
        """The driver that named its controls, "" for its HID descriptor; a program may make a pad as xpad does."""
        if self.keeps_names:
            return ""
        return XPAD if self.driver == VIRTUAL and self.is_like_xpad else self.driver

    @property
    def info(self) -> DeviceInfo:
        return DeviceInfo(
            path=os.fsencode(self.path),
            vendor_id=self.vendor,
            product_id=self.product,
            serial=self.serial,
            name=self.name,
            usage_page=0x01,
            usage=0x05 if self.is_gamepad else 0x04,
            interface=-1,
            port=self.port,
            driver=self.namer,
        )


def event_nodes(sys: Path = SYS, dev: Path = DEV) -> Iterator[EventNode]:
    """Every joystick and gamepad that the kernel has an event device of, in the order of their numbers."""
    found = (sys / "class/input").glob("event*")
    for entry in sorted(found, key=lambda entry: (len(entry.name), entry.name)):
        if node := _node(entry, dev):
            yield node


def _node(entry: Path, dev: Path) -> EventNode | None:
    device = entry / "device"
    keys, axes = _mask(device / "capabilities/key"), _mask(device / "capabilities/abs")
    buttons = [code for codes in _JOYSTICK for code in codes if keys >> code & 1]
    if _mask(device / "properties") & _ACCELEROMETER or not (buttons or (axes & _AXES and not keys)):
        return None  # pedals have axes alone; a tablet has other buttons
    parent = (device / "device").resolve() if (device / "device").exists() else None
    driver = VIRTUAL if parent is None else (parent / "driver").resolve().name
    return EventNode(
        path=dev / "input" / entry.name,
        name=shown(_text(device / "name")),
        vendor=_number(device / "id/vendor"),
        product=_number(device / "id/product"),
        serial=shown(_text(device / "uniq")),
        bus=_number(device / "id/bustype"),
        driver=driver,
        is_hid=parent is not None and bool(_HID.fullmatch(parent.name)),
        is_gamepad=any(code in _GAMEPAD for code in buttons),
        hidraw=tuple(dev / node.name for node in sorted(parent.glob("hidraw/hidraw*"))) if parent else (),
        port=usb_port(os.fsencode(parent)) if parent else "",
        is_like_xpad=all(axes >> code & 1 for code in _XPAD_AXES)
        and set(buttons) >= _XPAD_BUTTONS
        and not _NOT_XPAD & set(buttons),
    )


def _text(file: Path) -> str:
    try:
        return file.read_text(errors="replace").strip()
    except OSError:  # it was unplugged meanwhile, or the kernel has nothing to say of this
        return ""


def _number(file: Path) -> int:
    return int(_text(file) or "0", 16)


def _mask(file: Path) -> int:
    """A bit mask of sysfs: words in hexadecimal, the most significant first, none filled up with zeros."""
    mask = 0
    for word in _text(file).split():
        mask = mask << _WORD | int(word, 16)
    return mask

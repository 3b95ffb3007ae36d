"""The udev rules that let a user open pads and serial adapters: as narrow as they can be, since a keyboard is HID too.

`uaccess` gives a device to the user at the machine; the group is for a machine reached by ssh, where no user sits.
"""

from __future__ import annotations

import re
from pathlib import Path

from teleop.inputs.evdev.nodes import EventNode

HIDRAW, SERIAL = Path("/sys/class/hidraw"), Path("/sys/class/tty")
_ID = re.compile(r"^HID_ID=([0-9A-F]{4}):[0-9A-F]{4}([0-9A-F]{4}):[0-9A-F]{4}([0-9A-F]{4})$", re.MULTILINE)
_GRANT = 'MODE="0660", GROUP="{group}", TAG+="uaccess"'
_TYPING = (b"\x05\x01\x09\x06", b"\x05\x01\x09\x02")  # a descriptor's first items: Generic Desktop, Keyboard or Mouse


def hid_rule(device: Path) -> str:
    """The rule for an entry of /sys/class/hidraw; "" for a keyboard or a mouse, which stay closed.

    It matches the HID device's own name (bus, vendor and product), which those on Bluetooth have too.
    """
    try:
        found = _ID.search((device / "device/uevent").read_text())
        descriptor = (device / "device/report_descriptor").read_bytes()
    except OSError:  # it was unplugged meanwhile
        return ""
    if found is None or descriptor.startswith(_TYPING):
        return ""
    bus, vendor, product = found.groups()
    return f'KERNEL=="hidraw*", KERNELS=="{bus}:{vendor}:{product}.*", {_GRANT.format(group="input")}'


def event_rule(node: EventNode) -> str:
    """The rule for the event device of a pad, by the pad's ids."""
    ids = f'ATTRS{{id/vendor}}=="{node.vendor:04x}", ATTRS{{id/product}}=="{node.product:04x}"'
    return f'SUBSYSTEM=="input", KERNEL=="event*", {ids}, {_GRANT.format(group="input")}'


def serial_rule() -> str:
    return f'SUBSYSTEM=="tty", KERNEL=="ttyACM*|ttyUSB*", {_GRANT.format(group="dialout")}'

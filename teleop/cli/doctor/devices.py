"""What `teleop doctor` looks at outside the computer: pads, serial ports, CAN adapters, and who may open them."""

from __future__ import annotations

import os
import sys
from pathlib import Path

from teleop.cli.devices import kernel_can, vendor_can
from teleop.cli.doctor.event_pads import xbox_without_driver
from teleop.cli.doctor.finding import RELOAD, RULES, Finding, Findings, State
from teleop.cli.doctor.udev_rules import HIDRAW, SERIAL, hid_rule, serial_rule
from teleop.inputs.evdev.nodes import event_nodes

_PLUG = "plug a pad in and ask again, for the udev rule it needs"


def hid() -> Findings:
    """Whether pads and dials may be opened: only hidraw sees those on Bluetooth, and udev decides who may use it."""
    if sys.platform != "linux":
        yield Finding("hid", State.NOTE, "hidraw is Linux's; here libusb or the system's own is asked")
        return
    nodes = list(event_nodes())
    by_events = {path.name for node in nodes if node.is_preferred for path in node.hidraw}
    devices = [device for device in sorted(HIDRAW.glob("hidraw*")) if device.name not in by_events]
    shut = [device for device in devices if not os.access(Path("/dev") / device.name, os.R_OK | os.W_OK)]
    rules = list(dict.fromkeys(rule for device in shut if (rule := hid_rule(device))))
    if rules:
        names = ", ".join(f"/dev/{device.name}" for device in shut if hid_rule(device))
        yield Finding("hid", State.PROBLEM, f"no permission to open {names}", _write_rules(), rules)
    elif devices and len(shut) == len(devices):
        yield Finding("hid", State.NOTE, "only keyboards and mice here: they need no permission", _PLUG)
    elif devices:
        yield Finding("hid", State.OK, f"{len(devices) - len(shut)} of {len(devices)} hidraw devices may be opened")
    elif nodes or xbox_without_driver():
        yield Finding("hid", State.NOTE, "no hidraw device here; the pads here have other drivers")
    else:
        yield Finding("hid", State.NOTE, "no hidraw device here", _PLUG)


def serial() -> Findings:
    ports = [Path("/dev") / tty.name for tty in sorted(SERIAL.glob("tty*")) if (tty / "device/driver").exists()]
    ports = [port for port in ports if port.name.startswith(("ttyACM", "ttyUSB"))]
    shut = [port for port in ports if not os.access(port, os.R_OK | os.W_OK)]
    if shut:
        names = ", ".join(map(str, shut))
        yield Finding("serial", State.PROBLEM, f"no permission to open {names}", _write_rules(), [serial_rule()])
    elif ports:
        yield Finding("serial", State.OK, ", ".join(map(str, ports)))
    else:
        yield Finding("serial", State.NOTE, "no USB serial port here")


def can_adapters() -> Findings:
    kernel, vendors = kernel_can(), vendor_can()
    for device in [*kernel.devices, *vendors.devices]:
        down = device.description.removeprefix("down: ")
        if down != device.description:
            yield Finding("can", State.PROBLEM, f"{device.names[0]} is down", down)
        else:
            yield Finding("can", State.OK, f"{device.names[0]} ({device.description})")
    for note in [*kernel.notes, *vendors.notes]:
        yield Finding("can", State.NOTE, note)
    if not kernel.devices and not vendors.devices:
        yield Finding("can", State.NOTE, "no CAN adapter found; an slcan one is among the serial ports")


def _write_rules() -> str:
    return f"write these lines into {RULES}, then: {RELOAD}"

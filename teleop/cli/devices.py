"""`teleop devices`: what is plugged in, each in the words by which a profile names it.

Every kind of device has a way of its own to be listed and a way of its own not to be: a missing library, a driver that
hangs, a file that may not be read. None of that is an error here; it is a note beside the list. Vendors' CAN libraries
are native code loaded by python-can, so they are asked in a process of their own, which can be given up.
"""

from __future__ import annotations

import importlib
import json
import os
import subprocess
import sys
from collections.abc import Iterable
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from teleop.inputs.evdev.backend import INSTALL, has_package, is_read_here
from teleop.inputs.evdev.nodes import DEV, SYS, event_nodes
from teleop.inputs.hid.backend import shown, usb_port
from teleop.links.url import CAN_INTERFACES, R_SDK_BITRATE

_ARPHRD_CAN = "280"  # Linux's if_arp.h: what /sys/class/net/*/type says of a CAN interface
_VENDOR_PATIENCE = 5.0  # s for all vendors' libraries together
_NOT_ASKED = {"virtual", "udp_multicast", "socketcand", "socketcan"}  # not plugged in here, or found without python-can
_ASK_VENDORS = """
import json, os, sys, can
found = can.detect_available_configs(sys.argv[1:], timeout=3)
print(json.dumps([[each["interface"], str(each["channel"])] for each in found]), flush=True)
os._exit(0)
"""  # a library that hangs would keep Python from leaving
_HID_BACKENDS = ("hidraw", "hid")  # of PyPI's hidapi: the kernel's, which sees every pad, and libusb's


@dataclass(frozen=True, slots=True)
class Device:
    """Something plugged in. `names` are what a profile may write: link URLs, or a HID device's vendor:product."""

    kind: str
    names: tuple[str, ...]
    description: str


@dataclass(slots=True)
class Listing:
    """The devices found, and a line for each thing that could not be looked at."""

    devices: list[Device] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)

    def extend(self, other: Listing) -> None:
        self.devices += other.devices
        self.notes += other.notes


def devices(*, as_json: Annotated[bool, Parameter(name="--json", negative="", show_default=False)] = False) -> None:
    """List CAN interfaces, serial ports and HID devices, as a profile names them.

    Parameters
    ----------
    as_json
        One JSON object, for programs.
    """
    listing = Listing()
    for look in (kernel_can, vendor_can, serial_ports, hid_devices, event_devices):
        listing.extend(look())
    if as_json:
        print(json.dumps(asdict(listing)))
    else:
        _print_table(listing)


def kernel_can(net: Path = Path("/sys/class/net")) -> Listing:
    """The kernel's CAN interfaces, virtual ones included, and how to bring up those that are down."""
    listing = Listing()
    for interface in sorted(net.glob("*")):
        if _read(interface / "type") != _ARPHRD_CAN:
            continue
        up = int(_read(interface / "flags") or "0", 16) & 1  # IFF_UP
        bitrate = "" if interface.name.startswith("vcan") else f" type can bitrate {R_SDK_BITRATE}"
        start = f"down: sudo ip link set {interface.name} up{bitrate}"
        listing.devices.append(Device("can", (f"socketcan:{interface.name}",), "up" if up else start))
    return listing


def vendor_can(program: str = _ASK_VENDORS, patience: float = _VENDOR_PATIENCE) -> Listing:
    """The adapters that vendors' libraries under python-can report, waiting `patience` seconds at most."""
    names = sorted(CAN_INTERFACES - _NOT_ASKED)
    try:
        asked = subprocess.run(
            [sys.executable, "-c", program, *names], capture_output=True, text=True, timeout=patience, check=False
        )
    except subprocess.TimeoutExpired:
        return Listing(notes=[f"CAN: vendors' libraries did not answer within {patience:g} s"])
    except OSError as error:
        return Listing(notes=[f"CAN: vendors' libraries cannot be asked: {sys.executable}: {error.strerror}"])
    if asked.returncode:
        last = asked.stderr.strip().splitlines()[-1:] or [f"exit code {asked.returncode}"]
        return Listing(notes=[f"CAN: vendors' libraries failed: {last[0]}"])
    found = json.loads(asked.stdout.splitlines()[-1])
    return Listing(
        [Device("can", (f"{interface}:{channel}",), "adapter") for interface, channel in found],
        [f"CAN: {line}" for line in asked.stderr.splitlines() if line.startswith("Timeout")],  # python-can's own words
    )


def serial_ports() -> Listing:
    """Serial ports, each as a plain line and, in case an slcan adapter is behind it, as a CAN bus."""
    from serial.tools.list_ports import comports

    return Listing(
        [
            Device("serial", (f"slcan:{port.device}", f"serial:{port.device}@230400"), _described(port.description))
            for port in sorted(comports())
        ]
    )


def hid_devices(backends: Iterable[str] = _HID_BACKENDS) -> Listing:
    """HID devices by vendor:product and name, as far as hidapi's two backends see them."""
    listing = Listing()
    seen: dict[tuple[str, str], str] = {}
    ports: dict[tuple[str, str], list[str]] = {}
    read_here = [node for node in event_nodes() if is_read_here(node, has_package())]
    by_events = {os.fsencode(path) for node in read_here for path in node.hidraw}
    for backend in backends:
        try:
            found = importlib.import_module(backend).enumerate()
        except ImportError:
            listing.notes.append(f"HID: no module {backend}: pip install hidapi")
            continue
        except OSError as error:
            listing.notes.append(f"HID: {backend} cannot list devices: {error}")
            continue
        for each in found:
            if each["path"] in by_events:
                continue
            model = f"{each['vendor_id']:04x}:{each['product_id']:04x}", _described(each["product_string"])
            if seen.setdefault(model, backend) == backend and (port := usb_port(each["path"])):
                ports.setdefault(model, []).append(port)
            listing.notes += _unreadable(each["path"])
    for (name, product), backend in seen.items():
        description = f"{product} ({backend}{_at(ports.get((name, product), ()))})"
        listing.devices.append(Device("hid", (name,), description))
    listing.notes = list(dict.fromkeys(listing.notes))
    return listing


def event_devices(sys_: Path = SYS, dev: Path = DEV) -> Listing:
    """The pads that are read by their event devices, and the driver that keeps each from hidraw."""
    listing = Listing()
    for node in event_nodes(sys_, dev):
        if is_read_here(node, has_package()):
            name = f"{node.vendor:04x}:{node.product:04x}"
            place = f"driver {node.driver}, {node.path}{_at([node.port])}"
            listing.devices.append(Device("evdev", (name,), f"{node.name} ({place})"))
            if not node.is_readable:
                note = (
                    f"evdev: no permission to open {node.path}: join the group input, or add the rule of teleop doctor"
                )
                listing.notes.append(note)
    if listing.devices and not has_package():
        listing.notes.append(f"evdev: no package evdev: {INSTALL}")
    return listing


def _at(ports: Iterable[str]) -> str:
    """The USB ports of the devices of one model, each once: what tells them apart in a profile."""
    return "".join(f", port {port}" for port in dict.fromkeys(ports) if port)


def _unreadable(path: bytes) -> list[str]:
    """A note when `path` is a device file (libusb's paths are not) that this user may not open."""
    if not path.startswith(b"/dev/") or os.access(path, os.R_OK | os.W_OK):
        return []
    return [f'HID: no permission to open {os.fsdecode(path)}: add a udev rule with TAG+="uaccess"']


def _described(text: str | None) -> str:
    return "" if text is None or text == "n/a" else shown(text)


def _read(path: Path) -> str:
    try:
        return path.read_text().strip()
    except OSError:  # not every entry has every file, and an adapter may be unplugged meanwhile
        return ""


def _print_table(listing: Listing) -> None:
    from rich.console import Console
    from rich.table import Table
    from rich.text import Text

    console = Console()
    table = Table("kind", "in a profile", "description", box=None, header_style="bold")
    for device in listing.devices:
        table.add_row(*map(Text, (device.kind, "\n".join(device.names), device.description)))
    console.print(table if listing.devices else "nothing is plugged in")
    for note in listing.notes:
        print(note, file=sys.stderr)

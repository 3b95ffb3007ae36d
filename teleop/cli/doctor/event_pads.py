"""What `teleop doctor` looks at of pads that hidraw has not: which driver has each, and who may open it."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from pathlib import Path

from teleop.cli.doctor.finding import RELOAD, RULES, Finding, Findings, State
from teleop.cli.doctor.udev_rules import event_rule
from teleop.inputs.evdev.backend import INSTALL, has_package
from teleop.inputs.evdev.nodes import DEV, SYS, EventNode, event_nodes

GROUP = "input"
_XBOX = {("ff", "5d", "01"), ("ff", "5d", "81"), ("ff", "47", "d0")}  # USB class: 360 on a cable, by radio; One
_JOIN = f"join the group: sudo usermod -aG {GROUP} $USER, and log in again"


def event_pads(sys_: Path = SYS, dev: Path = DEV) -> Findings:
    """The event devices that are read instead of hidraw, and the Xbox pads that no driver has."""
    if sys.platform != "linux":
        return
    for node in event_nodes(sys_, dev):
        if node.is_preferred:
            yield _finding(node)
    for name in xbox_without_driver(sys_):
        todo = "sudo modprobe xpad, then plug it in again; in a container or a small kernel that driver may be missing"
        yield Finding("pads", State.PROBLEM, f"{name}: an Xbox pad, and no driver has it", todo)


def _finding(node: EventNode) -> Finding:
    what = f"{node.name} (driver {node.driver}, evdev)"
    if not has_package():
        return Finding("pads", State.PROBLEM, f"{what}: no package evdev", INSTALL)
    if node.is_readable:
        return Finding("pads", State.OK, f"{what}: {node.path} may be opened")
    if not node.path.exists():
        todo = "sudo modprobe evdev; a container needs /dev/input of its host"
        return Finding("pads", State.PROBLEM, f"{what}: there is no {node.path}", todo)
    todo = f"{_JOIN}; or write these lines into {RULES}, then: {RELOAD}"
    return Finding("pads", State.PROBLEM, f"{what}: no permission to open {node.path}", todo, [event_rule(node)])


def xbox_without_driver(sys_: Path = SYS) -> Sequence[str]:
    """The USB interfaces of Xbox pads that nothing in the kernel reads."""
    found = []
    for interface in sorted((sys_ / "bus/usb/devices").glob("*:*")):
        numbers = tuple(_text(interface / f"bInterface{part}") for part in ("Class", "SubClass", "Protocol"))
        if numbers in _XBOX and not (interface / "driver").exists():
            device = interface.resolve().parent
            name = _text(device / "product") or interface.name
            found.append(f"{name} ({_text(device / 'idVendor')}:{_text(device / 'idProduct')})")
    return found


def _text(file: Path) -> str:
    try:
        return file.read_text(errors="replace").strip()
    except OSError:  # it was unplugged meanwhile
        return ""

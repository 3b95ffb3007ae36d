"""The event devices of Linux as a HidBackend, and everything an operator may hold: HID devices and these beside them.

No device is listed twice: one that hidraw has and this user may open is a HID device, any other an event device.
"""

from __future__ import annotations

import importlib.util
import os
import sys
from collections.abc import Callable, Sequence
from functools import cache
from pathlib import Path

from teleop.core.errors import DeviceError
from teleop.inputs.evdev.device import EventDevice, EventSource
from teleop.inputs.evdev.nodes import DEV, SYS, EventNode, event_nodes
from teleop.inputs.hid.backend import DeviceInfo, Hidapi, HidBackend, HidDevice, MissingPackageError

INSTALL = "pip install 'rs-teleop[evdev]'"


@cache
def has_package() -> bool:
    """Whether the evdev package is installed, an extra: it has wheels for few machines."""
    return importlib.util.find_spec("evdev") is not None


def missing_package() -> str:
    """The command that makes pads readable whose reports are not described; "" where nothing is missing."""
    return INSTALL if sys.platform == "linux" and not has_package() else ""


def is_read_here(node: EventNode, package: bool) -> bool:
    """Whether the event device is read instead of hidraw; without the `package` only where hidraw has nothing."""
    return node.is_preferred and (package or not node.has_open_hidraw)


def open_events(path: Path) -> EventSource:
    """The device by the evdev package; raises OSError when it may not be opened, is gone, or evdev is not installed."""
    try:
        from evdev import InputDevice
    except ImportError:
        raise MissingPackageError(f"needs the package evdev: {INSTALL}") from None
    return InputDevice(path)


class EventBackend:
    """The joysticks and gamepads that have an event device; there are none on another system than Linux."""

    def __init__(self, sys: Path = SYS, dev: Path = DEV, open_: Callable[[Path], EventSource] = open_events) -> None:
        self._sys, self._dev, self._open = sys, dev, open_
        self.has_package = open_ is not open_events or has_package()

    def nodes(self) -> Sequence[EventNode]:
        return list(event_nodes(self._sys, self._dev))

    def has(self, path: bytes) -> bool:
        """Whether this is the path of an event device, and of no HID device."""
        return path.startswith(os.fsencode(self._dev / "input/event"))

    def enumerate(self) -> Sequence[DeviceInfo]:
        return [node.info for node in self.nodes()]

    def open(self, path: bytes) -> EventDevice:
        node = next((node for node in self.nodes() if os.fsencode(node.path) == path), None)
        if node is None:
            raise OSError("no such device")
        source = self._open(node.path)
        try:
            return EventDevice(source, node.keeps_names)
        except OSError:
            source.close()
            raise


class AllDevices:
    """A HidBackend of both; raises DeviceError when neither can be read here."""

    def __init__(self, hid: HidBackend | None = None, events: EventBackend | None = None) -> None:
        self._events = events or EventBackend()
        self._hid = hid or _hidapi()
        self._open: set[bytes] = set()  # a device that is read stays what it is, whatever becomes of permissions

    def enumerate(self) -> Sequence[DeviceInfo]:
        nodes = self._events.nodes()
        by_events = [node for node in nodes if self._is_by_events(node)]
        hidden = {os.fsencode(path) for node in by_events for path in node.hidraw}
        hid = self._hid.enumerate() if self._hid else ()
        return [*(info for info in hid if info.path not in hidden), *(node.info for node in by_events)]

    def open(self, path: bytes) -> HidDevice:
        backend = self._events if self._events.has(path) or self._hid is None else self._hid
        device = _Counted(backend.open(path), lambda: self._open.discard(path))
        self._open.add(path)
        return device

    def _is_by_events(self, node: EventNode) -> bool:
        if os.fsencode(node.path) in self._open:
            return True
        here = is_read_here(node, self._events.has_package)
        return here and not self._open & {os.fsencode(path) for path in node.hidraw}


class _Counted:
    """A device that says when it is closed."""

    def __init__(self, device: HidDevice, on_close: Callable[[], None]) -> None:
        self._device, self._on_close = device, on_close
        self.get_report_descriptor, self.read = device.get_report_descriptor, device.read
        self.get_input_report = device.get_input_report

    def close(self) -> None:
        try:
            self._device.close()
        finally:
            self._on_close()


def _hidapi() -> HidBackend | None:
    """None where hidapi is missing and event devices are there instead."""
    try:
        return Hidapi()
    except DeviceError:
        if sys.platform != "linux":
            raise
        return None

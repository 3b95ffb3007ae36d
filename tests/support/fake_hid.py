"""HID devices that speak bytes: plugged in, reporting and pulled out by a test, seen as hidapi shows them."""

from __future__ import annotations

import json
import queue
from collections.abc import Callable, Mapping, Sequence
from functools import cache
from pathlib import Path
from typing import Any

from waiting import wait_until

from teleop.inputs.hid.backend import DeviceInfo

PLUGGED, GAMEPAD, JOYSTICK, KEYBOARD = b"/dev/hidraw0", (1, 5), (1, 4), (1, 6)
_VECTORS = Path(__file__).parents[1] / "data" / "hid.json"


@cache
def vectors() -> Mapping[str, Any]:
    return json.loads(_VECTORS.read_text())


def real(name: str, bus: str = "") -> Mapping[str, Any]:
    """The published device whose name begins so."""
    return next(
        each for each in vectors()["devices"] if each["name"].startswith(name) and each["bus"] in (bus or each["bus"],)
    )


class FakeDevice:
    """A device with this descriptor. `answers` is what it gives when asked, None: it does not answer."""

    def __init__(
        self,
        descriptor: bytes,
        ids: tuple[int, int] = (0x1234, 0x5678),
        name: str = "Pad",
        usage: tuple[int, int] = GAMEPAD,
        path: bytes = PLUGGED,
        serial: str = "",
        answers: Callable[[int], bytes] | None = None,
    ) -> None:
        self.info = DeviceInfo(path, *ids, serial, name, *usage, 0)
        self.descriptor, self.answers = descriptor, answers
        self.asked: list[int] = []
        self.reads = 0  # one more begins once the answer to the last question has been taken
        self.opened = self.closed = 0
        self.may_be_opened = True
        self._given = self._taken = self._handled = 0
        self._reports: queue.SimpleQueue[bytes | None] = queue.SimpleQueue()

    def report(self, *reports: bytes) -> None:
        """Send these; whoever reads them gets to it when they do."""
        for report in reports:
            self._given += 1
            self._reports.put(report)

    def told(self, *reports: bytes) -> None:
        """Send these, and wait until the reader has come back for more."""
        self.report(*reports)
        wait_until(lambda: self._handled == self._given, "that the reports are read")

    def pull(self) -> None:
        self._reports.put(None)

    def get_report_descriptor(self) -> bytes:
        return self.descriptor

    def read(self, timeout: float) -> bytes:
        self._handled = self._taken
        self.reads += 1
        try:
            report = self._reports.get(timeout=timeout)
        except queue.Empty:
            return b""
        if report is None:
            raise OSError("read error")
        self._taken += 1
        return report

    def get_input_report(self, report_id: int, length: int) -> bytes:
        self.asked.append(report_id)
        if self.answers is None:
            raise OSError("get input report: Broken pipe")
        return self.answers(report_id)[:length]

    def close(self) -> None:
        self.closed += 1


class BrokenDevice(FakeDevice):
    """Opens, and fails at read number `good`, counted from 0, as one behind a loose contact does."""

    good = 0
    _reads = 0

    def read(self, timeout: float) -> bytes:
        self._reads += 1
        if self._reads > self.good:
            self._reads = 0
            raise OSError(5, "Input/output error")
        return b""


class FakeBackend:
    def __init__(self, *devices: FakeDevice) -> None:
        self.devices = list(devices)
        self.looks = 0

    def enumerate(self) -> Sequence[DeviceInfo]:
        self.looks += 1
        return [device.info for device in self.devices]

    def open(self, path: bytes) -> FakeDevice:
        device = next(device for device in self.devices if device.info.path == path)
        if not device.may_be_opened:
            raise OSError("open failed")
        device.opened += 1
        return device

    def plug(self, device: FakeDevice) -> None:
        self.devices.append(device)

    def unplug(self, device: FakeDevice) -> None:
        self.devices.remove(device)
        device.pull()

"""Writes a recording of a device while it is used: what `recording` reads."""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Sequence
from typing import TextIO

from teleop.inputs.hid.backend import DeviceInfo, HidBackend, HidDevice, same_model, unit

WAIT = 0.05  # s for a report
LOOK_EVERY = 0.5  # s between two looks for a device that was unplugged


class Recorder:
    """Records the device of `infos`, once for each of its usages, to `stream`; the serial number only if asked for.

    Raises OSError where the device cannot be opened.
    """

    def __init__(
        self,
        backend: HidBackend,
        infos: Sequence[DeviceInfo],
        stream: TextIO,
        now: Callable[[], float],
        serial: bool = False,
    ) -> None:
        self._backend, self._info, self._stream, self._now = backend, infos[0], stream, now
        self._device: HidDevice | None = backend.open(self._info.path)
        self._begin = self._looked = now()
        self.reports = 0
        self._write(
            device={
                "name": self._info.name if serial else _without(self._info.serial, self._info.name),
                "vendor": f"{self._info.vendor_id:04x}",
                "product": f"{self._info.product_id:04x}",
                "serial": self._info.serial if serial else "",
                "interface": self._info.interface,
                "usages": [[info.usage_page, info.usage] for info in infos],
                **({"port": self._info.port} if self._info.port else {}),
                **({"driver": self._info.driver} if self._info.driver else {}),
            },
            descriptor=self._device.get_report_descriptor().hex(),
        )

    @property
    def seconds(self) -> float:
        return self._now() - self._begin

    def step(self, pause: Callable[[float], object]) -> None:
        """Wait a moment for a report, or with `pause` for the device to come back, and write what happened."""
        if self._device is None:
            pause(LOOK_EVERY)
            self._find()
            return
        try:
            report = self._device.read(WAIT)
        except OSError:
            self._device.close()
            self._device = None
            self._write(time=self._time, unplugged=True)
            return
        if report:
            self.reports += 1
            self._write(time=self._time, report=report.hex())

    def close(self) -> None:
        if self._device is not None:
            self._device.close()

    def _find(self) -> None:
        try:
            found = self._backend.enumerate()
            again = [info for info in found if same_model(info, self._info) and info.serial == self._info.serial]
            again.sort(key=lambda info: unit(info) != unit(self._info))
            if again:
                self._device = self._backend.open(again[0].path)
                self._write(time=self._time, plugged=True)
        except OSError:  # it is not ready yet
            self._device = None

    @property
    def _time(self) -> float:
        return round(self.seconds, 4)

    def _write(self, **record: object) -> None:
        self._stream.write(json.dumps(record) + "\n")
        self._stream.flush()


def _without(serial: str, name: str) -> str:
    """The name without the serial number that some devices have in it."""
    return re.sub(re.escape(serial), "", name, flags=re.IGNORECASE).strip(" -()[]") if serial else name

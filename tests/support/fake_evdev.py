"""Event devices that speak struct input_event over a pipe, and the sysfs tree that lists them."""

from __future__ import annotations

import errno
import os
import shutil
import struct
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from teleop.inputs.evdev.backend import EventBackend

SYN, KEY, REL, ABS = 0, 1, 2, 3
X, Y, Z, RX, RY, RZ, HAT_X, HAT_Y = 0, 1, 2, 3, 4, 5, 16, 17
SOUTH, EAST, NORTH, WEST, MENU = 0x130, 0x131, 0x133, 0x134, 0x13B
XBOX_BUTTONS = (0x130, 0x131, 0x133, 0x134, 0x136, 0x137, 0x13A, 0x13B, 0x13C, 0x13D, 0x13E)
_EVENT = struct.Struct("@llHHi")
_WORD = 8 * struct.calcsize("l")


@dataclass
class Axis:
    value: int
    min: int
    max: int


def xbox_axes() -> dict[int, Axis]:
    """As xpad describes an Xbox One pad (drivers/input/joystick/xpad.c, xpad_set_up_abs)."""
    sticks = {code: Axis(0, -32768, 32767) for code in (X, Y, RX, RY)}
    return {**sticks, **{code: Axis(0, 0, 1023) for code in (Z, RZ)}, **{code: Axis(0, -1, 1) for code in (16, 17)}}


class FakeEvents:
    """An EventSource: what the kernel says of this device, and a pipe for its events."""

    def __init__(
        self, axes: Mapping[int, Axis] | None = None, keys: Sequence[int] = XBOX_BUTTONS, wheels: Sequence[int] = ()
    ) -> None:
        self.axes, self.keys, self.wheels = dict(xbox_axes() if axes is None else axes), list(keys), list(wheels)
        self.held: set[int] = set()
        self.gone = False
        self.grabbed = self.closed = 0
        self.fd, self._end = os.pipe()
        os.set_blocking(self.fd, False)

    def capabilities(self) -> Mapping[int, Sequence[Any]]:
        found: dict[int, list[Any]] = {SYN: [0, 1, 3], KEY: self.keys, ABS: list(self.axes.items()), REL: self.wheels}
        return {kind: codes for kind, codes in found.items() if codes}

    def absinfo(self, axis_num: int) -> Axis:
        self._raise_if_gone()
        return self.axes[axis_num]

    def active_keys(self) -> Sequence[int]:
        self._raise_if_gone()
        return sorted(self.held)

    def grab(self) -> None:
        self.grabbed += 1

    def close(self) -> None:
        self.closed += 1
        os.close(self.fd)

    def raw(self, *events: tuple[int, int, int]) -> None:
        """These events as the kernel writes them, without a SYN_REPORT behind them."""
        os.write(self._end, b"".join(_EVENT.pack(1, 2, *event) for event in events))

    def frame(self, *events: tuple[int, int, int]) -> None:
        """A frame of events; what the kernel knows of the device changes with it."""
        for kind, code, value in events:
            if kind == ABS:
                self.axes[code].value = value
            elif kind == KEY:
                (self.held.add if value else self.held.discard)(code)
        self.raw(*events, (SYN, 0, 0))

    def pull(self) -> None:
        self.gone = True
        os.close(self._end)

    def _raise_if_gone(self) -> None:
        if self.gone:
            raise OSError(errno.ENODEV, "No such device")


class FakeMachine:
    """A /sys and a /dev below `root`, with the devices that a test plugs in."""

    def __init__(self, root: Path) -> None:
        self.sys, self.dev = root / "sys", root / "dev"
        (self.sys / "class/input").mkdir(parents=True)
        (self.dev / "input").mkdir(parents=True)
        self.devices: dict[Path, FakeEvents] = {}
        self.backend = EventBackend(self.sys, self.dev, self._open)

    def plug(
        self,
        events: FakeEvents,
        number: int = 5,
        *,
        name: str = "Microsoft X-Box One pad",
        ids: tuple[int, int] = (0x045E, 0x02EA),
        parent: str = "1-1:1.0",
        driver: str = "xpad",
        bus: int = 3,
        hidraw: Collection[str] = (),
        properties: int = 0,
        serial: str = "",
    ) -> Path:
        """The event device's path; without a `parent` a program has made it. `hidraw` are nodes beside it."""
        above = self.sys / "devices" / (parent or "virtual")
        device = above / f"input/input{number}"
        (device / f"event{number}").mkdir(parents=True)
        (device / f"event{number}/device").symlink_to(device)
        (self.sys / f"class/input/event{number}").symlink_to(device / f"event{number}")
        if parent:
            (device / "device").symlink_to(above)
            (self.sys / "drivers" / driver).mkdir(parents=True, exist_ok=True)
            (above / "driver").unlink(missing_ok=True)
            (above / "driver").symlink_to(self.sys / "drivers" / driver)
        for node in hidraw:
            (above / "hidraw" / node).mkdir(parents=True)
            (self.dev / node).touch()
        texts = {"name": name, "uniq": serial, "properties": f"{properties:x}", "id/bustype": f"{bus:04x}"}
        masks = {"capabilities/key": _mask(events.keys), "capabilities/abs": _mask(events.axes)}
        ids_text = {"id/vendor": f"{ids[0]:04x}", "id/product": f"{ids[1]:04x}"}
        for file, text in {**texts, **masks, **ids_text}.items():
            (device / file).parent.mkdir(exist_ok=True)
            (device / file).write_text(text + "\n")
        path = self.dev / f"input/event{number}"
        path.touch()
        self.devices[path] = events
        return path

    def unplug(self, path: Path) -> None:
        events = self.devices.pop(path)
        entry = self.sys / "class/input" / path.name
        shutil.rmtree(entry.resolve().parent)
        entry.unlink()
        path.unlink()
        events.pull()

    def _open(self, path: Path) -> FakeEvents:
        if path not in self.devices:
            raise OSError(errno.ENODEV, "No such device")
        if not os.access(path, os.R_OK):
            raise PermissionError(errno.EACCES, "Permission denied", str(path))
        return self.devices[path]


def _mask(codes: Collection[int]) -> str:
    """As sysfs prints a bit mask: words, none filled up with zeros, leading empty ones left out."""
    mask, words = sum(1 << code for code in codes), []
    while mask:
        words.insert(0, f"{mask & (1 << _WORD) - 1:x}")
        mask >>= _WORD
    return " ".join(words or ["0"])

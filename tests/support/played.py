"""Recordings of devices that a test makes up, played by `teleop live --fast` on the simulated rig, in this process."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pytest
from hid_bench import item, smallest

from teleop.api import read_take
from teleop.cli import run
from teleop.core.axes import Axis

RIG = (Path(__file__).parents[2] / "profiles" / "sim.yaml").read_text()
DESKTOP, BUTTON, CONSUMER, VENDOR = 0x01, 0x09, 0x0C, 0xFF00
X, Y, Z, RX, RY, RZ, SLIDER, DIAL, WHEEL, HAT = range(0x30, 0x3A)
JOYSTICK, GAMEPAD, MOUSE, KEYBOARD = (DESKTOP, 4), (DESKTOP, 5), (DESKTOP, 2), (DESKTOP, 6)
DATA, CONSTANT, RELATIVE, NULL = 0x02, 0x03, 0x06, 0x42  # flags of an Input item


def inputs(usages: Sequence[int], low: int, high: int, size: int, flags: int = DATA, page: int = DESKTOP) -> bytes:
    """Controls of `size` bits each with this logical range."""
    signed = low < 0 or high < 0
    return b"".join(
        (
            item(0x04, page, smallest(page, signed=False)),
            item(0x14, low, smallest(low, signed=True)),
            item(0x24, high, smallest(high, signed=signed)),
            item(0x74, size, 1),
            item(0x94, len(usages), 1),
            *(item(0x08, usage, 1) for usage in usages),
            item(0x80, flags, 1),
        )
    )


def padding(bits: int) -> bytes:
    return item(0x74, bits, 1) + item(0x94, 1, 1) + item(0x80, CONSTANT, 1)


def report_id(number: int) -> bytes:
    """What follows is in the report with this id."""
    return item(0x84, number, 1)


def physical(low: int, high: int) -> bytes:
    return item(0x34, low, smallest(low, signed=True)) + item(0x44, high, smallest(high, signed=low < 0 or high < 0))


def collection(usage: tuple[int, int], *parts: bytes, report: int = 0) -> bytes:
    """A top-level collection, in a report with this id if it has one."""
    page, of = usage
    number = report_id(report) if report else b""
    begin = item(0x04, page, smallest(page, signed=False)) + item(0x08, of, 1) + item(0xA0, 1, 1)
    return b"".join((begin, number, *parts, b"\xc0"))


Rows = Sequence[tuple[float, bytes | None]]
"""Time and report; None unplugs the device, b"" plugs it in."""


def held(report: bytes, begin: float, end: float, every: float = 0.01) -> Rows:
    return [(begin + index * every, report) for index in range(round((end - begin) / every))]


def recorded(file: Path, descriptor: bytes, rows: Rows, **device: Any) -> Path:
    """A recording of this device in `file`."""
    known = {"name": "Strange pad", "vendor": "1234", "product": "5678", "serial": "", "interface": 0}
    identity = {**known, "usages": [list(JOYSTICK)], **device}
    lines: list[Mapping[str, Any]] = [{"device": identity, "descriptor": descriptor.hex()}]
    for time, report in rows:
        what = {"unplugged": True} if report is None else {"report": report.hex()} if report else {"plugged": True}
        lines.append({"time": round(time, 4), **what})
    file.write_text("".join(json.dumps(line) + "\n" for line in lines))
    return file


class Played(NamedTuple):
    """What came of it: the commanded motion, and the lines for the operator."""

    times: np.ndarray
    motion: Mapping[Axis, np.ndarray]
    lines: str

    def at(self, axis: Axis, time: float) -> float:
        return float(self.motion[axis][int(np.argmin(np.abs(self.times - time)))])

    def last(self, axis: Axis) -> float:
        return float(self.motion[axis][-1])

    @property
    def moved(self) -> set[Axis]:
        """The axes that moved at all."""
        return {axis for axis, positions in self.motion.items() if np.ptp(positions) > 1e-9}


class Player:
    """Plays recordings; a fixture gives it the folder and the standard error."""

    def __init__(self, folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
        self.folder, self._capsys, self._runs = folder, capsys, 0

    def device(self, descriptor: bytes, rows: Rows, **device: Any) -> Path:
        self._runs += 1
        return recorded(self.folder / f"device-{self._runs}.jsonl", descriptor, rows, **device)

    def refused(self, *recordings: Path, profile: str = "") -> str:
        """The line for recordings that cannot be played."""
        code, lines = self._run(recordings, profile)
        assert code == 2, lines
        assert lines.count("\n") == 1, lines
        return lines

    def play(self, *recordings: Path, profile: str = "") -> Played:
        code, lines = self._run(recordings, profile)
        assert not code, lines
        assert "Traceback" not in lines
        played = read_take(self._take)
        positions = {axis: states[0] for axis, states in played.motion.items()}
        return Played(played.times, positions, lines)

    @property
    def _take(self) -> Path:
        return self.folder / f"run-{self._runs}.mcap"

    def _run(self, recordings: Sequence[Path], profile: str) -> tuple[int, str]:
        self._runs += 1
        rig = self.folder / f"rig-{self._runs}.yaml"
        rig.write_text(RIG + profile)
        files = [word for file in recordings for word in ("--input-recording", str(file))]
        own = ["--rig", str(rig), "--presets", str(self.folder / "presets.yaml"), "--take", str(self._take)]
        code = run(["live", "--fast", *own, *files])
        return code, self._capsys.readouterr().err

"""Report descriptors to test with: published ones, and a writer of made ones that knows what their reports hold."""

from __future__ import annotations

import json
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from teleop.inputs.hid.descriptor.parser import parse_descriptor
from teleop.inputs.hid.descriptor.report import Control, read_report

VECTORS = json.loads((Path(__file__).parents[1] / "data" / "hid.json").read_text())
KNOWN: list[dict[str, Any]] = VECTORS["devices"] + VECTORS["made"]
DESCRIPTORS: list[bytes] = [bytes.fromhex(known["descriptor"]) for known in KNOWN]


def label(known: dict[str, Any]) -> str:
    return " ".join((known["name"], known.get("bus", "made")))


def as_expected(control: Control) -> dict[str, Any]:
    """A control in the words of the vectors."""
    return {
        "usage_page": control.usage_page,
        "usage": control.usage,
        "report_id": control.report_id,
        "logical_min": control.minimum,
        "logical_max": control.maximum,
        "value": control.value,
        "relative": control.relative,
        "null": control.null,
        **({} if control.raw is None else {"raw": control.raw}),
    }


def values(descriptor: str, report: str) -> list[tuple[str, int]]:
    """Name and value of each control, of a descriptor and a report in hexadecimal."""
    parsed = parse_descriptor(bytes.fromhex(descriptor))
    return [(control.name, control.value) for control in read_report(parsed, bytes.fromhex(report))]


def item(prefix: int, number: int, size: int) -> bytes:
    """A short item with `size` bytes of data; `prefix` is without its size bits."""
    data = (number % (1 << 8 * size)).to_bytes(size, "little")
    return bytes((prefix | (0, 1, 2, 2, 3)[size],)) + data


def smallest(number: int, *, signed: bool) -> int:
    """The bytes that a number needs in an item."""
    return next(
        size
        for size in (1, 2, 4)
        if (-(1 << 8 * size - 1) <= number < 1 << 8 * size - 1 if signed else 0 <= number < 1 << 8 * size)
    )


@dataclass(frozen=True)
class Written:
    """A run of controls of one main item: what its descriptor is to say, and what a report is to hold of it."""

    report_id: int
    size: int
    page: int
    usages: tuple[int, ...]
    count: int
    minimum: int
    maximum: int
    relative: bool = False
    has_null: bool = False
    constant: bool = False
    array: bool = False
    extended: bool = False
    as_range: bool = False
    raw: tuple[int, ...] = ()  # the numbers in the report, one for each of `count`

    def items(self, numbered: bool) -> bytes:
        flags = self.constant | (not self.array) << 1 | self.relative << 2 | self.has_null << 6
        signed = self.minimum < 0
        return b"".join(
            (
                item(0x84, self.report_id, 1) if numbered else b"",
                item(0x04, self.page, smallest(self.page, signed=False)),
                item(0x14, self.minimum, smallest(self.minimum, signed=True)),
                item(0x24, self.maximum, smallest(self.maximum, signed=signed)),
                item(0x74, self.size, 1),
                item(0x94, self.count, 2),
                *self._usages(),
                item(0x80, flags, 1),
            )
        )

    def _usages(self) -> Iterable[bytes]:
        size = 4 if self.extended else 2
        page = self.page << 16 if self.extended else 0
        if self.as_range and self.usages:
            yield item(0x18, page | self.usages[0], size)
            yield item(0x28, page | self.usages[-1], size)
        else:
            for usage in self.usages:
                yield item(0x08, page | usage, size)

    def expected(self) -> list[tuple[int, int, int, int, bool]]:
        """Report id, page, usage, value and null of each control."""
        if self.constant or not self.usages:
            return []
        found = []
        for place, raw in enumerate(self.raw):
            number = raw - (1 << self.size) if self.minimum < 0 and raw >> self.size - 1 else raw
            inside = self.minimum <= number <= self.maximum
            if not self.array:
                usage = self.usages[min(place, len(self.usages) - 1)]
                found.append((self.report_id, self.page, usage, number, self.has_null and not inside))
            elif inside and number - self.minimum < len(self.usages) and self.usages[number - self.minimum]:
                found.append((self.report_id, self.page, self.usages[number - self.minimum], 1, False))
        return found


def written_descriptor(runs: Sequence[Written]) -> bytes:
    """A joystick with these runs in its reports, which are numbered when any run has an id other than 0."""
    numbered = any(run.report_id for run in runs)
    return bytes.fromhex("05010904a101") + b"".join(run.items(numbered) for run in runs) + b"\xc0"


def written_report(runs: Sequence[Written], report_id: int) -> bytes:
    """The report with this id, bit by bit."""
    digits = ""  # the last bit of the report first
    for run in runs:
        if run.report_id == report_id:
            for raw in run.raw:
                digits = f"{raw:0{run.size}b}" + digits
    data = int(digits or "0", 2).to_bytes((len(digits) + 7) // 8, "little")
    return (bytes((report_id,)) if report_id else b"") + data


def renumbered(runs: Sequence[Written], numbered: bool) -> list[Written]:
    """The same runs in reports with ids, or all in the one report of a device without."""
    return [replace(run, report_id=max(run.report_id, 1) if numbered else 0) for run in runs]

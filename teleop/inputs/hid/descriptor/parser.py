"""What the reports of a HID device hold: its report descriptor, read by HID 1.11.

A descriptor is a program for a small machine: global items set its registers (which Push and Pop save), local items
collect usages, and each Input item turns the two into fields, one behind the other in the report whose id is in force.
Devices get it wrong in many ways, so nothing here raises: what can be read is read, and what cannot is a warning that
names the byte. Outputs, features, units and physical ranges move nothing that we read.

Sizes and counts are four bytes wide and a mad descriptor means them, so that fields are made up to a limit that no
device comes near, while offsets go on being counted.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

from teleop.inputs.hid.descriptor.fields import Field
from teleop.inputs.hid.descriptor.identity import named, primary
from teleop.inputs.hid.descriptor.items import Item, Kind, split
from teleop.inputs.hid.descriptor.usages import Local, Usages

MAX_REPORT = 16_384  # bytes without the id: what Linux takes from any HID transport
MAX_FIELD = 4_096  # bits; vendors' blobs are some hundreds
MAX_REPORT_FIELDS = 8_192  # the fullest report seen has 546
MAX_FIELDS = 65_536
MAX_WARNINGS = 20
MAX_COLLECTIONS = 256  # a receiver has a dozen

_CONSTANT, _VARIABLE, _RELATIVE, _NULL = 1, 2, 4, 64  # bits of an Input item (6.2.2.5)


@dataclass(frozen=True, eq=False)
class Descriptor:
    """The input fields in the order of the descriptor; those without a usage and constants are left out.

    When `numbered`, the first byte of every report is its id; otherwise the only report has id 0. `lengths` is the
    bytes of each input report, its id included, as the descriptor has them. `collections` are the usages (page, usage)
    of the top-level collections, (0, 0) for fields outside of any.
    """

    fields: Sequence[Field]
    numbered: bool
    warnings: Sequence[str] = ()
    lengths: Mapping[int, int] = field(default_factory=dict)
    collections: Sequence[tuple[int, int]] = ()

    @property
    def purpose(self) -> tuple[int, int]:
        """The usage of the collection that a mapping is guessed for, (0, 0) where there is none."""
        index = primary(self.collections)
        return (0, 0) if index is None else self.collections[index]

    @property
    def primary_fields(self) -> Sequence[Field]:
        """The fields of that collection."""
        index = primary(self.collections)
        return [each for each in self.fields if each.collection == index]


@dataclass(frozen=True, slots=True)
class _Global:
    """The registers that Push saves. Whether the range is signed is known only when both ends of it are."""

    page: int = 0
    minimum: Item | None = None
    maximum: Item | None = None
    size: int = 0
    count: int = 0
    report_id: int = 0

    @property
    def range(self) -> tuple[int, int]:
        """The logical range: signed when its minimum is below 0, else up to all bits of the maximum."""
        low = self.minimum.signed if self.minimum else 0
        if self.maximum is None:
            return low, 0
        return low, self.maximum.signed if low < 0 else self.maximum.unsigned


def parse_descriptor(data: bytes) -> Descriptor:
    """Never raises, and takes time and memory for what `data` is long, not for what it claims."""
    machine = _Machine()
    items, cut = split(data)
    for item in items:
        machine.take(item)
    return machine.finish(cut)


class _Machine:
    def __init__(self) -> None:
        self._at = 0
        self._global = _Global()
        self._saved: list[_Global] = []
        self._local = Local(self._warn)
        self._open = 0  # collections
        self._collections: list[tuple[int, int]] = []  # the top-level ones, by their usages
        self._collection: int | None = None  # the index of the one that is open
        self._pending = False  # whether items have come that the next main item is to use
        self._fields: list[Field] = []
        self._per_report: Counter[int] = Counter()  # fields
        self._bits: Counter[int] = Counter()  # report id -> where its next field begins
        self._numbered = False
        self._warnings: dict[str, int] = {}  # text -> byte where it was first due

    def take(self, item: Item) -> None:
        self._at = item.at
        self._pending = item.kind in (Kind.GLOBAL, Kind.LOCAL)
        match item.kind:
            case Kind.MAIN:
                self._main(item)
            case Kind.GLOBAL:
                self._set(item)
            case Kind.LOCAL:
                self._collect(item)
            case _:
                self._warn("an item of the reserved type; skipped")

    def finish(self, cut: str) -> Descriptor:
        warnings = [f"byte {at}: {text}" for text, at in self._warnings.items()][:MAX_WARNINGS]
        if len(self._warnings) > MAX_WARNINGS:
            warnings.append(f"{len(self._warnings) - MAX_WARNINGS} more of this kind")
        if cut:
            warnings.append(cut)
        elif self._open:
            warnings.append(f"collections left open: {self._open}; the end may be missing")
        elif self._pending:
            warnings.append("the last items set up an input that does not come: the end may be missing")
        if not self._fields:
            warnings.append("no input has a usage: nothing can be read from its reports")
        elif self._numbered and 0 in self._bits:
            warnings.append("inputs come before the first report id and are in no report of this device")
        prefix = 1 if self._numbered else 0
        lengths = {number: prefix + min((bits + 7) // 8, MAX_REPORT) for number, bits in self._bits.items()}
        fields = tuple(named(self._fields, self._collections))
        return Descriptor(fields, self._numbered, tuple(warnings), lengths, tuple(self._collections))

    def _warn(self, text: str) -> None:
        self._warnings.setdefault(text, self._at)

    def _main(self, item: Item) -> None:
        usages = self._local.close(self._global.page)
        self._local = Local(self._warn)
        match item.tag:
            case 0x8:
                self._input(item.unsigned, usages)
            case 0xA:
                if not self._open:
                    self._begin_collection(usages)
                self._open += 1
            case 0xC:
                self._end_collection()
            case 0x9 | 0xB:  # outputs and features are in reports of their own
                pass
            case _:
                self._warn("a reserved main item; skipped")

    def _begin_collection(self, usages: Usages) -> None:
        if len(self._collections) >= MAX_COLLECTIONS:
            self._warn(f"more than {MAX_COLLECTIONS} collections: the rest count as one")
        else:
            self._collections.append(usages.at(0) or (0, 0))
        self._collection = len(self._collections) - 1

    def _end_collection(self) -> None:
        if not self._open:
            self._warn("a collection ends that did not begin")
        self._open = max(self._open - 1, 0)
        if not self._open:
            self._collection = None

    def _set(self, item: Item) -> None:
        number, state = item.unsigned, self._global
        match item.tag:
            case 0x0:
                self._global = replace(state, page=number & 0xFFFF)
            case 0x1:
                self._global = replace(state, minimum=item)
            case 0x2:
                self._global = replace(state, maximum=item)
            case 0x7:
                self._global = replace(state, size=number)
            case 0x8:
                self._report_id(number)
            case 0x9:
                self._global = replace(state, count=number)
            case 0xA:
                self._saved.append(state)
            case 0xB:
                self._pop()
            case 0x3 | 0x4 | 0x5 | 0x6:  # physical range, unit and its exponent
                pass
            case _:
                self._warn("a reserved global item; skipped")

    def _report_id(self, number: int) -> None:
        if not 1 <= number <= 255:
            self._warn(f"report id {number}: must be 1..255")
        self._numbered |= number > 0
        self._global = replace(self._global, report_id=number)

    def _pop(self) -> None:
        if self._saved:
            self._global = self._saved.pop()
        else:
            self._warn("a Pop without a Push; skipped")

    def _collect(self, item: Item) -> None:
        match item.tag:
            case 0x0:
                self._local.usage(item, self._global.page)
            case 0x1:
                self._local.minimum(item, self._global.page)
            case 0x2:
                self._local.maximum(item, self._global.page)
            case 0xA:
                self._local.delimiter(item)
            case 0x3 | 0x4 | 0x5 | 0x7 | 0x8 | 0x9:  # designators and strings
                pass
            case _:
                self._warn("a reserved local item; skipped")

    def _input(self, flags: int, usages: Usages) -> None:
        state = self._global
        bit = self._bits[state.report_id]
        self._bits[state.report_id] = bit + state.size * state.count
        if flags & _CONSTANT or not usages or not state.size:
            return
        count = self._room(bit, state)
        if not count:
            return
        if self._collection is None:  # an input outside of any collection
            self._collections.append((0, 0))
            self._collection = len(self._collections) - 1
        low, high = state.range
        if high < low:
            self._warn(f"a logical maximum of {high} is below the minimum of {low}")
        traits = {
            "relative": bool(flags & _RELATIVE),
            "has_null": bool(flags & _NULL),
            "collection": self._collection,
        }

        def made(bit: int, page: int, usage: int, **array: Any) -> Field:
            return Field(state.report_id, bit, state.size, page, usage, low, high, **traits, **array)

        if flags & _VARIABLE:
            places = range(bit, bit + count * state.size, state.size)
            self._fields += [made(place, *usage) for place, usage in zip(places, usages.of(count), strict=True)]
        else:
            self._fields.append(made(bit, *next(usages.of(1)), count=count, usages=usages))

    def _room(self, bit: int, state: _Global) -> int:
        """How many of the controls or numbers that begin at `bit` are to be read."""
        if state.size > MAX_FIELD:
            self._warn(f"inputs of {state.size} bits: more than {MAX_FIELD} are not read")
            return 0
        count = min(
            state.count,
            max(0, MAX_REPORT * 8 - bit) // state.size,
            MAX_REPORT_FIELDS - self._per_report[state.report_id],
            MAX_FIELDS - self._per_report.total(),
        )
        if count < state.count:
            self._warn(f"{state.count} inputs of {state.size} bits: only the first {count} are read")
        self._per_report[state.report_id] += count
        return count

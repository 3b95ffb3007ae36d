"""The reports of one device, from the thread that reads them to the thread that asks: nobody waits for the other.

The reader puts a whole new mapping of values in place of the old one, and queues what must not be lost between two
looks: every change of a button, every count of a wheel. Assigning an attribute and appending to a deque are atomic in
Python, so that neither side needs a lock.

Whether a device reports all the time or only when something changes is seen from the reports themselves: only the
first kind says the same twice, and then many times. Vendors' fields are left out of this and of all else: a pad has
clocks and gyroscopes there.
"""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import replace
from typing import NamedTuple

from teleop.inputs.hid.descriptor.names import usage_name
from teleop.inputs.hid.descriptor.parser import Descriptor, Field
from teleop.inputs.hid.descriptor.report import Control, read_report

STEADY = 20  # reports in a row without a change: more than any device that reports changes sends for one
MAX_CHANGES = 4096  # nobody asks for them while nothing runs
_VENDOR = 0xFF00  # the first usage page of vendors
_HAT = (0x01, 0x39)
_LONGEST_ARRAY = 1024  # names that are made of an array's usages
_DIRECTIONS = (("up", 0), ("right", 90), ("down", 180), ("left", 270))
_WITHIN = 60  # degrees: of eight places the two next to a direction count for it as well


class Sample(NamedTuple):
    """A control's value and its logical range; `null`: it says that it has no value."""

    value: float
    minimum: float
    maximum: float
    relative: bool = False
    null: bool = False

    @property
    def pressed(self) -> bool:
        """Beyond the middle: of a button its only other value, of a trigger its second half."""
        return not self.null and 2 * self.value > self.minimum + self.maximum


class Change(NamedTuple):
    """A control has a new value, or a relative one has counted."""

    time: float
    name: str
    sample: Sample


class HidState:
    """What a device with this descriptor has reported.

    `watched` are the controls whose every change is queued, `counting` says of some whether they report counts,
    whatever the descriptor says; `vital` are the reports by which the device is known to be alive.
    """

    def __init__(self, descriptor: Descriptor) -> None:
        fields = [field for field in descriptor.fields if field.usage_page < _VENDOR]
        self._descriptor = replace(descriptor, fields=tuple(fields))
        self.names = frozenset(name for field in fields for name in _names(field))
        self.relative = frozenset(name for field in fields if field.relative for name in _names(field))
        self.watched: Collection[str] = frozenset()
        self.counting: Mapping[str, bool] = {}
        self.vital: Collection[int] = frozenset(field.report_id for field in fields)
        self.values: Mapping[str, Sample] = {}
        self.last = self.differed = -math.inf  # when a report came, and when one was unlike the one before it
        self.opaque: tuple[int, float] | None = None  # id and time of a report without controls
        self._changes: deque[Change] = deque(maxlen=MAX_CHANGES)
        self._ids = {name: field.report_id for field in reversed(fields) for name in _names(field)}
        self._reports: dict[int, bytes] = {}
        self._held: dict[int, Mapping[str, Sample]] = {}
        self._same = 0

    @property
    def steady(self) -> bool:
        """Whether it has been seen to report without anything having changed."""
        return self._same >= STEADY

    def report_ids(self, names: Collection[str]) -> Sequence[int]:
        """The reports that these controls are in."""
        return sorted({self._ids[name] for name in names if name in self._ids})

    def is_described(self, report_id: int) -> bool:
        """Whether the descriptor has such a report at all, if only as a vendor's own."""
        return report_id in self._descriptor.lengths

    def length(self, report_id: int) -> int:
        """Bytes of a report, its id included where the device numbers its reports."""
        return self._descriptor.lengths.get(report_id, 0)

    def take(self, report: bytes, now: float, asked: bool = False) -> None:
        """A report as the device sent it, its id in front where it has one; `asked`: it did not come by itself."""
        number = report[0] if self._descriptor.numbered and report else 0
        if self._reports.get(number) != report:
            self._reports[number] = report
            self.differed = now
        held: dict[str, Sample] = {}
        for control in read_report(self._descriptor, report):
            for name, sample in _expand(control):
                if name in self.counting:
                    sample = sample._replace(relative=self.counting[name])
                held.setdefault(name, sample)  # a name stands for the first control that has it
        if not held:
            self.opaque = number, now
            return
        if number in self.vital:
            self.last = now
        before = self._held.get(number, {})
        held.update(_released(before.keys() - held.keys(), before))
        if not asked and self._same < STEADY:
            self._same = self._same + 1 if held == before and not any(map(_counts, held.values())) else 0
        self._held[number] = held
        for name, sample in held.items():
            if name in self.watched and (sample.value if sample.relative else sample != before.get(name, sample)):
                self._changes.append(Change(now, name, sample))
        self.values = {**self.values, **held} if len(self._held) > 1 else held

    def changes(self) -> Iterator[Change]:
        """What has been queued since the last call."""
        for _ in range(len(self._changes)):
            yield self._changes.popleft()


def _counts(sample: Sample) -> bool:
    return sample.relative and sample.value != 0


def _names(field: Field) -> list[str]:
    if field.usages is not None:
        return [usage_name(*usage) for usage in field.usages.of(min(len(field.usages), _LONGEST_ARRAY))]
    name = usage_name(field.usage_page, field.usage)
    if (field.usage_page, field.usage) == _HAT:
        return [name, *(f"{name} {direction}" for direction, _ in _DIRECTIONS)]
    return [name]


def _expand(control: Control) -> Iterator[tuple[str, Sample]]:
    """The control, and of a hat its four directions as buttons, two of them pressed when it points between them."""
    if control.raw is not None:
        yield control.name, Sample(1, 0, 1)
        return
    yield control.name, Sample(control.value, control.minimum, control.maximum, control.relative, control.null)
    if (control.usage_page, control.usage) == _HAT:
        places = control.maximum - control.minimum + 1
        let_go = control.null or not control.minimum <= control.value <= control.maximum or places <= 0
        angle = 0.0 if let_go else (control.value - control.minimum) * 360 / places
        for direction, at in _DIRECTIONS:
            towards = not let_go and abs((angle - at + 180) % 360 - 180) < _WITHIN
            yield f"{control.name} {direction}", Sample(int(towards), 0, 1)


def _released(gone: Collection[str], before: Mapping[str, Sample]) -> Iterator[tuple[str, Sample]]:
    """Controls that are no longer reported: what was on is off; of anything wider nothing is known any more."""
    for name in gone:
        if (before[name].minimum, before[name].maximum) == (0, 1):
            yield name, before[name]._replace(value=0)
        else:
            yield name, before[name]._replace(null=True, value=0 if before[name].relative else before[name].value)

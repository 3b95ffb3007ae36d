"""The reports of one device, from the thread that reads them to the thread that asks; neither waits for the other.

The reader puts a whole new mapping of values in place of the old one, and queues what must not be lost between two
looks: every change of a button, every count of a wheel. Assigning an attribute and appending to a deque are atomic in
Python, so that neither side needs a lock.

Whether a device reports all the time or only when something changes, and how often, is seen from the reports
themselves (`Cadence`). Vendors' fields are left out of this and of all else: a pad has clocks and gyroscopes there.
"""

from __future__ import annotations

import math
from collections import defaultdict, deque
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import replace
from typing import NamedTuple

from teleop.inputs.hid.cadence import Cadence
from teleop.inputs.hid.descriptor.fields import VENDOR_PAGES, Field
from teleop.inputs.hid.descriptor.identity import LONGEST_ARRAY, MULTI_AXIS
from teleop.inputs.hid.descriptor.parser import Descriptor
from teleop.inputs.hid.descriptor.report import Control, read_report
from teleop.inputs.hid.hat import DIRECTIONS, HAT, Hat, points_to

MAX_CHANGES = 4096  # changes pile up while no run reads them


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


_ON = Sample(1, 0, 1)  # a control of an array that is there


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
        fields = [field for field in descriptor.fields if field.usage_page < VENDOR_PAGES]
        self._descriptor = replace(descriptor, fields=tuple(fields))
        self.names = frozenset(name for field in fields for name in _names(field))
        self.purpose = descriptor.purpose
        self.relative = frozenset(name for field in fields if field.relative for name in _names(field))
        primary = self._descriptor.primary_fields
        if self.purpose != MULTI_AXIS:  # whose places are called relative: what counts is no stick to be guessed
            primary = [field for field in primary if not field.relative]
        self.guessable = frozenset(name for field in primary for name in _names(field))
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
        self._blank: set[int] = set()  # whose latest report had no controls, though others had
        self._hats: dict[str, Hat] = {}
        self.cadence = Cadence()
        self._cadences: defaultdict[int, Cadence] = defaultdict(Cadence)  # of each report

    def is_overdue(self, names: Collection[str], now: float) -> bool:
        """Whether a report with one of these controls has ended, which was repeated all the time."""
        return any(self._cadences[number].is_overdue(now) for number in self.report_ids(names) if number in self._held)

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
        before = self._held.get(number, {})
        if self._reports.get(number) != report:
            self._reports[number] = report
            self.differed = now
            held = self._read(report)
        elif self.relative or self.counting or number in self._blank:
            held = self._read(report)
        else:
            held = before  # byte for byte, and nothing in it counts: what most reports of most devices are
        if not held:
            self._blank.add(number)
            self.opaque = number, now
            return
        self._blank.discard(number)
        if number in self.vital:
            self.last = now
        if held is before:
            self._count(number, True, now, asked)
            return
        if gone := before.keys() - held.keys():
            held = {**held, **dict(_released(gone, before))}
        self._count(number, held == before and not any(map(_counts, held.values())), now, asked)
        self._held[number] = held
        for name, sample in held.items():
            if name in self.watched and (sample.value if sample.relative else sample != before.get(name, sample)):
                self._changes.append(Change(now, name, sample))
        self.values = {**self.values, **held} if len(self._held) > 1 else held

    def _read(self, report: bytes) -> dict[str, Sample]:
        held: dict[str, Sample] = {}
        for control in read_report(self._descriptor, report):
            if control.usage_page < VENDOR_PAGES:  # an array's usage: fields of these pages are left out already
                self._add(control, held)
        for name in self.counting.keys() & held.keys():
            held[name] = held[name]._replace(relative=self.counting[name])
        return held

    def _count(self, number: int, repeats: bool, now: float, asked: bool) -> None:
        if not asked:
            self.cadence.take(repeats, now)
            self._cadences[number].take(repeats, now)

    def _add(self, control: Control, held: dict[str, Sample]) -> None:
        """The control, and of a hat its four directions as buttons."""
        name = control.name
        if control.raw is not None:
            held[name] = _ON
            return
        held[name] = Sample(control.value, control.minimum, control.maximum, control.relative, control.null)
        if (control.usage_page, control.usage) == HAT:
            hat = self._hats.setdefault(name, Hat())
            angle = hat.angle(control)
            for direction, at in DIRECTIONS:
                way = f"{name} {direction}"
                pressed = hat.first == direction if way in self.watched else points_to(angle, at)
                held[way] = Sample(int(pressed), 0, 1)

    def changes(self) -> Iterator[Change]:
        """What has been queued since the last call."""
        for _ in range(len(self._changes)):
            yield self._changes.popleft()


def _counts(sample: Sample) -> bool:
    return sample.relative and sample.value != 0


def _names(field: Field) -> list[str]:
    if field.usages is not None:
        return [field.array_name(*usage) for usage in field.usages.of(min(len(field.usages), LONGEST_ARRAY))]
    name = field.name
    if (field.usage_page, field.usage) == HAT:
        return [name, *(f"{name} {direction}" for direction, _ in DIRECTIONS)]
    return [name]


def _released(gone: Collection[str], before: Mapping[str, Sample]) -> Iterator[tuple[str, Sample]]:
    """Controls that are no longer reported: what was on is off; of anything wider nothing is known any more."""
    for name in gone:
        if (before[name].minimum, before[name].maximum) == (0, 1):
            yield name, before[name]._replace(value=0)
        else:
            yield name, before[name]._replace(null=True, value=0 if before[name].relative else before[name].value)

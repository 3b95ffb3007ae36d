"""An input report as its controls.

What can be known before a report comes is worked out once for each descriptor: shifts, masks and names, a row for each
control in the order of their bits, so that a report is one pass over a list.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping, Sequence
from functools import lru_cache
from typing import NamedTuple

from teleop.inputs.hid.descriptor.fields import Field
from teleop.inputs.hid.descriptor.parser import Descriptor


class Control(NamedTuple):
    """What one control says; `minimum` and `maximum` are its logical range, which a value may leave.

    `null`: the control is in its null state (a hat let go, out of a range that has such a state), whatever the value.
    Of an array only the controls that are on are there, with value 1 and the number that stood for them in `raw`; the
    range is that of these numbers.
    """

    report_id: int
    usage_page: int
    usage: int
    name: str
    value: int
    minimum: int
    maximum: int
    relative: bool
    null: bool
    raw: int | None = None


class _Row(NamedTuple):
    end: int  # bits of report that must have come
    shift: int
    mask: int
    sign: int  # the sign bit, 0 when there is none
    field: Field
    name: str
    ready: tuple[Control, Control] | None  # of a single bit, which most controls are


def read_report(descriptor: Descriptor, report: bytes) -> list[Control]:
    """The controls of `report`, whose first byte is its id when the descriptor is numbered.

    Fields that a short report does not reach are left out; a report that the descriptor does not know has none.
    """
    plans = _plans(descriptor)
    if not descriptor.numbered:
        rows = plans.get(0, ())
    elif report:
        rows = plans.get(report[0], ())
        report = report[1:]
    else:
        rows = ()
    if not rows:
        return []
    bits = int.from_bytes(report[: (rows[-1].end + 7) // 8], "little")
    available = len(report) * 8
    controls = []
    for end, shift, mask, sign, field, name, ready in rows:
        if end > available:
            break
        value = bits >> shift & mask
        if ready:
            controls.append(ready[value])
            continue
        if value & sign:
            value -= sign << 1
        if field.usages is None:
            controls.append(_variable(field, name, value))
        elif on := _on(field, value):
            controls.append(on)
    return controls


def _variable(field: Field, name: str, value: int) -> Control:
    low, high = field.minimum, field.maximum
    null = field.has_null and not low <= value <= high
    return Control(field.report_id, field.usage_page, field.usage, name, value, low, high, field.relative, null)


def _on(field: Field, number: int) -> Control | None:
    """The control of an array that `number` stands for; a number out of range, or without a usage, is none.

    Nor is usage 0, which every page keeps for "nothing": an idle keyboard sends it in each of its places.
    """
    low, high = field.minimum, field.maximum
    if field.usages is None or not low <= number <= high:
        return None
    found = field.usages.at(number - low)
    if found is None or not found[1]:
        return None
    return Control(field.report_id, *found, field.array_name(*found), 1, low, high, field.relative, False, number)


@lru_cache(maxsize=64)  # devices plugged in at one time; a descriptor is itself, so that looking it up costs nothing
def _plans(descriptor: Descriptor) -> Mapping[int, Sequence[_Row]]:
    plans: defaultdict[int, list[_Row]] = defaultdict(list)
    for field in descriptor.fields:
        plans[field.report_id] += _rows(field)
    return dict(plans)


def _rows(field: Field) -> list[_Row]:
    name = field.name
    sign = 1 << (field.size - 1) if field.signed else 0
    ready = None
    if field.size == 1 and field.usages is None:
        ready = _variable(field, name, 0), _variable(field, name, -1 if sign else 1)
    return [
        _Row(shift + field.size, shift, (1 << field.size) - 1, sign, field, name, ready)
        for shift in range(field.bit, field.bit + field.count * field.size, field.size)
    ]

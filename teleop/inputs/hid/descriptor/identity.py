"""Which control is which: a name for each field of each report of each collection, no two of a device the same.

Two fields of one usage are two controls, whatever report or collection they are in. In the primary collection, the
first joystick or gamepad, a control is called by its usage: `Slider`, and the second one `Slider 2`. A control of
another collection has that collection in front where the bare name is taken, or where the collection is one more of
its kind: `mouse: X`, `joystick 2: Button 1`. Vendors' fields are not mapped, so they keep the bare name of their usage.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import replace

from teleop.inputs.hid.descriptor.fields import VENDOR_PAGES, Field
from teleop.inputs.hid.descriptor.names import usage_name

Usage = tuple[int, int]
MULTI_AXIS: Usage = (0x01, 0x08)
STICKS: frozenset[Usage] = frozenset({(0x01, 0x04), (0x01, 0x05), MULTI_AXIS})  # joystick, gamepad, multi-axis
NOT_STICKS: frozenset[Usage] = frozenset({(0x01, 0x01), (0x01, 0x02), (0x01, 0x06), (0x01, 0x07)})
"""Pointer, mouse, keyboard, keypad: a mapping for these is never guessed."""

LONGEST_ARRAY = 1024  # usages of an array that get a name of their own
MAX_NAMES = 131_072  # of a device, once for each array that has it; the fullest seen has some thousands


def primary(collections: Sequence[Usage]) -> int | None:
    """The index of the collection that a mapping is guessed for, None where there is only a mouse or a keyboard."""
    for fits in (STICKS.__contains__, lambda usage: usage not in NOT_STICKS):
        if (found := next((index for index, usage in enumerate(collections) if fits(usage)), None)) is not None:
            return found
    return None


def named(fields: Sequence[Field], collections: Sequence[Usage]) -> list[Field]:
    """The same fields with their names; those beyond `MAX_NAMES` names are left out."""
    first = primary(collections)
    order = sorted(range(len(fields)), key=lambda index: fields[index].collection != first)
    naming = _Naming(collections, first)
    result = list(fields)
    kept = len(fields)
    for index in order:
        field = fields[index]
        if field.usage_page >= VENDOR_PAGES:
            continue
        if naming.given >= MAX_NAMES:
            kept = min(kept, index)
        elif field.usages is None:
            naming.given += 1
            name = naming.unique(field.collection, (field.usage_page, field.usage))
            if name != field.name:
                result[index] = replace(field, label=name)
        elif names := naming.array(field):
            result[index] = replace(field, array_names=names)
    return result[:kept]


class _Naming:
    def __init__(self, collections: Sequence[Usage], first: int | None) -> None:
        self.taken: set[str] = set()
        self.given = 0  # names, also those that arrays share
        self._prefixes: list[str] = []
        self._again: list[bool] = []  # whether it is one more of its kind
        self._next: Counter[str] = Counter()
        self._arrays: dict[tuple[int, int, int, int], str] = {}
        self._first = first
        kinds: Counter[Usage] = Counter()
        for usage in collections:
            kinds[usage] += 1
            number = f" {kinds[usage]}" if kinds[usage] > 1 else ""
            self._prefixes.append(f"{usage_name(*usage).lower()}{number}: " if usage != (0, 0) else "")
            self._again.append(kinds[usage] > 1)

    def unique(self, collection: int, usage: Usage) -> str:
        name = usage_name(*usage)
        if collection != self._first and (self._again[collection] or name in self.taken):
            name = f"{self._prefixes[collection]}{name}"
        if name in self.taken:
            number = max(self._next[name], 2)
            while f"{name} {number}" in self.taken:
                number += 1
            self._next[name] = number + 1
            name = f"{name} {number}"
        self.taken.add(name)
        return name

    def array(self, field: Field) -> Mapping[Usage, str]:
        """The names that are not those of the usages alone; arrays of one report share their controls."""
        names: dict[Usage, str] = {}
        usages = field.usages
        for usage in usages.of(min(len(usages), LONGEST_ARRAY)) if usages is not None else ():
            self.given += 1
            key = (field.collection, field.report_id, *usage)
            name = self._arrays.get(key) or self._arrays.setdefault(key, self.unique(field.collection, usage))
            if name != usage_name(*usage):
                names[usage] = name
        return names

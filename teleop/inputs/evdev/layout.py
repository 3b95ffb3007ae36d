"""An event device's controls as a HID descriptor and reports, so that all that reads HID devices reads it too.

The kernel turns a HID device's usages into event codes (drivers/hid/hid-input.c); here the codes are turned back, so
that a control has the same name either way: BTN_SOUTH and BTN_TRIGGER are `Button 1`, ABS_GAS is `Accelerator`. Drivers
that are no HID drivers (xpad) use the codes of the kernel's Documentation/input/gamepad.rst; of these a d-pad of four
buttons is a `Hat switch` as well, which is what most pads have.
"""

from __future__ import annotations

import struct
from collections.abc import Collection, Iterator, Mapping
from typing import NamedTuple, Protocol

KEY, REL, ABS = 1, 2, 3  # event types
_DESKTOP, _SIMULATION, _BUTTON, _CONSUMER = 0x01, 0x02, 0x09, 0x0C
_HATS = range(0x10, 0x18, 2)  # ABS_HAT0X to ABS_HAT3X; each has its Y behind it
_LAST_AXIS = 0x2E  # from 0x2F on: fingers on a touch pad
_RELEASED = 8  # of a hat of 0..7: its null state
_PLACES = {(0, -1): 0, (1, -1): 1, (1, 0): 2, (1, 1): 3, (0, 1): 4, (-1, 1): 5, (-1, 0): 6, (-1, -1): 7}
_D_PADS = ((0x220, 0x223, 0x221, 0x222), (0x2C2, 0x2C1, 0x2C3, 0x2C0))  # up, right, down, left; the second is xpad's
_ABSOLUTE = {**{code: (_DESKTOP, 0x30 + code) for code in range(9)}, 9: (_SIMULATION, 0xC4), 10: (_SIMULATION, 0xC5)}
_PLAIN = {6: (_SIMULATION, 0xBB), 7: (_SIMULATION, 0xBA), 8: (_SIMULATION, 0xC8)}  # throttle, rudder, wheel: no HID
_KEYS = {0x8B: 0x40, 0x9E: 0x224, 0xA7: 0xB2, 0xAC: 0x223}  # menu, back, record (an Xbox pad's Share), home page
_GRIPS = {0x224: 23, 0x225: 21, 0x226: 24, 0x227: 22}  # paddles since Linux 6.17; before they were buttons 21 to 24
_COUNTS = 32767  # a relative axis's range


class AxisInfo(Protocol):
    """An absolute axis as the kernel knows it; evdev's AbsInfo."""

    @property
    def value(self) -> int: ...
    @property
    def min(self) -> int: ...
    @property
    def max(self) -> int: ...


class _Field(NamedTuple):
    usage: tuple[int, int]
    minimum: int
    maximum: int
    codes: tuple[tuple[int, int], ...]  # of one control: its event; of a hat two axes or four buttons
    size: int = 8  # bits
    flags: int = 0x02  # data, variable, absolute (HID 1.11 section 6.2.2.5)


class Layout:
    """The controls of a device with these `axes`, `keys` and `wheels` (codes of EV_ABS, EV_KEY and EV_REL).

    `keeps_names`: the codes come from a HID descriptor.
    """

    def __init__(
        self,
        axes: Mapping[int, AxisInfo],
        keys: Collection[int],
        wheels: Collection[int] = (),
        *,
        keeps_names: bool = False,
    ) -> None:
        hats = list(_hats(axes))
        d_pad = next((each for each in _D_PADS if not hats and not keeps_names and set(each) <= set(keys)), None)
        if d_pad:
            hats = [_hat(tuple((KEY, code) for code in d_pad))]
        sticks = list(_sticks(axes, keeps_names))
        taken = {field.usage for field in sticks}
        self._fields = [
            *sticks,
            *(field for field in map(_wheel, sorted(wheels)) if field.usage not in taken),
            *hats,
            *_buttons(sorted(set(keys) - set(d_pad or ()))),
        ]
        self.is_gamepad = any(0x130 <= code < 0x140 for code in keys)
        self.codes = frozenset(code for field in self._fields for code in field.codes)

    @property
    def descriptor(self) -> bytes:
        """The report descriptor: one application collection, one report without an id."""
        items = [b"\x05\x01\x09", b"\x05" if self.is_gamepad else b"\x04", b"\xa1\x01"]
        for (page, usage), low, high, _, size, flags in self._fields:
            items.append(struct.pack("<BIBiBi", 0x0B, page << 16 | usage, 0x17, low, 0x27, high))
            items.append(bytes([0x75, size, 0x95, 1, 0x81, flags]))
        return b"".join([*items, b"\xc0"])

    def report(self, values: Mapping[tuple[int, int], int]) -> bytes:
        """The report of these values by type and code; a code that is not there is 0."""
        return b"".join(_packed(field, [values.get(code, 0) for code in field.codes]) for field in self._fields)


def _sticks(axes: Mapping[int, AxisInfo], keeps_names: bool) -> Iterator[_Field]:
    for code, axis in sorted(axes.items()):
        if code in _HATS or code - 1 in _HATS or code > _LAST_AXIS:
            continue
        usage = (None if keeps_names else _PLAIN.get(code)) or _ABSOLUTE.get(code, (_DESKTOP, 0x100 + code))
        yield _Field(usage, axis.min, axis.max, ((ABS, code),), 32)


def _hats(axes: Collection[int]) -> Iterator[_Field]:
    return (_hat(((ABS, code), (ABS, code + 1))) for code in _HATS if code in axes and code + 1 in axes)


def _hat(codes: tuple[tuple[int, int], ...]) -> _Field:
    return _Field((_DESKTOP, 0x39), 0, 7, codes, flags=0x42)  # with a null state


def _wheel(code: int) -> _Field:
    usage = (_DESKTOP, 0x30 + code) if code <= 8 else (_DESKTOP, 0x200 + code)
    return _Field(usage, -_COUNTS, _COUNTS, ((REL, code),), 32, 0x06)


def _buttons(keys: Collection[int]) -> Iterator[_Field]:
    taken: set[tuple[int, int]] = set()
    for code in keys:
        usage = _button(code)
        if usage in taken:  # a stick and a pad in one: the kernel makes none, a program may
            usage = (_BUTTON, code)
        if usage is not None:
            taken.add(usage)
            yield _Field(usage, 0, 1, ((KEY, code),))


def _button(code: int) -> tuple[int, int] | None:
    if code in _KEYS:
        return _CONSUMER, _KEYS[code]
    if code < 0x100:  # a keyboard's
        return None
    if 0x220 <= code <= 0x223:
        return _DESKTOP, 0x90 + (0, 1, 3, 2)[code - 0x220]  # HID has the d-pad's right before its left
    if 0x120 <= code < 0x140:
        return _BUTTON, (code & 0x0F) + 1
    if 0x2C0 <= code < 0x2E8:
        return _BUTTON, code - 0x2C0 + 17
    return _BUTTON, _GRIPS.get(code, code)


def _packed(field: _Field, values: list[int]) -> bytes:
    if field.usage == (_DESKTOP, 0x39):
        if len(values) == 4:
            up, right, down, left = map(bool, values)
            values = [right - left, down - up]
        across, along = ((value > 0) - (value < 0) for value in values)
        return bytes([_PLACES.get((across, along), _RELEASED)])
    [value] = values
    if field.size == 8:
        return bytes([value != 0])
    return struct.pack("<i", max(value, 0) if field.minimum >= 0 else value)  # a range from 0 up is read unsigned

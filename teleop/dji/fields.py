"""What a message's field is on the wire: its bytes, its scale and unit, its words, its range, each in one place.

These objects stand in the annotations of message classes (`yaw: Annotated[float, I16(scale=10, unit="deg")]`);
message.py derives encoding, decoding, JSON and help from them. A range belongs to sending only: a device may report
what its document does not list, and that must pass unharmed in both directions.
"""

from __future__ import annotations

import struct
from dataclasses import dataclass
from enum import IntEnum
from functools import cache, partial
from math import isfinite, nan
from typing import Any

TRUTHS = {"true": True, "yes": True, "on": True, "1": True, "false": False, "no": False, "off": False, "0": False}


@cache
def members(words: type[IntEnum]) -> dict[int, IntEnum]:
    """Each member by its number."""
    return {member.value: member for member in words}


@dataclass(frozen=True, slots=True)
class Number:
    """A little-endian integer of struct format `code`; the field's value is the integer divided by `scale`, in `unit`.

    `low` and `high` bound the value for sending. `words` names the integers that the document knows: JSON and the
    command line use the lower-case names, and sending any other is refused.
    """

    code: str
    scale: int = 1
    unit: str = ""
    low: float | None = None
    high: float | None = None
    words: type[IntEnum] | None = None

    @property
    def room(self) -> str:
        return f"{8 * struct.calcsize(self.code)} bits"

    def to_wire(self, value: Any) -> int:
        """The integer, which may be too large for its bytes. Raises ValueError, OverflowError or TypeError."""
        return value if self.scale == 1 else round(value * self.scale)

    def from_wire(self, raw: int) -> Any:
        """The value; a number that the document does not know stays a number."""
        if self.words:
            return members(self.words).get(raw, raw)
        return raw if self.scale == 1 else raw / self.scale

    def holds(self, value: Any) -> bool:
        """Whether `value` fits the bytes, allowed or not."""
        try:
            struct.pack("<" + self.code, self.to_wire(value))
        except (struct.error, ValueError, OverflowError, TypeError, AttributeError):
            return False
        return True

    def to_json(self, value: Any) -> Any:
        return value.name.lower() if isinstance(value, IntEnum) else value

    def from_json(self, value: Any) -> Any:
        """A number, its text, or one of the words. Raises ValueError."""
        if isinstance(value, str):
            word = value.strip().upper()
            if self.words and word in self.words.__members__:
                return self.words[word]
            value = float(word) if self.scale != 1 else int(word, 0)
        if isinstance(value, bool) or not isinstance(value, int | float):
            raise ValueError("not a number")
        if self.scale == 1 and value != int(value):
            raise ValueError("not a whole number")
        if self.scale == 1:
            return members(self.words).get(int(value), int(value)) if self.words else int(value)
        return value

    def accepts(self, value: Any) -> bool:
        """Whether the document allows sending `value`, as rounded for the wire: 180.00001 deg is 180."""
        if self.words:
            return value in members(self.words)
        if self.scale != 1:
            value = round(value * self.scale) / self.scale if isfinite(value) else nan  # which no range has
        return (self.low is None or value >= self.low) and (self.high is None or value <= self.high)

    def requirement(self) -> str:
        """What a value must be, for an error and for help: `-180..180 deg`, `one of attitude, joint`."""
        if self.words:
            return ("one of " if len(self.words) > 1 else "") + ", ".join(member.name.lower() for member in self.words)
        if self.low is None or self.high is None:
            kind = "a number" if self.scale != 1 else "a whole number"
            return f"{kind}, {self.unit}" if self.unit else kind
        if self.low == self.high:
            return f"{self.low:g}"
        return f"{self.low:g}..{self.high:g} {self.unit}".rstrip()


U8 = partial(Number, "B")
U16 = partial(Number, "H")
U32 = partial(Number, "I")
I16 = partial(Number, "h")
I32 = partial(Number, "i")


@dataclass(frozen=True, slots=True)
class Bits(Number):
    """An integer in `width` bits of a byte, from bit `first` (0 is the lowest) up.

    Neighbouring fields of bits share one byte.
    """

    code: str = "B"
    first: int = 0
    width: int = 1

    @property
    def mask(self) -> int:
        """Of the shifted-down value; nothing for Reserved, which has what is left over."""
        return (1 << self.width) - 1

    @property
    def room(self) -> str:
        return f"{self.width} bits"

    def holds(self, value: Any) -> bool:
        return isinstance(value, int) and 0 <= value <= self.mask


@dataclass(frozen=True, slots=True)
class Flag(Bits):
    """One bit, as a bool."""

    def to_wire(self, value: Any) -> int:
        return 1 if value else 0

    def from_wire(self, raw: int) -> Any:
        return raw != 0

    def to_json(self, value: Any) -> Any:
        return bool(value)

    def from_json(self, value: Any) -> Any:
        if isinstance(value, str):
            value = TRUTHS.get(value.strip().lower())
        if not isinstance(value, bool):
            raise ValueError("neither true nor false")
        return value

    def accepts(self, value: Any) -> bool:
        return value in (False, True)

    def requirement(self) -> str:
        return "true or false"


@dataclass(frozen=True, slots=True)
class Reserved(Bits):
    """The bits of the byte that its other fields do not name, in their places.

    They are kept, because devices and peers set some of them, and refused for sending unless zero.
    """

    width: int = 0
    low: float | None = 0
    high: float | None = 0

    def holds(self, value: Any) -> bool:
        return isinstance(value, int) and 0 <= value <= 255


@dataclass(frozen=True, slots=True)
class DottedVersion(Number):
    """A u32 0xAABBCCDD as the text `AA.BB.CC.DD`, each part decimal (V2.5 section 2.3.4.10)."""

    code: str = "I"

    def to_wire(self, value: Any) -> int:
        return int.from_bytes(bytes(int(part) for part in value.split(".")), "big")

    def from_wire(self, raw: int) -> Any:
        return ".".join(f"{part:02d}" for part in raw.to_bytes(4, "big"))

    def from_json(self, value: Any) -> Any:
        if not self.accepts(value):
            raise ValueError("not a version")
        return value

    def accepts(self, value: Any) -> bool:
        parts = value.split(".") if isinstance(value, str) else []
        return len(parts) == 4 and all(part.isdecimal() and int(part) < 256 for part in parts)

    def requirement(self) -> str:
        return "a version such as 01.04.00.20"

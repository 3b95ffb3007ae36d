"""Fields that are no integers: floats and text of a fixed size, as the Onboard SDK has them.

Both keep every bit. A float travels as the integer of its bits, because reading one with struct quiets a signalling
NaN; JSON has neither NaN nor infinity, so these are words there. Text is padded with NUL, and any byte is a character
(Latin-1), because firmware has sent worse than ASCII.
"""

from __future__ import annotations

import struct
from dataclasses import dataclass
from functools import partial
from math import isfinite, isnan, nan
from typing import Any, Final

from teleop.dji.fields import Number

_FORMS: Final = {
    code: (struct.Struct("<" + code), struct.Struct("<" + form)) for code, form in (("I", "f"), ("Q", "d"))
}
_QUIET: Final = {"I": 0x7FC00000, "Q": 0x7FF8000000000000}  # the NaN that everybody means


class Nan(float):
    """A NaN that remembers its bits, and is equal to another with the same: so messages can be compared."""

    bits: int

    def __new__(cls, bits: int) -> Nan:
        made = super().__new__(cls, nan)
        made.bits = bits
        return made

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Nan) and other.bits == self.bits

    def __hash__(self) -> int:
        return hash(self.bits)


@dataclass(frozen=True, slots=True)
class Float(Number):
    """A little-endian float: of 32 bits with code `I`, of 64 with `Q`."""

    def to_wire(self, value: Any) -> int:
        if isinstance(value, Nan):
            return value.bits
        bits, form = _FORMS[self.code]
        return bits.unpack(form.pack(value))[0]

    def from_wire(self, raw: int) -> Any:
        bits, form = _FORMS[self.code]
        value = form.unpack(bits.pack(raw))[0]
        return Nan(raw) if isnan(value) else value

    def to_json(self, value: Any) -> Any:
        if isfinite(value):
            return value
        if isinstance(value, Nan) and value.bits != _QUIET[self.code]:
            return f"nan:{value.bits:#x}"
        return str(float(value))

    def from_json(self, value: Any) -> Any:
        """A number, or its text, `nan`, `inf` and `nan:` with the bits included. Raises ValueError."""
        if isinstance(value, str):
            word, colon, bits = value.strip().lower().partition(":")
            if colon and (word != "nan" or not isnan(self.from_wire(int(bits, 16)))):
                raise ValueError("not a number")
            value = Nan(int(bits, 16)) if colon else float(word)
        if isinstance(value, bool) or not isinstance(value, int | float):
            raise ValueError("not a number")
        return value if isinstance(value, Nan) else Nan(_QUIET[self.code]) if isnan(value) else float(value)

    def accepts(self, value: Any) -> bool:
        """Whether `value`, as rounded for the wire, is finite and in range."""
        if not self.holds(value):
            return False
        value = self.from_wire(self.to_wire(value))
        return isfinite(value) and (self.low is None or value >= self.low) and (self.high is None or value <= self.high)

    def requirement(self) -> str:
        if self.low is None or self.high is None:
            bound = "" if self.low is None else f" of at least {self.low:g}"
            return f"a number{bound}, {self.unit}" if self.unit else f"a number{bound}"
        return f"{self.low:g}..{self.high:g} {self.unit}".rstrip()


F32 = partial(Float, "I")
F64 = partial(Float, "Q")


@dataclass(frozen=True, slots=True)
class Text(Number):
    """Text in the `size` bytes of a code such as `32s`, filled up with NUL."""

    @property
    def size(self) -> int:
        return struct.calcsize(self.code)

    @property
    def room(self) -> str:
        return f"{self.size} bytes"

    def to_wire(self, value: Any) -> Any:
        data = value.encode("latin-1")
        if len(data) > self.size or data.endswith(b"\0"):
            raise ValueError("too long, or ends with NUL")
        return data

    def from_wire(self, raw: Any) -> Any:
        return raw.rstrip(b"\0").decode("latin-1")

    def from_json(self, value: Any) -> Any:
        if not isinstance(value, str):
            raise ValueError("not text")
        return value

    def accepts(self, value: Any) -> bool:
        return self.holds(value)

    def requirement(self) -> str:
        return f"text of at most {self.size} characters"

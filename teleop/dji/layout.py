"""How a message class lies on the wire, worked out once from its annotations when the class is made.

A message is a run of cells, which make one struct format, and at most one tail of no fixed size. A cell is a field, a
constant, or a byte that several fields of bits share. Cells are interpreted one by one: 4 us to encode a position
command and 11 us to decode a push (medians on a busy shared core), so a hundred of each a second take 0.2 % of it.
"""

from __future__ import annotations

import dataclasses
import struct
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import groupby
from typing import Any, ClassVar, NamedTuple, get_args, get_origin, get_type_hints

from teleop.dji.fields import Bits, Number, Reserved
from teleop.dji.gimbal.tlv import Ids, OptionalByte, Tlv


class Field(NamedTuple):
    """One annotated field. `default` is dataclasses.MISSING where a value must be given."""

    name: str
    wire: Number | OptionalByte | Ids | Tlv
    default: Any


class Constant(NamedTuple):
    """A class variable with a wire annotation: a value of that class has this integer in its place."""

    wire: Number
    value: int

    @property
    def code(self) -> str:
        return self.wire.code

    def pack(self, _message: Any) -> int:
        return self.value

    def unpack(self, _integer: int, _values: dict[str, Any]) -> None:
        """A constant is no field."""


@dataclass(frozen=True, slots=True)
class NumberCell:
    """A field that has its cell to itself. Text has one too: its "integer" is bytes."""

    name: str
    wire: Number

    @property
    def code(self) -> str:
        return self.wire.code

    def pack(self, message: Any) -> Any:
        return self.wire.to_wire(getattr(message, self.name))

    def unpack(self, integer: Any, values: dict[str, Any]) -> None:
        values[self.name] = self.wire.from_wire(integer)


class BitField(NamedTuple):
    """A field in the bits `mask << first` of a byte."""

    name: str
    wire: Bits
    mask: int
    first: int


@dataclass(frozen=True, slots=True)
class SharedByte:
    """A byte of several fields of bits."""

    fields: tuple[BitField, ...]
    code: ClassVar[str] = "B"

    def pack(self, message: Any) -> int:
        """Raises ValueError for a value that would spill into other fields' bits."""
        byte = 0
        for name, wire, mask, first in self.fields:
            value = wire.to_wire(getattr(message, name))
            if value & ~mask:
                raise ValueError(name)
            byte |= value << first
        return byte

    def unpack(self, byte: int, values: dict[str, Any]) -> None:
        for name, wire, mask, first in self.fields:
            values[name] = wire.from_wire(byte >> first & mask)


Cell = Constant | NumberCell | SharedByte


class Layout:
    """How one class of messages lies on the wire."""

    def __init__(self, message_class: type) -> None:
        places = list(_places(message_class))
        self.fields = tuple(place for place in places if isinstance(place, Field))
        self._tail: tuple[str, OptionalByte | Ids | Tlv] | None = None
        if self.fields and isinstance(self.fields[-1].wire, OptionalByte | Ids | Tlv):
            self._tail = self.fields[-1].name, self.fields[-1].wire
        self._cells = tuple(_cells(places))
        self._struct = struct.Struct("<" + "".join(cell.code for cell in self._cells))
        self.size = self._struct.size  # bytes, without a tail of no fixed size

    def pack(self, message: Any) -> bytes:
        """A message's bytes.

        Raises struct.error, ValueError, OverflowError, TypeError or AttributeError for what does not fit.
        """
        fixed = self._struct.pack(*[cell.pack(message) for cell in self._cells])
        if self._tail is None:
            return fixed + message.extra
        name, wire = self._tail
        return fixed + wire.to_wire(getattr(message, name)) + message.extra

    def unpack(self, value: bytes) -> dict[str, Any] | None:
        """Each field by name, and what is left over as `extra`; None when `value` is too short or another's."""
        if len(value) < self.size:
            return None
        values: dict[str, Any] = {}
        for cell, integer in zip(self._cells, self._struct.unpack_from(value), strict=True):
            if isinstance(cell, Constant) and integer != cell.value:
                return None
            cell.unpack(integer, values)
        rest = value[self.size :]
        if self._tail is not None:
            name, wire = self._tail
            values[name], rest = wire.from_wire(rest)
        values["extra"] = rest
        return values


def _places(message_class: type) -> Iterator[Field | Constant]:
    """The annotated fields and constants, in the order they are written."""
    defaults = {field.name: field.default for field in dataclasses.fields(message_class)}
    for name, hint in get_type_hints(message_class, include_extras=True).items():
        inner = get_args(hint)[0] if get_origin(hint) is ClassVar else hint
        for wire in getattr(inner, "__metadata__", ()):
            yield Field(name, wire, defaults[name]) if inner is hint else Constant(wire, getattr(message_class, name))


def _cells(places: Sequence[Field | Constant]) -> Iterator[Cell]:
    """One cell each, except that adjacent fields of bits share one, and that a tail has none."""
    for shared, group in groupby(places, key=lambda place: isinstance(place.wire, Bits)):
        if shared:
            yield _shared_byte({place.name: place.wire for place in group if isinstance(place, Field)})
            continue
        for place in group:
            if isinstance(place, Constant):
                yield place
            elif isinstance(place.wire, Number):
                yield NumberCell(place.name, place.wire)


def _shared_byte(fields: dict[str, Any]) -> SharedByte:
    """A Reserved among the fields has the bits that no other field names, in their places."""
    named = sum(wire.mask << wire.first for wire in fields.values())
    return SharedByte(
        tuple(
            BitField(name, wire, ~named & 0xFF, 0)
            if isinstance(wire, Reserved)
            else BitField(name, wire, wire.mask, wire.first)
            for name, wire in fields.items()
        )
    )

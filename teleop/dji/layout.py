"""From a class's annotations to its bytes: two functions, written as source and compiled once when the class is made.

A message is a run of cells (one struct format), each being a field, a constant, or a byte that several fields of bits
share, and at most one tail of no fixed size. Generated source, as dataclasses itself does it, because interpreting a
table of cells cost three times as much per message, and a loop encodes commands and decodes pushes many times a tick.
What is generated is one expression each way; for a position command, but for its reserved bits:

    pack(round(m.yaw * 10), round(m.roll * 10), round(m.pitch * 10),
         (1 if m.absolute else 0) | (2 if m.yaw_ignored else 0) | ..., round(m.time_for_action * 10)) + m.extra
    {"yaw": c0 / 10, "roll": c1 / 10, "pitch": c2 / 10, "absolute": c3 & 1 != 0, ..., "extra": extra}
"""

from __future__ import annotations

import dataclasses
import struct
from collections.abc import Callable, Iterator, Mapping, Sequence
from itertools import groupby
from typing import Any, ClassVar, NamedTuple, get_args, get_origin, get_type_hints

from teleop.dji.fields import Bits, Flag, Number, Reserved
from teleop.dji.gimbal.tlv import Ids, OptionalByte, Tlv


class Field(NamedTuple):
    """One annotated field. `default` is dataclasses.MISSING where a value must be given."""

    name: str
    wire: Number | OptionalByte | Ids | Tlv
    default: Any


class Constant(NamedTuple):
    """A class variable with a wire annotation."""

    wire: Number
    value: int


class Cell(NamedTuple):
    """One integer of the struct format: source that makes it of message `m`, and of it (`{c}`) each of its fields."""

    code: str
    pack: str
    unpack: Mapping[str, str]
    constant: int | None = None


class Layout:
    """How one class of messages lies on the wire.

    `pack` makes a message's bytes; it raises struct.error, ValueError, OverflowError, TypeError or AttributeError for
    what does not fit.
    """

    pack: Callable[[Any], bytes]

    def __init__(self, message_class: type) -> None:
        places = list(_places(message_class))
        self.fields = tuple(place for place in places if isinstance(place, Field))
        cells = list(_cells(places))
        self._struct = struct.Struct("<" + "".join(cell.code for cell in cells))
        self.size = self._struct.size  # bytes, without a tail of no fixed size
        self._constants = [
            (position, cell.constant) for position, cell in enumerate(cells) if cell.constant is not None
        ]
        self.pack, self._unpack = _compile(cells, self.fields, self._struct)

    def unpack(self, value: bytes) -> dict[str, Any] | None:
        """Each field by name, and what is left over as `extra`; None when `value` is too short or another's."""
        layout = self._struct
        if len(value) < layout.size:
            return None
        integers = layout.unpack_from(value)
        for position, constant in self._constants:
            if integers[position] != constant:
                return None
        return self._unpack(value[layout.size :], *integers)


def _places(message_class: type) -> Iterator[Field | Constant]:
    """What the annotations put on the wire, in the order they are written."""
    defaults = {field.name: field.default for field in dataclasses.fields(message_class)}
    for name, hint in get_type_hints(message_class, include_extras=True).items():
        inner = get_args(hint)[0] if get_origin(hint) is ClassVar else hint
        for wire in getattr(inner, "__metadata__", ()):
            yield Field(name, wire, defaults[name]) if inner is hint else Constant(wire, getattr(message_class, name))


def _cells(places: Sequence[Field | Constant]) -> Iterator[Cell]:
    """One cell each, except that neighbouring fields of bits share one, and that a tail has none."""
    for shared, group in groupby(places, key=lambda place: isinstance(place.wire, Bits)):
        if shared:
            yield _shared_byte({place.name: place.wire for place in group if isinstance(place, Field)})
            continue
        for place in group:
            if isinstance(place, Constant):
                yield Cell(place.wire.code, str(place.value), {}, place.value)
            elif isinstance(place.wire, Number):
                yield _number(place.name, place.wire)


def _number(name: str, wire: Number) -> Cell:
    if type(wire) is not Number or wire.words:
        return Cell(wire.code, f"to_{name}(m.{name})", {name: f"from_{name}({{c}})"})
    if wire.scale != 1:
        return Cell(wire.code, f"round(m.{name} * {wire.scale})", {name: f"{{c}} / {wire.scale}"})
    return Cell(wire.code, f"m.{name}", {name: "{c}"})


def _shared_byte(fields: Mapping[str, Any]) -> Cell:
    """A Reserved among the fields stands for the bits that nobody else names."""
    named = sum(wire.mask << wire.first for wire in fields.values())
    pack, unpack = [], {}
    for name, wire in fields.items():
        if isinstance(wire, Flag):
            pack.append(f"({1 << wire.first} if m.{name} else 0)")
            unpack[name] = f"{{c}} & {1 << wire.first} != 0"
        else:
            mask = ~named & 0xFF if isinstance(wire, Reserved) else wire.mask
            pack.append(f"within(m.{name}, {mask}) << {wire.first}")
            bits = f"{{c}} >> {wire.first} & {mask}"
            unpack[name] = f"from_{name}({bits})" if wire.words else bits
    return Cell("B", " | ".join(pack), unpack)


def _within(value: int, mask: int) -> int:
    if value & ~mask:
        raise ValueError
    return value


def _compile(
    cells: Sequence[Cell], fields: Sequence[Field], layout: struct.Struct
) -> tuple[Callable[[Any], bytes], Callable[..., dict[str, Any]]]:
    """The two functions: from a message to its bytes; from what is behind the cells, and the cells, to the fields."""
    names: dict[str, Any] = {"pack": layout.pack, "within": _within}
    for name, wire, _ in fields:
        names |= {f"to_{name}": wire.to_wire, f"from_{name}": wire.from_wire}
    pack = f"pack({', '.join(cell.pack for cell in cells)})"
    unpack = {
        name: source.format(c=f"c{position}")
        for position, cell in enumerate(cells)
        for name, source in cell.unpack.items()
    }
    extra = "extra"
    if fields and isinstance(fields[-1].wire, OptionalByte | Ids | Tlv):
        tail = fields[-1].name
        pack += f" + to_{tail}(m.{tail})"
        unpack[tail], extra = f"(parsed := from_{tail}(extra))[0]", "parsed[1]"
    unpack["extra"] = extra
    parameters = ", ".join(["extra", *(f"c{position}" for position in range(len(cells)))])
    entries = ", ".join(f"{name!r}: {source}" for name, source in unpack.items())
    return eval(f"lambda m: {pack} + m.extra", names), eval(f"lambda {parameters}: {{{entries}}}", names)

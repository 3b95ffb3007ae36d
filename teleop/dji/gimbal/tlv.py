"""Fields of no fixed size: a byte that may be absent, lists of ids, and of id, length, bytes (V2.5 section 2.3.4.12).

Firmware knows more ids than the document, and users have found some of them. So an id is a word where it is known and
a number where it is not, its bytes are bytes, and what does not parse is handed back to be kept.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum
from typing import Any, ClassVar, NamedTuple

from teleop.dji.fields import U8, members

ABSENT = "absent"


class Parameter(NamedTuple):
    """One user parameter: its id and its bytes."""

    id: int
    value: bytes


@dataclass(frozen=True, slots=True)
class Tail:
    """A field of no fixed size, up to the end of the value. What does not parse is left over, never lost.

    `words` names the ids that are known; others are numbers and pass unharmed.
    """

    words: type[IntEnum]
    unit: ClassVar[str] = ""
    room: ClassVar[str] = "bytes"

    def holds(self, value: Any) -> bool:
        """Whether every id and length fits a byte."""
        try:
            self.to_wire(value)
        except (ValueError, TypeError):
            return False
        return True

    def to_wire(self, value: Any) -> bytes:
        raise NotImplementedError

    def _id_to_json(self, number: int) -> int | str:
        return members(self.words)[number].name.lower() if number in members(self.words) else number

    def _id_from_json(self, value: Any) -> int:
        number = U8(words=self.words).from_json(value)
        if not 0 <= number < 256:
            raise ValueError("not a byte")
        return number

    def accepts(self, value: Any) -> bool:
        """Any id may be sent: firmware knows more of them than the document."""
        return value is not None

    @property
    def _ids(self) -> str:
        return ", ".join(member.name.lower() for member in self.words)


@dataclass(frozen=True, slots=True)
class OptionalByte(Tail):
    """One of `words`, or None where a sender leaves the byte out, as some clients do with a question."""

    room: ClassVar[str] = "8 bits"

    def to_wire(self, value: int | None) -> bytes:
        return b"" if value is None else bytes((value,))

    def from_wire(self, data: bytes) -> tuple[int | None, bytes]:
        """The number, None for no bytes, and what is left over."""
        return (members(self.words).get(data[0], data[0]), data[1:]) if data else (None, b"")

    def to_json(self, value: int | None) -> int | str | None:
        return None if value is None else self._id_to_json(value)

    def from_json(self, value: Any) -> int | None:
        """A word or a number; None or `absent` for no byte. Raises ValueError."""
        if value is None or value == ABSENT:
            return None
        number = self._id_from_json(value)
        return members(self.words).get(number, number)

    def accepts(self, value: Any) -> bool:
        return value is None or value in members(self.words)

    def requirement(self) -> str:
        return f"one of {self._ids}, {ABSENT}"


@dataclass(frozen=True, slots=True)
class Ids(Tail):
    """One byte for each id."""

    def to_wire(self, value: tuple[int, ...]) -> bytes:
        return bytes(value)

    def from_wire(self, data: bytes) -> tuple[tuple[int, ...], bytes]:
        """The ids, and nothing left over."""
        return tuple(data), b""

    def to_json(self, value: tuple[int, ...]) -> list[int | str]:
        return [self._id_to_json(number) for number in value]

    def from_json(self, value: Any) -> tuple[int, ...]:
        """A list of ids, or text such as `motor,0x14`. Raises ValueError."""
        items = value.split(",") if isinstance(value, str) else value
        return tuple(self._id_from_json(item) for item in items)

    def requirement(self) -> str:
        return f"ids separated by commas: {self._ids} or 0..255"


@dataclass(frozen=True, slots=True)
class Tlv(Tail):
    """Parameters as id, length, bytes, one after another (V2.5 section 2.3.4.12)."""

    def to_wire(self, value: tuple[Parameter, ...]) -> bytes:
        return b"".join(bytes((number, len(data))) + data for number, data in value)

    def from_wire(self, data: bytes) -> tuple[tuple[Parameter, ...], bytes]:
        """The complete parameters, and the bytes behind them that are not one."""
        parameters = []
        while len(data) >= 2 and len(data) >= 2 + data[1]:
            end = 2 + data[1]
            parameters.append(Parameter(data[0], data[2:end]))
            data = data[end:]
        return tuple(parameters), data

    def to_json(self, value: tuple[Parameter, ...]) -> list[dict[str, int | str]]:
        return [{"id": self._id_to_json(number), "value": data.hex()} for number, data in value]

    def from_json(self, value: Any) -> tuple[Parameter, ...]:
        """A list as `to_json` makes it, or text such as `motor:01,0x14:0500`. Raises ValueError."""
        if isinstance(value, str):
            pairs = [item.split(":") for item in value.split(",")]
        else:
            pairs = [(item["id"], item["value"]) for item in value]
        return tuple(Parameter(self._id_from_json(number), bytes.fromhex(data)) for number, data in pairs)

    def requirement(self) -> str:
        return f"id:hex separated by commas, id one of {self._ids} or 0..255"

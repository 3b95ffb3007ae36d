"""A message is a frozen class whose annotations say everything: encoding, decoding, JSON and help derive from them.

    @message("gimbal.position", GIMBAL, 0x00)
    class Position(Message):
        yaw: Annotated[float, I16(scale=10, unit="deg", low=-180, high=180)]

A class variable with a wire annotation is a constant on the wire (a sub id, a device type). Whatever a device adds
behind the fields is kept in `extra`, so that encoding what was decoded gives the same bytes; a value that does not fit
a class at all decodes to an `Opaque`. Decoding therefore never fails, and never shows a field that was not sent.
Ranges are checked by `check`, before sending; `encode` refuses only what its bytes cannot hold.
"""

from __future__ import annotations

import struct
from collections.abc import Callable, Iterable, Mapping
from dataclasses import MISSING, dataclass, field
from difflib import get_close_matches
from enum import IntEnum
from typing import Annotated, Any, ClassVar, Self, TypeVar, dataclass_transform

from teleop.core.errors import TeleopError
from teleop.dji.fields import U8
from teleop.dji.layout import Field, Layout

COMMAND = 0x03  # cmd_type of a command that expects a reply; what all known programs send
STREAM = 0x00  # cmd_type of what is sent many times a second and never answered
REPLY = 0x20


class FieldError(TeleopError):
    """A field that is missing, unknown, or has a value that cannot or must not be sent."""


class ReturnCode(IntEnum):
    """V2.5 section 2.3.2."""

    OK = 0x00
    PARSE_ERROR = 0x01
    FAILED = 0x02
    UNDEFINED = 0xFF


result_code = Annotated[int, U8(words=ReturnCode)]


@dataclass(frozen=True)
class Message:
    """What all messages can do. `extra` is what followed the fields on the wire."""

    name: ClassVar[str]
    set_and_id: ClassVar[bytes]
    reply: ClassVar[bool | None]  # None: sent with and without the reply bit
    cmd_type: ClassVar[int]
    has_reply: ClassVar[bool]  # False: no reply frame belongs to it, whatever cmd_type a sender asks with
    layout: ClassVar[Layout]

    extra: bytes = field(default=b"", kw_only=True)

    def encode(self) -> bytes:
        """The value after set and id. Raises FieldError when a field does not fit its bytes."""
        try:
            return self.layout.pack(self)
        except (struct.error, ValueError, OverflowError, TypeError, AttributeError):
            raise FieldError(self._misfit()) from None

    def data(self) -> bytes:
        """Set, id and value: the data of a frame."""
        return self.set_and_id + self.encode()

    @classmethod
    def decode(cls, value: bytes) -> Self | Opaque:
        """The message with this value, or an Opaque when it does not fit. Never raises."""
        values = cls.layout.unpack(value)
        return Opaque(cls.set_and_id, value) if values is None else cls(**values)

    def check(self) -> None:
        """Raises FieldError when the document does not allow sending this."""
        for spec in self.layout.fields:
            value = getattr(self, spec.name)
            if not spec.wire.accepts(value):
                raise FieldError(f"{self.name}: {spec.name} must be {spec.wire.requirement()}, not {_shown(value)}")

    def fields(self) -> dict[str, Any]:
        """The fields as JSON has them: units as in the annotation, words for known numbers, bytes in hexadecimal.

        Reserved bits and extra bytes are absent when there are none.
        """
        values = {spec.name: spec.wire.to_json(getattr(self, spec.name)) for spec in self.layout.fields}
        if not values.get("reserved", True):
            del values["reserved"]
        if self.extra:
            values["extra"] = self.extra.hex()
        return values

    @classmethod
    def from_fields(cls, fields: Mapping[str, Any]) -> Self:
        """The message that `fields()` came from; values may also be text as an operator types it.

        Raises FieldError for a field that is unknown, missing or unreadable. Ranges are for `check`.
        """
        specs = {spec.name: spec for spec in cls.layout.fields}
        values: dict[str, Any] = {}
        for name, value in fields.items():
            if name == "extra":
                values[name] = bytes_from_json(cls.name, name, value)
            elif name in specs:
                values[name] = _from_json(cls.name, specs[name], value)
            else:
                raise FieldError(f"{cls.name}: no field {name!r}{suggestion(name, specs)}")
        missing = [spec.name for spec in specs.values() if spec.default is MISSING and spec.name not in values]
        if missing:
            raise FieldError(f"{cls.name}: {', '.join(missing)} missing")
        return cls(**values)

    @classmethod
    def completed(cls, fields: Mapping[str, Any]) -> Mapping[str, Any]:
        """What an operator typed, with what a command does about an axis that is not named; as typed by most."""
        return fields

    def _misfit(self) -> str:
        """Which field cannot be encoded."""
        for spec in self.layout.fields:
            value = getattr(self, spec.name)
            if not spec.wire.holds(value):
                return f"{self.name}: {spec.name} {_shown(value)} does not fit its {spec.wire.room}"
        return f"{self.name}: reserved must leave the other fields' bits alone, extra must be bytes"


Class = TypeVar("Class", bound=type[Message])


@dataclass_transform(frozen_default=True, field_specifiers=(field,))
def message(
    name: str, command_set: int, command_id: int, *, reply: bool | None = False, cmd_type: int | None = None
) -> Callable[[Class], Class]:
    """Make a message of a class with annotated fields; `cmd_type` is what frames of it are sent with."""

    def decorate(cls: Class) -> Class:
        made = dataclass(frozen=True)(cls)
        made.name = name
        made.set_and_id = bytes((command_set, command_id))
        made.reply = reply
        made.cmd_type = cmd_type if cmd_type is not None else REPLY if reply else COMMAND
        made.has_reply = made.cmd_type != STREAM
        made.layout = Layout(made)
        return made

    return decorate


@message("raw", 0, 0)
class Opaque(Message):
    """Bytes that no class describes: an unknown id, a value too short for its command, encrypted data.

    `prefix` is set and id, or nothing where the frame has none (replies of old firmware, encrypted data).
    """

    prefix: bytes
    value: bytes

    def encode(self) -> bytes:
        return self.value

    def data(self) -> bytes:
        return self.prefix + self.value

    def fields(self) -> dict[str, Any]:
        return {"value": self.value.hex()}


@message("result", 0, 0, reply=True)
class Result(Message):
    """What most replies are, and any may be when it fails: the return code alone. Set and id are the request's."""

    return_code: result_code = ReturnCode.OK


def _from_json(owner: str, spec: Field, value: Any) -> Any:
    try:
        return spec.wire.from_json(value)
    except (ValueError, TypeError, KeyError, OverflowError):
        raise FieldError(f"{owner}: {spec.name} must be {spec.wire.requirement()}, not {value!r}") from None


def bytes_from_json(owner: str, name: str, value: Any) -> bytes:
    """Bytes written in hexadecimal. Raises FieldError naming the field `name` of `owner`."""
    try:
        return bytes.fromhex(value)
    except (ValueError, TypeError):
        raise FieldError(f"{owner}: {name} must be hexadecimal, not {value!r}") from None


def suggestion(word: str, known: Iterable[str]) -> str:
    """The end of a message about an unknown word."""
    near = get_close_matches(word, list(known), 1)
    return f", did you mean {near[0]!r}?" if near else f"; there are {', '.join(known) or 'none'}"


def _shown(value: Any) -> str:
    return f"{value:g}" if isinstance(value, float) else str(value)

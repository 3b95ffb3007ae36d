"""Push 02 00, what the drone says of itself: a u16 of flags, and the parts that they name, packed in the flags' order.

The M100 and the A3 (and M600) put different parts under the same flags, and a frame does not say whose it is; so there
is a class for each, and whoever decodes has to know. A part that was not sent is None. A flag that a layout does not
have means that the frame is of another, and so that no part of it is what it seems: it is Opaque.
"""

from __future__ import annotations

import struct
from collections.abc import Iterator, Mapping
from typing import Annotated, Any, ClassVar, Final, Self, get_args, get_type_hints

from teleop.dji.drone.broadcast_parts import (
    Acceleration,
    AngularRate,
    ControlSource,
    Gimbal,
    Gps,
    Magnetometer,
    Position,
    Quaternion,
    Rc,
    Rtk,
    Time,
    Velocity,
)
from teleop.dji.drone.enums import FlightStatus
from teleop.dji.drone.messages import PUSH
from teleop.dji.fields import U8, Number
from teleop.dji.message import STREAM, FieldError, Message, Opaque, bytes_from_json, message, suggestion

_FLAGS: Final = struct.Struct("<H")

flight_status = Annotated[int, U8(words=FlightStatus)]
percent = Annotated[int, U8(unit="%", low=0, high=100)]


class Single:
    """A part that is one byte, with what a part that is a message class offers."""

    size = 1

    def __init__(self, name: str, wire: Number) -> None:
        self.name, self.wire = name, wire

    def decode(self, value: bytes) -> Any:
        return self.wire.from_wire(value[0])

    def encode(self, value: Any) -> bytes:
        if not self.wire.holds(value):
            raise FieldError(f"drone.broadcast: {self.name} {value} does not fit its {self.wire.room}")
        return bytes((self.wire.to_wire(value),))

    def check(self, value: Any) -> None:
        if not self.wire.accepts(value):
            raise FieldError(f"drone.broadcast: {self.name} must be {self.wire.requirement()}, not {value}")

    def to_json(self, value: Any) -> Any:
        return self.wire.to_json(value)

    def from_json(self, value: Any) -> Any:
        try:
            return self.wire.from_json(value)
        except (ValueError, TypeError, OverflowError):
            raise FieldError(f"drone.broadcast: {self.name} must be {self.wire.requirement()}, not {value!r}") from None


class Several:
    """A part that is a message class."""

    def __init__(self, name: str, cls: type[Message]) -> None:
        self.name, self.cls, self.size = name, cls, cls.layout.size

    def decode(self, value: bytes) -> Any:
        return self.cls.decode(value)

    def encode(self, value: Any) -> bytes:
        if value.extra:
            raise FieldError(f"drone.broadcast: {self.name} has no extra")
        return value.encode()

    def check(self, value: Any) -> None:
        value.check()

    def to_json(self, value: Any) -> Any:
        return value.fields()

    def from_json(self, value: Any) -> Any:
        if not isinstance(value, dict):
            raise FieldError(f"drone.broadcast: {self.name} must be an object, not {value!r}")
        return self.cls.from_fields(value)


def _parts(cls: type[Broadcast]) -> dict[str, Single | Several]:
    """What each field that a flag can name is, by its annotation."""
    parts: dict[str, Single | Several] = {}
    for name, hint in get_type_hints(cls, include_extras=True).items():
        kind = next(iter(get_args(hint)), None)
        if wires := getattr(kind, "__metadata__", ()):
            parts[name] = Single(name, wires[0])
        elif isinstance(kind, type) and issubclass(kind, Message):
            parts[name] = Several(name, kind)
    return parts


@message("drone.broadcast", PUSH, 0x00, cmd_type=STREAM)
class Broadcast(Message):
    """What the M100 says of itself; a part that was not sent is None."""

    order: ClassVar[tuple[str, ...]] = (
        *("time", "quaternion", "acceleration", "velocity", "angular_rate", "position"),
        *("magnetometer", "rc", "gimbal", "status", "battery", "control"),
    )

    time: Time | None = None
    quaternion: Quaternion | None = None
    acceleration: Acceleration | None = None
    velocity: Velocity | None = None
    angular_rate: AngularRate | None = None
    position: Position | None = None
    gps: Gps | None = None
    rtk: Rtk | None = None
    magnetometer: Magnetometer | None = None
    rc: Rc | None = None
    gimbal: Gimbal | None = None
    status: flight_status | None = None
    battery: percent | None = None
    control: ControlSource | None = None

    @property
    def flags(self) -> int:
        """The u16 that names the parts."""
        return sum(1 << bit for bit, name in enumerate(self.order) if getattr(self, name) is not None)

    def encode(self) -> bytes:
        if strange := [name for name in PARTS if name not in self.order and getattr(self, name) is not None]:
            raise FieldError(f"{self.name}: there is no {', '.join(strange)} in this drone's layout")
        return _FLAGS.pack(self.flags) + b"".join(part.encode(value) for part, value in self._present()) + self.extra

    @classmethod
    def decode(cls, value: bytes) -> Self | Opaque:
        if len(value) < _FLAGS.size:
            return Opaque(cls.set_and_id, value)
        (flags,) = _FLAGS.unpack_from(value)
        parts = [PARTS[name] for bit, name in enumerate(cls.order) if flags >> bit & 1]
        if flags >> len(cls.order) or len(value) < _FLAGS.size + sum(part.size for part in parts):
            return Opaque(cls.set_and_id, value)
        at, values = _FLAGS.size, {}
        for part in parts:
            values[part.name] = part.decode(value[at : at + part.size])
            at += part.size
        return cls(**values, extra=value[at:])

    def check(self) -> None:
        for part, value in self._present():
            part.check(value)

    def fields(self) -> dict[str, Any]:
        """The parts that were sent, by name: an object each, but for `status` and `battery`."""
        values: dict[str, Any] = {part.name: part.to_json(value) for part, value in self._present()}
        if self.extra:
            values["extra"] = self.extra.hex()
        return values

    @classmethod
    def from_fields(cls, fields: Mapping[str, Any]) -> Self:
        values: dict[str, Any] = {}
        for name, value in fields.items():
            if name == "extra":
                values[name] = bytes_from_json(cls.name, name, value)
            elif name in cls.order:
                values[name] = PARTS[name].from_json(value)
            else:
                raise FieldError(f"{cls.name}: no field {name!r}{suggestion(name, cls.order)}")
        return cls(**values)

    def _present(self) -> Iterator[tuple[Single | Several, Any]]:
        for name in self.order:
            value = getattr(self, name)
            if value is not None:
                yield PARTS[name], value


PARTS: Final = _parts(Broadcast)
"""Every part of either layout, by name."""


@message("drone.broadcast", PUSH, 0x00, cmd_type=STREAM)
class A3Broadcast(Broadcast):
    """What the A3 and the M600 say of themselves; a part that was not sent is None."""

    order: ClassVar[tuple[str, ...]] = (*Broadcast.order[:6], "gps", "rtk", *Broadcast.order[6:])

"""A frame's record (teleop.dji.json_record) as people read it, with the units that the message classes carry."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from teleop.dji.drone.broadcast import PARTS, Broadcast, Several
from teleop.dji.drone.movement import Move
from teleop.dji.drone.onboard_sdk import A3, M100
from teleop.dji.gimbal.r_sdk import R_SDK
from teleop.dji.json_record import Record
from teleop.dji.message import FieldError, Message

_ARROWS: Mapping[str, str] = {"to": "->", "from": "<-"}


def _units_of(cls: type[Message]) -> dict[str, str]:
    if not issubclass(cls, Broadcast):
        return {field.name: field.wire.unit for field in cls.layout.fields}
    units = {}
    for name, part in PARTS.items():
        if isinstance(part, Several):
            units |= {f"{name}.{inner}": unit for inner, unit in _units_of(part.cls).items()}
        else:
            units[name] = part.wire.unit
    return units


_UNITS: Mapping[tuple[str, bool], Mapping[str, str]] = {
    (cls.name, reply): _units_of(cls)
    for cls in (*R_SDK.messages, *M100.messages, *A3.messages)
    for reply in (False, True)
    if cls.reply in (None, reply)
}


def _move_units(fields: Mapping[str, Any]) -> Mapping[str, str]:
    """What the four numbers of a movement are, which its mode says."""
    try:
        combination = Move.from_fields(fields).combination
    except FieldError:
        return {}
    return {} if combination is None else {name: wire.unit for name, wire in combination.ranges.items()}


def line(record: Record) -> str:
    """A record with time and direction, for people."""
    start = f"{record['time']:9.3f} {_ARROWS[record['direction'].split()[0]]} "
    if "damage" in record:
        return f"{start}damage: {record['damage']}: {record['bytes']}"
    name = record["message"] + (" reply" if record["reply"] else "")
    return start + ", ".join([name, *(f"{field} {value}" for field, value in in_units(record).items())])


def in_units(record: Record) -> dict[str, str]:
    """The fields of a record as people read them; those of a part as `rc.roll`."""
    fields = record["fields"]
    units = _UNITS.get((record["message"], record["reply"]), {})
    if record["message"] == Move.name:
        units = _move_units(fields)
    return {name: f"{_shown(value)} {units.get(name, '')}".rstrip() for name, value in _flat(fields)}


def _flat(fields: Mapping[str, Any]) -> Iterator[tuple[str, Any]]:
    for name, value in fields.items():
        if isinstance(value, dict):
            yield from ((f"{name}.{inner}", each) for inner, each in value.items())
        else:
            yield name, value


def _shown(value: Any) -> str:
    match value:
        case None:
            return "absent"
        case bool():
            return str(value).lower()
        case float():
            return f"{value:g}"
        case list():
            return ",".join(map(_shown, value)) or "none"
        case {"id": number, "value": data}:  # a user parameter, as `teleop send` takes it
            return f"{number}:{data}"
        case _:
            return str(value)

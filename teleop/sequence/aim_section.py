"""What a sequence file says of targets: where they are, where the camera is, and how far beside one it looks."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Annotated, Any

from pydantic import AfterValidator, BeforeValidator, WithJsonSchema

from teleop.config.documents.base_model import Finite, Section
from teleop.config.documents.document import Wrong, mapping, sequence
from teleop.config.documents.messages import decimal_comma, nearest, shown
from teleop.planner.aim import Point

FURTHEST = 1e6  # m

_METERS = {"type": "array", "items": {"type": "number"}, "minItems": 3, "maxItems": 3}


def _place(value: Any) -> Point:
    if not isinstance(value, list) or len(value) != 3:
        raise ValueError(f"must be [x, y, z] in meters, not {shown(value)}")
    for each in value:
        if isinstance(each, bool) or not isinstance(each, int | float) or not abs(each) < FURTHEST:
            raise ValueError(decimal_comma(each) or f"must be [x, y, z] in meters, not {shown(value)}")
    return Point(*map(float, value))


def _aim(value: Any) -> str | Point:
    if isinstance(value, str) and value:
        return value
    if isinstance(value, list):
        return _place(value)
    raise ValueError(f"must be the name of a target or [x, y, z] in meters, not {shown(value)}")


def _mount(value: Any) -> Any:
    return {"height": value} if not isinstance(value, dict) else value


Place = Annotated[Any, AfterValidator(_place), WithJsonSchema({**_METERS, "examples": [[4.0, 1.2, 1.6]]})]
Aim = Annotated[
    Any,
    AfterValidator(_aim),
    WithJsonSchema({"anyOf": [{"type": "string", "minLength": 1}, _METERS], "examples": ["door", [4.0, 1.2, 1.6]]}),
]


class CameraMountSection(Section):
    """Where the camera is on its tripod."""

    height: Finite = 0.0
    """Height in m of the camera's axes above the point that targets are measured from."""


Mount = Annotated[
    CameraMountSection,
    BeforeValidator(_mount, json_schema_input_type=float | CameraMountSection),
]


class OffsetSection(Section):
    """How far beside its target a camera looks."""

    pan: Finite = 0.0
    """Pan in deg; + is right."""
    tilt: Finite = 0.0
    """Tilt in deg; + is up."""


def aim_rules(data: Any) -> Iterator[Wrong]:
    """A key aims at a target that there is, and then says nothing else of pan and tilt."""
    targets = mapping(data, "targets")
    for index, frame in enumerate(sequence(data, "keyframes")):
        name = mapping(frame).get("aim")
        if isinstance(name, str) and name and name not in targets:
            names = [str(each) for each in targets]
            text = f"; the targets are {', '.join(names)}" if names else "; the file has no `targets`"
            yield ("keyframes", index, "aim"), f": unknown target {shown(name)}{nearest(name, names) or text}"
        for axis in ("pan", "tilt"):
            if name is not None and mapping(frame).get(axis) is not None:
                yield ("keyframes", index, axis), "is given by aim: remove one; `offset` looks beside"
        if name is None and mapping(frame).get("offset") is not None:
            yield ("keyframes", index, "offset"), "needs an aim"

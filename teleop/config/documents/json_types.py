"""What a file's values may look like where pydantic leaves them as they are written: for the schemas of editors.

A time or an ease is read by a function of its own, with errors in its own words, so to pydantic it is anything. These
types say to `teleop schema` what the functions accept, out of the same patterns.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any

from pydantic import WithJsonSchema

from teleop.config.quantities import FRAMES_WRITTEN, LONGEST, PERCENTAGE_WRITTEN, TIME_WRITTEN
from teleop.core.axes import Axis
from teleop.planner.keyframes.ramp import LONGEST_SHARE, NAMES, SMOOTH
from teleop.planner.keyframes.tension import EVEN

MOST_OVERLAP = 0.9

_TIME = {"anyOf": [{"type": "number", "minimum": 0, "maximum": LONGEST}, {"type": "string", "pattern": TIME_WRITTEN}]}
_FRAMES = {"anyOf": [{"type": "number", "minimum": 0}, {"type": "string", "pattern": FRAMES_WRITTEN}]}


def _share_to(most: float) -> dict[str, Any]:
    """A percentage up to `most`, which is a share that is whole in tens."""
    tens = round(10 * most)
    pattern = rf"^\s*0{{0,4}}({tens}0(\.0+)?|[0-{tens - 1}]?[0-9](\.[0-9]+)?)\s*%\s*$"
    return {"type": "string", "pattern": pattern}


def _described(schema: Mapping[str, Any], description: str) -> dict[str, Any]:
    return {**schema, "description": description}


def _mapping(required: list[str], **properties: Any) -> dict[str, Any]:
    return {"type": "object", "properties": properties, "required": required, "additionalProperties": False}


_RAMP = {"anyOf": [{"enum": [SMOOTH, *NAMES]}, _share_to(LONGEST_SHARE), *_TIME["anyOf"]]}
_SPAN = {"anyOf": [{"type": "number", "exclusiveMinimum": 0, "maximum": LONGEST}, _TIME["anyOf"][1]]}
_ARRIVE = _described(_RAMP, "Ramp to the stop here.")
_LEAVE = _described(_RAMP, "Ramp away from here.")
_FROM = _described(_SPAN, "Interval of the first frame.")
_TO = _described(_SPAN, "Interval of the last frame.")
_BELOW = _described({"type": "number", "exclusiveMinimum": 0}, "Speed in deg/s below which the gimbal counts as still.")
_AT_MOST = _described(_TIME, "Longest wait for that.")

Time = Annotated[Any, WithJsonSchema({**_TIME, "examples": [4, "4s", "1m30s", "96f", "00:00:04:00"]})]
AutoTime = Annotated[Any, WithJsonSchema({"anyOf": [{"const": "auto"}, *_TIME["anyOf"]], "examples": ["auto", "2s"]})]
_TOLERANCE = {"type": "number", "exclusiveMinimum": 0}
Tolerance = Annotated[
    Any,
    WithJsonSchema(
        {
            "anyOf": [
                _TOLERANCE,
                {
                    "type": "object",
                    "propertyNames": {"enum": [axis.value for axis in Axis]},
                    "additionalProperties": _TOLERANCE,
                },
            ]
        }
    ),
]
Percentage = Annotated[Any, WithJsonSchema({"type": "string", "pattern": PERCENTAGE_WRITTEN, "examples": ["30%"]})]
Overlap = Annotated[Any, WithJsonSchema({**_share_to(MOST_OVERLAP), "examples": ["30%"]})]
Ease = Annotated[
    Any,
    WithJsonSchema(
        {"anyOf": [*_RAMP["anyOf"], _mapping([], arrive=_ARRIVE, leave=_LEAVE)], "examples": ["1.5s", "25%"]}
    ),
]
_SHARE = {"type": "number", "minimum": 0, "maximum": 1}
_DISTANCE = {"type": "number", "minimum": 0}
_BY_AXIS = _mapping([], **{axis.value: _described(_DISTANCE, f"Of {axis.value}.") for axis in Axis})
TensionWritten = Annotated[Any, WithJsonSchema({"anyOf": [_SHARE, {"const": EVEN}], "examples": [0.5, EVEN]})]
Overshoot = Annotated[Any, WithJsonSchema({"anyOf": [_DISTANCE, _BY_AXIS], "examples": [2]})]
Interval = Annotated[
    Any,
    WithJsonSchema({"anyOf": [*_SPAN["anyOf"], _mapping(["from", "to"], **{"from": _FROM, "to": _TO})]}),
]
Settle = Annotated[
    Any,
    WithJsonSchema(
        {
            "anyOf": [
                *_TIME["anyOf"],
                _mapping(["below", "at_most"], below=_BELOW, at_most=_AT_MOST),
            ]
        }
    ),
]

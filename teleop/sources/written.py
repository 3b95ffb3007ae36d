"""What a file's values may look like where pydantic leaves them as they are written: for the schemas of editors.

A time or an ease is read by a function of its own, with errors in its own words, so to pydantic it is anything. These
types say to `teleop schema` what the functions accept, out of the same patterns.
"""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import WithJsonSchema

from teleop.planner.ramp import NAMES, SMOOTH
from teleop.sources.times import FRAMES_WRITTEN, PERCENTAGE_WRITTEN, TIME_WRITTEN

_PERCENTAGE = {"type": "string", "pattern": PERCENTAGE_WRITTEN}
_TIME = {"anyOf": [{"type": "number", "minimum": 0}, {"type": "string", "pattern": TIME_WRITTEN}]}
_FRAMES = {"anyOf": [{"type": "number", "minimum": 0}, {"type": "string", "pattern": FRAMES_WRITTEN}]}
_RAMP = {"anyOf": [{"enum": [SMOOTH, *NAMES]}, _PERCENTAGE, *_TIME["anyOf"]]}


def _mapping(required: list[str], **properties: Any) -> dict[str, Any]:
    return {"type": "object", "properties": properties, "required": required, "additionalProperties": False}


Time = Annotated[Any, WithJsonSchema({**_TIME, "examples": [4, "4s", "1m30s", "96f", "00:00:04:00"]})]
Percentage = Annotated[Any, WithJsonSchema({**_PERCENTAGE, "examples": ["30%"]})]
Ease = Annotated[
    Any,
    WithJsonSchema({"anyOf": [*_RAMP["anyOf"], _mapping([], arrive=_RAMP, leave=_RAMP)], "examples": ["1.5s", "25%"]}),
]
Interval = Annotated[
    Any,
    WithJsonSchema({"anyOf": [*_TIME["anyOf"], _mapping(["from", "to"], **{"from": _TIME, "to": _TIME})]}),
]
Settle = Annotated[
    Any,
    WithJsonSchema(
        {
            "anyOf": [
                *_TIME["anyOf"],
                _mapping(["below", "at_most"], below={"type": "number", "exclusiveMinimum": 0}, at_most=_TIME),
            ]
        }
    ),
]

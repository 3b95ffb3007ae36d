"""What a file's values may look like where pydantic leaves them as they are written: for the schemas of editors.

A time or an ease is read by a function of its own, with errors in its own words, so to pydantic it is anything. These
types say to `teleop schema` what the functions accept, out of the same patterns.
"""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import WithJsonSchema

from teleop.config.quantities import FRAMES_WRITTEN, LONGEST, PERCENTAGE_WRITTEN, TIME_WRITTEN
from teleop.planner.keyframes.ramp import LONGEST_SHARE, NAMES, SMOOTH

MOST_OVERLAP = 0.9

_TIME = {"anyOf": [{"type": "number", "minimum": 0, "maximum": LONGEST}, {"type": "string", "pattern": TIME_WRITTEN}]}
_FRAMES = {"anyOf": [{"type": "number", "minimum": 0}, {"type": "string", "pattern": FRAMES_WRITTEN}]}


def _share_to(most: float) -> dict[str, Any]:
    """A percentage up to `most`, which is a share that is whole in tens."""
    tens = round(10 * most)
    pattern = rf"^\s*0{{0,4}}({tens}0(\.0+)?|[0-{tens - 1}]?[0-9](\.[0-9]+)?)\s*%\s*$"
    return {"type": "string", "pattern": pattern}


def _mapping(required: list[str], **properties: Any) -> dict[str, Any]:
    return {"type": "object", "properties": properties, "required": required, "additionalProperties": False}


_RAMP = {"anyOf": [{"enum": [SMOOTH, *NAMES]}, _share_to(LONGEST_SHARE), *_TIME["anyOf"]]}
_SPAN = {"anyOf": [{"type": "number", "exclusiveMinimum": 0, "maximum": LONGEST}, _TIME["anyOf"][1]]}

Time = Annotated[Any, WithJsonSchema({**_TIME, "examples": [4, "4s", "1m30s", "96f", "00:00:04:00"]})]
Percentage = Annotated[Any, WithJsonSchema({"type": "string", "pattern": PERCENTAGE_WRITTEN, "examples": ["30%"]})]
Overlap = Annotated[Any, WithJsonSchema({**_share_to(MOST_OVERLAP), "examples": ["30%"]})]
Ease = Annotated[
    Any,
    WithJsonSchema({"anyOf": [*_RAMP["anyOf"], _mapping([], arrive=_RAMP, leave=_RAMP)], "examples": ["1.5s", "25%"]}),
]
Interval = Annotated[
    Any,
    WithJsonSchema({"anyOf": [*_SPAN["anyOf"], _mapping(["from", "to"], **{"from": _SPAN, "to": _SPAN})]}),
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

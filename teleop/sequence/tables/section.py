"""The `source:` section of a sequence file: which columns of a table by the frame move which axes."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Annotated, Any

from pydantic import AfterValidator, BeforeValidator, ConfigDict, Field, WithJsonSchema

from teleop.config.documents.base_model import Finite, Section
from teleop.config.documents.document import Wrong, mapping, number
from teleop.config.documents.json_types import AutoTime, Tolerance
from teleop.config.documents.messages import shown, unknown_key
from teleop.config.frame_rates import exact_rate
from teleop.config.quantities import seconds
from teleop.core.axes import Axis, Limits

WHERE = "source"
AUTO = "auto"
RUN_UP, RUN_OUT = "run-up", "run-out"  # what errors call keys before the first frame and after the last
TOLERANCE = 0.1  # deg, or per cent of the full way of focus and sticks
PER_SHARE = 100.0  # a tolerance in degrees is one in per cent for focus and sticks, whose full way is 1

ColumnName = Annotated[str, Field(min_length=1)] | Annotated[int, Field(ge=1)]


class ColumnSection(Section):
    """A column of the table, and what its values are multiplied by and shifted by."""

    column: ColumnName
    """Name of the column, or its number from 1."""
    scale: Finite = 1.0
    """Factor from the column's unit to degrees, or to 0..1 of focus; -1 turns the direction."""
    offset: Finite = 0.0
    """Added after scaling, in degrees, or in 0..1 of focus."""


def _section(value: Any) -> Any:
    """A bare name or number is a column as it is."""
    return {"column": value} if isinstance(value, str | int) and not isinstance(value, bool) else value


Column = Annotated[
    ColumnSection,
    BeforeValidator(_section),
    WithJsonSchema(
        {
            "anyOf": [
                {"type": "string", "minLength": 1},
                {"type": "integer", "minimum": 1},
                {
                    "type": "object",
                    "properties": {
                        "column": {"type": ["string", "integer"], "description": "Name or number of the column."},
                        "scale": {"type": "number", "description": "Factor to degrees, or to 0..1 of focus."},
                        "offset": {"type": "number", "description": "Added after scaling."},
                    },
                    "required": ["column"],
                    "additionalProperties": False,
                },
            ]
        }
    ),
]


class ColumnsSection(Section):
    """The column of each axis: a name, a number from 1, or `{column: ry, scale: -1, offset: 90}`."""

    model_config = ConfigDict(json_schema_extra={"minProperties": 1})

    pan: Column | None = None
    """Pan in deg; + is right."""
    tilt: Column | None = None
    """Tilt in deg; + is up."""
    roll: Column | None = None
    """Roll in deg; + is clockwise seen from behind the camera."""
    focus: Column | None = None
    """Focus, 0 (near) to 1 (far)."""
    stick_roll: Column | None = None
    """Right stick of the drone sideways, -1 to 1; + is right."""
    stick_pitch: Column | None = None
    """Right stick of the drone forward, -1 to 1; + is forward."""
    stick_throttle: Column | None = None
    """Left stick of the drone up, -1 to 1; + is up."""
    stick_yaw: Column | None = None
    """Left stick of the drone sideways, -1 to 1; + turns clockwise seen from above."""

    def given(self) -> Mapping[Axis, ColumnSection]:
        """The axes that have a column."""
        named = {axis: getattr(self, axis.value) for axis in Axis}
        return {axis: column for axis, column in named.items() if column is not None}


class SourceSection(Section):
    """A table with a row for each frame: a match-move, a track, a move of another motion-control system."""

    file: Annotated[str, Field(min_length=1)]
    """The table, beside this file: CSV, or columns with blanks between."""
    columns: ColumnsSection
    """Which column moves which axis: `{pan: ry, tilt: rx}`."""
    fps: Annotated[float, Field(gt=0, le=1000), AfterValidator(exact_rate)] | None = None
    """Frames per second of the table; by default the `fps` of this file."""
    frame: ColumnName | None = None
    """Column with the frame numbers; by default the one called `frame`, else every row is the next frame."""
    tolerance: Tolerance = TOLERANCE
    """How far the move may be off at a frame, in degrees (focus and sticks: in per cent), for all axes or by axis."""
    run_up: AutoTime = AUTO
    """Time to get up to speed before the first frame: `2s`, or `auto` for what the table needs."""
    run_out: AutoTime = AUTO
    """Time to come to rest after the last frame: `2s`, or `auto` for what the table needs."""
    record: bool = True
    """Record from the first frame to the last, where the file has no `record` or `stop` of its own."""

    def rate(self, fps: float | None) -> float:
        """Frames of the table per second, in a file with this `fps`."""
        return self.fps or fps or 0.0

    def allowed(self, axis: Axis) -> float:
        """The tolerance of an axis in its units."""
        given = self.tolerance
        value = float(given.get(axis.value, TOLERANCE) if isinstance(given, Mapping) else given)
        return value if axis.is_angle else value / PER_SHARE

    def run(self, which: str, fps: float | None) -> float | None:
        """`run_up` or `run_out` in s; None for as much as is needed."""
        value = getattr(self, which)
        return None if value == AUTO else seconds(value, fps)


def source_rules(data: Any, fps: float | None) -> Iterator[Wrong]:
    """What is wrong with a source beyond its single values."""
    section = mapping(data, WHERE)
    if not section:
        return
    columns = section.get("columns")
    if isinstance(columns, Mapping) and not any(value is not None for value in columns.values()):
        yield (WHERE, "columns"), "names no axis: write {pan: ry}, with a column of the table for each axis"
    if fps is None and section.get("fps") is None:
        yield (WHERE,), "needs fps: how many frames of the table are in a second"
    for name in ("run_up", "run_out"):
        if section.get(name, AUTO) != AUTO:
            try:
                seconds(section[name], fps)
            except ValueError as error:
                wrong = str(error).replace("must be a time", "must be auto or a time", 1)
                yield (WHERE, name), wrong
    yield from _tolerance_rules(section.get("tolerance", TOLERANCE))


def _tolerance_rules(tolerance: Any) -> Iterator[Wrong]:
    here = (WHERE, "tolerance")
    by_axis = isinstance(tolerance, Mapping)
    for key, value in tolerance.items() if by_axis else [("", tolerance)]:
        path = (*here, key) if key else here
        if by_axis and key not in [axis.value for axis in Axis]:
            yield path, f": {unknown_key(str(key), [axis.value for axis in Axis], {})}"
        elif not 0 < (number(value) or 0) < float("inf"):
            yield path, f"must be a number above 0, not {shown(value)}"


def source_limits(data: Any, limits: Mapping[str, Limits], rig: str) -> Iterator[Wrong]:
    """Every axis of a source is one of the rig."""
    for name in mapping(data, WHERE, "columns"):
        if name in [axis.value for axis in Axis] and name not in limits:
            yield (WHERE, "columns", name), f": {rig} has no {name}; it has {', '.join(limits)}"

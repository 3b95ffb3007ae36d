"""Dragonframe's .arcm: XML with the points of each axis, and cubic Bezier curves between them.

The namespace is http://caliri.com/motion/scene. An `axis` has a `name` and `units` ("deg"), then `points` (x: frame, y:
position), then `controlPoints`: one for the first and the last point, two for each between, so that each way has two.
The file has no rate: it is in the file beside it. What is written has a point for each row, with the slope of the path
there, so that the curves between stay by it. Source: the exporter BlenderMoco, whose files Dragonframe imports as Arc
Move, and files that Dragonframe wrote.

A file of a stranger may be meant to choke its reader: no document type and so no entity is accepted, and depth,
elements and numbers are bounded.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from xml.parsers import expat
from xml.sax.saxutils import quoteattr

import numpy as np

from teleop.config.documents.document import DocumentError
from teleop.core.axes import Axis
from teleop.interchange.bezier import Point, curve
from teleop.interchange.motion import MOST_DEGREES, MOST_FRAMES, Motion
from teleop.interchange.table import Hints, WriteOptions
from teleop.interchange.text import axis_named, needed_rate, number
from teleop.planner.polynomial import Array
from teleop.sequence.written_values import decimal

SCENE = "http://caliri.com/motion/scene"
DEEPEST, MOST_AXES = 16, 64
MOST_ELEMENTS = 2 * MOST_AXES * MOST_FRAMES


def write(motion: Motion, options: WriteOptions) -> bytes:
    """Frames are counted from the first frame of the path."""
    frames = motion.frames
    last = decimal(float(frames[-1]), 6)
    parts = [f'<?xml version="1.0" encoding="UTF-8"?>\n<scen:scene xmlns:scen="{SCENE}" endframe="{last}">\n']
    for axis in options.axes:
        unit = ' units="deg"' if axis.is_angle else ""
        parts.append(f"  <scen:axis name={quoteattr(axis.value)}{unit}>\n")
        parts += [_element("points", *point) for point in _points(frames, motion.column(axis))]
        parts += [_element("controlPoints", *point) for point in _handles(frames, motion.column(axis))]
        parts.append("  </scen:axis>\n")
    return "".join([*parts, "</scen:scene>\n"]).encode()


def _element(name: str, x: float, y: float) -> str:
    return f'    <scen:{name} x="{decimal(x, 9)}" y="{number(y)}"/>\n'


def _points(frames: Array, positions: Array) -> list[Point]:
    return list(zip(frames.tolist(), positions.tolist(), strict=True))


def _handles(frames: Array, positions: Array) -> list[Point]:
    """Two for each way, a third of it away from its ends, on the slopes there."""
    if len(frames) < 2:
        return []
    slopes = np.gradient(positions, frames)
    found = []
    for place, width in enumerate(np.diff(frames).tolist()):
        for end, side in ((place, 1), (place + 1, -1)):
            away = side * width / 3
            found.append((float(frames[end]) + away, float(positions[end] + slopes[end] * away)))
    return found


@dataclass
class _AxisElement:
    """An `axis` as it stands in the file, from this line on."""

    line: int
    name: str
    units: str
    points: list[Point] = field(default_factory=list)
    handles: list[Point] = field(default_factory=list)


def read(raw: bytes, name: str, hints: Hints) -> Motion:
    """At every frame of the curves; those with another name than an axis of a head are left out."""
    elements = _parsed(raw, name)
    rate = needed_rate(hints, name)
    chosen, strangers = _chosen(elements, name, hints)
    begin = min(element.points[0][0] for element in chosen.values())
    end = max(element.points[-1][0] for element in chosen.values())
    if end - begin >= MOST_FRAMES:
        raise DocumentError([f"{name}: is too long: at most {MOST_FRAMES} frames"])
    frames = begin + np.arange(math.floor(end - begin + 1e-9) + 1, dtype=np.float64)
    if frames[-1] < end - 1e-9:
        frames = np.append(frames, end)
    positions = {axis: curve(element.points, element.handles, frames) for axis, element in chosen.items()}
    corners = {round(x - begin) for element in chosen.values() for x, _ in element.points}
    remarks = [f"axes that a head does not have: {', '.join(strangers)}"] if strangers else []
    times = (frames - begin) / float(rate)
    return Motion("", times, positions, rate, round(begin), corners=sorted(corners), remarks=remarks)


def _chosen(
    elements: Sequence[_AxisElement], name: str, hints: Hints
) -> tuple[Mapping[Axis, _AxisElement], Sequence[str]]:
    """The element of each axis, and the names of those that are none. Raises DocumentError."""
    if hints.columns is not None and len(hints.columns) != len(elements):
        raise DocumentError([f"{name}: has {len(elements)} axes, and --columns names {len(hints.columns)}"])
    found: dict[Axis, _AxisElement] = {}
    strangers = []
    for index, element in enumerate(elements):
        axis = axis_named(element.name if hints.columns is None else str(hints.columns[index]))
        if axis is None or (hints.axes is not None and axis not in hints.axes):
            strangers.append(element.name or f"number {index + 1}")
            continue
        if axis in found:
            raise DocumentError([f"{name}:{element.line}: has {axis} twice: give --columns"])
        _check(element, axis, name)
        found[axis] = element
    if not found:
        names = ", ".join(element.name for element in elements) or "none"
        text = f"has no axis called pan, tilt, roll or focus (it has {names}): give --columns, in the order of the file"
        raise DocumentError([f"{name}: {text}"])
    return found, strangers


def _check(element: _AxisElement, axis: Axis, name: str) -> None:
    """Raises DocumentError for an axis that has no curve, or one in another unit."""
    here = f"{name}:{element.line}: {axis}"
    if axis.is_angle and element.units not in ("", "deg"):
        raise DocumentError([f"{here} is in {element.units!r}: its units must be deg"])
    if not element.points:
        raise DocumentError([f"{here} has no points"])
    if any(after[0] <= before[0] for before, after in pairwise(element.points)):
        raise DocumentError([f"{here}: each point must be at a later frame than the one before"])
    if element.handles and len(element.handles) != 2 * (len(element.points) - 1):
        text = f"has {len(element.handles)} control points, not {2 * (len(element.points) - 1)}"
        raise DocumentError([f"{here} {text} (two for each way)"])
    most = MOST_DEGREES if axis.is_angle else 1.0
    if any(abs(y) > most * (1 + 1e-9) for _, y in element.points):
        reach = f"within {most:g} degrees" if axis.is_angle else "from 0 to 1"
        raise DocumentError([f"{here} must be {reach}"])


class _Reader:
    """Turns expat's events into axes; every refusal has its line."""

    def __init__(self, name: str) -> None:
        self.name = name
        self.axes: list[_AxisElement] = []
        self._depth = self._count = 0
        self._parser = expat.ParserCreate(namespace_separator=" ")
        self._parser.StartElementHandler = self._start
        self._parser.EndElementHandler = self._end
        self._parser.StartDoctypeDeclHandler = self._doctype
        self._parser.EntityDeclHandler = self._doctype

    def parse(self, raw: bytes) -> None:
        """Raises DocumentError."""
        try:
            self._parser.Parse(raw, True)
        except expat.ExpatError as error:
            text = expat.ErrorString(error.code)
            raise DocumentError([f"{self.name}:{error.lineno}: is not XML: {text}"]) from None
        except (ValueError, LookupError) as error:  # an encoding that there is not
            raise DocumentError([f"{self.name}:1: is not XML: {error}"]) from None

    def _refuse(self, text: str) -> None:
        raise DocumentError([f"{self.name}:{self._parser.CurrentLineNumber}: {text}"])

    def _doctype(self, *_: object) -> None:
        self._refuse("has a document type (DTD), which no move has; it is not read")

    def _start(self, tag: str, attributes: Mapping[str, str]) -> None:
        self._depth += 1
        self._count += 1
        if self._depth > DEEPEST or self._count > MOST_ELEMENTS:
            self._refuse("is nested too deeply" if self._depth > DEEPEST else "has too many elements")
        space, _, local = tag.rpartition(" ")
        if self._depth == 1 and (space, local) != (SCENE, "scene"):
            self._refuse(f"is not a Dragonframe move: its root must be scene of {SCENE}")
        if space != SCENE:
            return
        if local == "axis" and self._depth == 2:
            if len(self.axes) >= MOST_AXES:
                self._refuse(f"has more than {MOST_AXES} axes")
            line = self._parser.CurrentLineNumber
            self.axes.append(_AxisElement(line, attributes.get("name", "")[:100], attributes.get("units", "")[:20]))
        elif local in ("points", "controlPoints") and self._depth == 3 and self.axes:
            axis = self.axes[-1]
            kept = axis.points if local == "points" else axis.handles
            kept.append((self._number(local, "x", attributes), self._number(local, "y", attributes)))

    def _end(self, _tag: str) -> None:
        self._depth -= 1

    def _number(self, element: str, key: str, attributes: Mapping[str, str]) -> float:
        given = attributes.get(key, "")
        try:
            value = float(given)
        except ValueError:
            value = math.nan
        if not abs(value) < 1e9:
            self._refuse(f"{element} {key} must be a number, not {given[:40]!r}")
        return value


def _parsed(raw: bytes, name: str) -> list[_AxisElement]:
    if not raw.strip():
        raise DocumentError([f"{name}: is empty"])
    reader = _Reader(name)
    reader.parse(raw)
    return reader.axes

"""A panorama in a sequence file: rows and columns of frames out of a field of view, as keys and shutters.

What is given is what shall be seen, edge to edge, and how much two neighbors shall share; how many frames that takes,
and how far apart, follows. They are spread evenly, so neighbors share what was asked for or more. A whole circle has
no edges: there the last frame of a row is as far from the first as from its neighbor. The way is a serpentine, so
that every step is a short one, and one frame follows another `every` so many seconds.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Annotated, Any, NamedTuple

from pydantic import Field

from teleop.config.documents.base_model import Finite, Section
from teleop.config.documents.document import Wrong, mapping, number, numbered, sequence
from teleop.config.documents.json_types import MOST_OVERLAP, Overlap, Time
from teleop.config.quantities import percentage, seconds
from teleop.core.axes import Axis, Limits
from teleop.core.timing import SAME_TIME
from teleop.planner.keyframes.keys import Key

WHERE = "panorama"
MOST = 2000  # frames
STILL = 0.5  # s, before each shutter and after it, unless the file says otherwise
BIGGEST = 1e6  # deg: what is beyond is for others to refuse
ROUNDING = 1e-9  # of a frame: what is that close to a whole number is one
TIMES = ("at", "every", "settle", "exposure")

Pair = Annotated[list[Finite], Field(min_length=2, max_length=2)]
Angles = Annotated[list[Annotated[Finite, Field(gt=0, lt=180)]], Field(min_length=2, max_length=2)]


class PanoramaSection(Section):
    """Rows and columns of frames, from the field of view of a lens."""

    fov: Angles
    """Field of view of the lens, across and up, in deg."""
    overlap: Overlap = "30%"
    """Share of a frame that its neighbor sees: `30%`."""
    pan: Pair
    """First and last edge of the picture in deg; shooting begins at the first."""
    tilt: Pair
    """First and last edge of the picture in deg, up and down."""
    every: Time
    """Time from one shutter to the next: `3s`."""
    settle: Time = STILL
    """Rest before the shutter: `0.5s`."""
    exposure: Time = STILL
    """Rest after the shutter: `0.5s`."""
    at: Time = 0
    """Time at which the panorama begins."""


class Grid(NamedTuple):
    """The columns' pans and the rows' tilts, in deg, in the order in which they are shot."""

    pans: list[float]
    tilts: list[float]

    def frames(self) -> Iterator[tuple[float, float]]:
        """Pan and tilt of each frame: every other row goes back."""
        for row, tilt in enumerate(self.tilts):
            for pan in self.pans if row % 2 == 0 else reversed(self.pans):
                yield pan, tilt


class Shots(NamedTuple):
    """A panorama as keys, and when its shutters are."""

    keys: Mapping[Axis, list[Key]]
    shutters: list[float]


def grid(fov: list[float], overlap: float, pan: list[float], tilt: list[float]) -> Grid:
    """The frames that show all between two edges each way, `overlap` being a share; all else in deg."""
    across = centers(pan[0], pan[1], fov[0], overlap, _is_circle(pan))
    return Grid(across, centers(tilt[0], tilt[1], fov[1], overlap))


def _is_circle(pan: Sequence[float]) -> bool:
    return abs(pan[1] - pan[0]) >= 360


def centers(first: float, last: float, fov: float, overlap: float, circle: bool = False) -> list[float]:
    """Where to aim, from the first edge to the last, in deg."""
    start, end = outermost(first, last, fov, overlap, circle)
    count = _count(abs(last - first), fov, overlap, circle)
    return [start + (end - start) * index / max(count - 1, 1) for index in range(count)]


def outermost(first: float, last: float, fov: float, overlap: float, circle: bool = False) -> tuple[float, float]:
    """Where to aim first and last, in deg."""
    width = abs(last - first)
    inward = width / _count(width, fov, overlap, circle) / 2 if circle else min(fov, width) / 2
    inward = math.copysign(inward, last - first)
    return first + inward, last - inward


def _count(width: float, fov: float, overlap: float, circle: bool) -> int:
    step = fov * (1 - overlap)
    return max(1, math.ceil((width if circle else width - fov * overlap) / step - ROUNDING))


def shots(section: PanoramaSection, fps: float | None) -> Shots:
    """The keys and shutters of a panorama that has passed its rules."""
    at, every, settle, exposure = (
        seconds(each, fps) for each in (section.at, section.every, section.settle, section.exposure)
    )
    keys: dict[Axis, list[Key]] = {Axis.PAN: [], Axis.TILT: []}
    shutters = []
    for index, aim in enumerate(grid(section.fov, percentage(section.overlap), section.pan, section.tilt).frames()):
        time = at + index * every
        shutters.append(time + settle)
        for of_axis, position in zip(keys.values(), aim, strict=True):
            of_axis.append(Key(time, position, True, settle + exposure, numbered(WHERE, index)))
    return Shots(keys, shutters)


def still_seconds(section: Mapping[str, Any], fps: float | None) -> float:
    """How long the axes rest at each shot, in s."""
    return sum(seconds(section.get(name, STILL), fps) for name in ("settle", "exposure"))


def panorama_rules(data: Any, fps: float | None) -> Iterator[Wrong]:
    """What is wrong with a panorama beyond its single values."""
    section = mapping(data, WHERE)
    given: dict[str, float] = {"settle": STILL, "exposure": STILL}
    for name in TIMES:
        try:
            if name in section:
                given[name] = seconds(section[name], fps)
        except ValueError as error:
            yield (WHERE, name), str(error)
    for name, most in (("pan", 360.0), ("tilt", 180.0)):
        if (ends := _pair(section, name)) and abs(ends[1] - ends[0]) > most:
            yield (WHERE, name), f"must be at most {most:g} deg from edge to edge"
    still = given["settle"] + given["exposure"]
    if "every" in given and given["every"] < still + SAME_TIME:
        yield (WHERE, "every"), f"must be longer than settle and exposure ({still:g} s), or there is no time to move"
    try:
        overlap = percentage(section.get("overlap", "30%"))
        if overlap > MOST_OVERLAP:
            yield (WHERE, "overlap"), f"must be at most {MOST_OVERLAP:.0%}"
            return
    except ValueError as error:
        yield (WHERE, "overlap"), str(error)
        return
    if (counted := _counted(section, overlap)) and counted > MOST:
        yield (WHERE,), f"would be {counted:.0f} frames; at most {MOST}: use a wider fov or less overlap"


def _counted(section: Mapping[str, Any], overlap: float) -> float | None:
    """How many frames it would be, about; None where that is unknown."""
    fov, pan, tilt = (_pair(section, name) for name in ("fov", "pan", "tilt"))
    if not fov or not pan or not tilt or min(fov) <= 0:
        return None
    return math.prod(
        max(1.0, abs(ends[1] - ends[0]) / each / (1 - overlap)) for ends, each in ((pan, fov[0]), (tilt, fov[1]))
    )


def _pair(section: Mapping[str, Any], name: str) -> tuple[float, float] | None:
    """Two finite numbers, None where something else stands."""
    numbers = [value for value in map(number, sequence(section, name)) if value is not None and abs(value) < BIGGEST]
    return (numbers[0], numbers[1]) if len(numbers) == len(sequence(section, name)) == 2 else None


def panorama_limits(data: Any, limits: Mapping[str, Limits], rig: str) -> Iterator[Wrong]:
    """Every frame lies within the soft limits of the rig."""
    section = mapping(data, WHERE)
    fov = _pair(section, "fov")
    for index, name in enumerate(("pan", "tilt") if section else ()):
        ends = _pair(section, name)
        if name not in limits:
            yield (WHERE, name), f": {rig} has no {name}; it has {', '.join(limits)}"
        elif ends and fov and min(fov) > 0 and not _is_circle(ends):
            low, high = limits[name].minimum, limits[name].maximum
            aims = sorted(outermost(*ends, fov[index], 0.0))
            if aims[0] < low or aims[1] > high:
                yield (WHERE, name), f"aims from {aims[0]:g} to {aims[1]:g}, and {rig} has {low:g}..{high:g}"

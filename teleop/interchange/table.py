"""The formats, a row each; a format's module is imported when it is used.

A module has `write(motion, options) -> bytes` and `read(raw, name, hints) -> Motion`; `read` raises DocumentError with
a line for what is wrong, and nothing else, whatever the bytes are.
"""

from __future__ import annotations

import importlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from importlib.util import find_spec
from pathlib import Path
from types import ModuleType
from typing import Any

from teleop.core.axes import STICKS, Axis
from teleop.core.errors import UsageError
from teleop.interchange.motion import CAMERA

ANY = (*CAMERA, Axis.FOCUS, *STICKS)
HEADS = (*CAMERA, Axis.FOCUS)


@dataclass(frozen=True)
class WriteOptions:
    """What a writer needs beside the path: the vertical field of view in degrees, None where it is not known.

    `not_carried` are the lines that a format with a place for them has within.
    """

    vfov: float | None = None
    axes: Sequence[Axis] = ()
    not_carried: Sequence[str] = ()


@dataclass(frozen=True)
class Hints:
    """What a file does not say by itself, from the file beside it or from the user; None where neither says it.

    `columns` are the axes by column, None for one to skip. `axes` are those that the path has, `start` where it begins
    (pan, tilt, roll), `camera` which camera of a scene.
    """

    rate: Fraction | None = None
    rotation_order: str | None = None
    columns: Sequence[str | None] | None = None
    axes: Sequence[Axis] | None = None
    start: tuple[float, float, float] | None = None
    camera: str | None = None


@dataclass(frozen=True)
class Format:
    """`carries` are the axes that it can have, `by_time` whether its rows can be at times of their own.

    `notes` are what the file beside it says of it, None for one that has a place for that within. `package` is what its
    library is imported as, `extra` what brings it.
    """

    name: str
    title: str
    endings: Sequence[str]
    module: str
    carries: Sequence[Axis]
    by_time: bool = False
    cues: bool = False
    order: bool = False
    notes: Mapping[str, Any] | None = None
    package: str = ""
    extra: str = ""

    def load(self) -> ModuleType:
        """Its module. Raises UsageError where a library is not installed."""
        if self.package and find_spec(self.package) is None:
            raise UsageError(f"{self.title} needs {self.package}: pip install 'rs-teleop[{self.extra}]'")
        return importlib.import_module(f"teleop.interchange.{self.module}")


TURNS = {"rx": "tilt, + is up", "ry": "-pan: + is left", "rz": "-roll: + is counterclockwise seen from behind"}
PLAIN = {
    "pan": "degrees, + is right",
    "tilt": "degrees, + is up",
    "roll": "degrees, + is clockwise seen from behind the camera",
    "focus": "0 is near, 1 is far",
}
"""What a column with the name of an axis has; the rotation order of the three is ZXY: pan, then tilt, then roll."""

FORMATS: Sequence[Format] = (
    Format(
        "chan",
        "Nuke .chan",
        (".chan",),
        "chan",
        CAMERA,
        order=True,
        notes={
            "columns": ["frame", "tx", "ty", "tz", "rx", "ry", "rz", "vfov"],
            "units": {"frame": "frames", "tx ty tz": "no position: always 0", "rx ry rz vfov": "degrees"},
            "directions": TURNS,
            "world": "y is up; a camera that is not turned looks along -z",
        },
    ),
    Format("csv", "CSV", (".csv",), "csv_table", ANY, by_time=True, notes={"units": {**PLAIN, "time": "s"}}),
    Format(
        "arcm",
        "Dragonframe .arcm",
        (".arcm",),
        "arcm",
        HEADS,
        by_time=True,
        notes={"units": {**PLAIN, "x": "frames"}},
    ),
    Format("raw", "Dragonframe raw move", (".raw",), "raw_move", HEADS, notes={"units": PLAIN}),
    Format("kuper", "Kuper ASCII", (".asc", ".ascii"), "kuper", HEADS, notes={"units": PLAIN}),
    Format("usd", "USD camera", (".usda", ".usdc", ".usd"), "usd", HEADS, by_time=True, package="pxr", extra="usd"),
    Format("blender", "Blender script", (".py",), "blender", CAMERA, by_time=True),
    Format(
        "otio",
        "OpenTimelineIO",
        (".otio",),
        "otio",
        ANY,
        by_time=True,
        cues=True,
        package="opentimelineio",
        extra="timeline",
    ),
)
BY_NAME: Mapping[str, Format] = {each.name: each for each in FORMATS}
AMBIGUOUS: Mapping[str, str] = {".txt": "a raw move of Dragonframe or Kuper ASCII"}
"""Endings of more than one format."""
READABLE = sorted({ending for each in FORMATS for ending in each.endings})


def format_of(path: Path, name: str | None, option: str) -> Format | None:
    """The format of a file by `name`, else by its ending; None for an ending of several. Raises UsageError."""
    if name is not None:
        if name not in BY_NAME:
            raise UsageError(f"--format {name}: must be one of {', '.join(BY_NAME)}")
        return BY_NAME[name]
    ending = path.suffix.lower()
    if ending in AMBIGUOUS:
        return None
    found = next((each for each in FORMATS if ending in each.endings), None)
    if found is None:
        raise UsageError(f"{option}{path}: its ending must be one of {', '.join(READABLE)}; or give --format")
    return found

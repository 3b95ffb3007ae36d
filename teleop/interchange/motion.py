"""What every format carries, or a part of it: where the axes are at each frame, and what happens once beside it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from teleop.config.documents.document import DocumentError
from teleop.config.frame_rates import shown_rate
from teleop.core.axes import Axis
from teleop.planner.polynomial import Array

CAMERA: tuple[Axis, ...] = (Axis.PAN, Axis.TILT, Axis.ROLL)
"""What turns a camera; a format of cameras has these three in every row."""
MOST_FRAMES = 20_000  # of an import, as of a table in a sequence: 14 minutes at 24 fps
MOST_RATE = 1000  # frames a second
MOST_DEGREES = 36_000.0  # a hundred turns: more is no camera's path
EVEN = 1e-6  # s by which frames may be off their grid


class TimedCue(NamedTuple):
    """A cue at a time (s): what a sequence file has of it, as in `{camera: record}`."""

    at: float
    content: Mapping[str, str]

    @property
    def name(self) -> str:
        """As a marker is called: `camera: record`."""
        return ", ".join(f"{kind}: {value}" for kind, value in self.content.items())


@dataclass(frozen=True, eq=False)
class Motion:
    """A path of axes: `positions` (n,) in units at `times` (n,) in s, rising; NaN where a frame is not known.

    Frames are counted from `first` on, `rate` of them a second; None: the file does not say. `lines` are where the
    frames are in a text file, by index. `origin` says what it was made of, `kind` is planned, measured or commanded.
    `corners` are indices of frames that were keys in the file. `remarks` are lines for the user.
    """

    title: str
    times: Array
    positions: Mapping[Axis, Array]
    rate: Fraction | None = None
    first: int = 1
    cues: Sequence[TimedCue] = ()
    origin: str = ""
    kind: str = "planned"
    corners: Sequence[int] = ()
    lines: Sequence[int] = ()
    remarks: Sequence[str] = field(default_factory=list)

    @property
    def axes(self) -> Sequence[Axis]:
        return list(self.positions)

    @property
    def known_rate(self) -> Fraction:
        """The rate of a path that is written, which always has one."""
        assert self.rate is not None
        return self.rate

    @property
    def frames(self) -> Array:
        """The number of each row: whole for frames, with a fraction for readings at times of their own."""
        numbers = self.first + self.times * float(self.known_rate)
        whole = np.round(numbers)
        return np.where(np.abs(numbers - whole) < EVEN, whole, numbers)

    @property
    def by_frame(self) -> bool:
        """Whether each row is a frame, and every frame has a row."""
        frames = self.frames
        return bool((frames == self.first + np.arange(len(frames))).all())

    def column(self, axis: Axis) -> Array:
        """The positions of an axis; 0 for one that is not there."""
        return self.positions.get(axis, np.zeros(len(self.times)))


def within_reach(positions: Mapping[Axis, Array], name: str) -> Mapping[Axis, Array]:
    """The positions, where they are any. Raises DocumentError for a hundred turns, or a share beyond 1."""
    for axis, column in positions.items():
        wrong = out_of_reach(axis, column)
        if wrong.any():
            row = int(wrong.argmax())
            raise DocumentError([f"{name}: row {row + 1}: {axis} must be {reach(axis)}, not {column[row]:g}"])
    return positions


def out_of_reach(axis: Axis, column: Array) -> NDArray[np.bool_]:
    """Where a position is none: more than a hundred turns, a share beyond 1, or not a number."""
    most = MOST_DEGREES if axis.is_angle else 1.0
    return ~(np.abs(column) <= most * (1 + 1e-9))


def reach(axis: Axis) -> str:
    """Where its positions must be, for people."""
    return f"within {MOST_DEGREES:g} degrees" if axis.is_angle else "from -1 to 1"


def number_rows(rows: Any, width: int, name: str, what: str) -> Array:
    """Rows (n, width) of finite numbers; the first is a time, later from row to row. Raises DocumentError."""
    try:
        found = np.array(rows, dtype=float)
    except (TypeError, ValueError, OverflowError):
        found = np.empty(0)
    if found.shape[1:] != (width,) or not 0 < len(found) <= MOST_FRAMES:
        raise DocumentError([f"{name}: {what} must be 1 to {MOST_FRAMES} rows of {width} numbers"])
    if not (np.abs(found) < 1e9).all() or (np.diff(found[:, 0]) <= 0).any():
        raise DocumentError([f"{name}: {what} must be numbers, each row later than the one before"])
    return found


def shown(rate: Fraction) -> str:
    """For people: `24 fps`, `23.976 fps`."""
    return f"{shown_rate(float(rate))} fps"

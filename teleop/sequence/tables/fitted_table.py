"""A table's columns as keys of axes, on a clock that begins at its first frame.

Angles that jump by half a turn or more from frame to frame go on over the seam at 180 degrees, and begin in the turn
in which the rig's soft limits are.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from teleop.config.documents.document import Document, DocumentError, UnplayableError
from teleop.config.files_read import note
from teleop.config.frame_rates import shown_rate
from teleop.core.axes import Axis, Limits
from teleop.planner.keyframes.frame_keys import Frames
from teleop.planner.keyframes.frames import FrameFitter, FramesFit, NoRoomError, TooFastError
from teleop.planner.keyframes.keys import Key
from teleop.planner.polynomial import Array
from teleop.sequence.tables.section import RUN_OUT, RUN_UP, WHERE, ColumnSection, SourceSection
from teleop.sequence.tables.table_file import MOST_FRAMES, Table, read_table
from teleop.sequence.tables.timed_frames import TimedFrames

SHIFT = 1e-9  # units: rounding of scaled positions beside a soft limit


@dataclass(frozen=True)
class FittedTable:
    """Keys and frames by axis, in s from the first frame on; the run-up begins `run_up` s before it.

    `end` is the time of the last frame. `lines` are where a key's frame is in the table, by the key's name; `remarks`
    are lines for the user.
    """

    keys: Mapping[Axis, Sequence[Key]]
    frames: Mapping[Axis, TimedFrames]
    run_up: float
    end: float
    table: str
    lines: Mapping[str, int]
    remarks: Sequence[str]


@dataclass(frozen=True)
class TableReader:
    """Reads the table of a `section` of `document`, which lies in `folder`, for a rig.

    Where it `may_stretch` and is too fast, it is slowed down.
    """

    document: Document
    section: SourceSection
    fps: float | None
    folder: Path
    limits: Mapping[Axis, Limits]
    rig: str
    may_stretch: bool = False

    def read(self) -> FittedTable:
        """Raises DocumentError for what is wrong with the table, UnplayableError for what only the rig cannot do."""
        file = self.folder / Path(self.section.file).expanduser()
        if not file.is_file():
            note(file)
            raise DocumentError([self._problem(f": no such file: {self.section.file}", "file")])
        table = read_table(file, str(Path(self.document.name).parent / self.section.file))
        numbers = self._numbers(table)
        positions = self._positions(table)
        fit = self._fit(numbers, positions)
        return self._fitted(fit, table, numbers, positions)

    def _problem(self, text: str, *path: str) -> str:
        return self.document.problem((WHERE, *path), text)

    def _numbers(self, table: Table) -> Sequence[int]:
        """The number of each row's frame, rising."""
        column = self.section.frame
        if column is None and not table.has("frame"):
            return range(1, len(table.rows) + 1)
        index = self._index(table, "frame" if column is None else column, "frame")
        values = table.values(index).tolist()
        for row, value in zip(table.rows, values, strict=True):
            if value != round(value):
                raise DocumentError([f"{table.place(row, index)}: a frame must be a whole number, not {value:g}"])
        for row, before, value in zip(table.rows[1:], values, values[1:], strict=False):
            if value <= before or value - values[0] >= MOST_FRAMES:
                wrong = f"must be after frame {before:g}" if value <= before else f"is too far: at most {MOST_FRAMES}"
                raise DocumentError([f"{table.place(row, index)}: frame {value:g} {wrong}"])
        return [int(value) for value in values]

    def _index(self, table: Table, column: str | int, *path: str) -> int:
        try:
            return table.index(column)
        except ValueError as error:
            raise DocumentError([self._problem(f": {error}", *path)]) from None

    def _positions(self, table: Table) -> Mapping[Axis, Array]:
        """Each axis at each row, in units. Raises with a line for each thing wrong with any of the columns."""
        problems: list[str] = []
        beyond: list[str] = []
        positions: dict[Axis, Array] = {}
        for axis, column in self.section.columns.given().items():
            try:
                index = self._index(table, column.column, "columns", axis.value)
                positions[axis] = _placed(axis, table.values(index), column, self.limits[axis])
            except DocumentError as error:
                problems += error.problems
                continue
            beyond += self._beyond(axis, positions[axis], table, index)
        if problems:
            raise DocumentError(problems)
        if beyond:
            raise UnplayableError(beyond)
        return positions

    def _beyond(self, axis: Axis, positions: Array, table: Table, index: int) -> Iterator[str]:
        """A line for an axis that leaves the soft limits: the frame at which it is furthest outside."""
        limits = self.limits[axis]
        worst = furthest_outside(positions, limits)
        if worst is not None:
            reach = f"{limits.minimum:g}..{limits.maximum:g} ({self.rig})"
            text = f"{axis} must be within {reach}, not {positions[worst]:g}; use another offset or scale"
            yield f"{table.place(table.rows[worst], index)}: {text}"

    def _fit(self, numbers: Sequence[int], positions: Mapping[Axis, Array]) -> FramesFit:
        section, rate = self.section, self.section.rate(self.fps)
        tables = []
        for axis, of_axis in positions.items():
            by_frame = np.full(numbers[-1] - numbers[0] + 1, math.nan)
            by_frame[np.array(numbers) - numbers[0]] = of_axis
            tables.append(Frames(axis, by_frame, section.allowed(axis), self.limits[axis]))
        runs = (section.run(which, self.fps) for which in ("run_up", "run_out"))
        try:
            return FrameFitter(tables, rate, *runs).fit(may_stretch=self.may_stretch)
        except TooFastError as error:
            raise UnplayableError([self._problem(_too_fast(error, self.rig, rate, numbers[0]))]) from None
        except NoRoomError as error:
            limits = self.limits[error.axis]
            what, run = f"get to speed before frame {numbers[0]}", "run_up"
            if error.after:
                what, run = f"come to rest after frame {numbers[-1]}", "run_out"
            room = "" if limits.continuous else f" within {limits.minimum:g}..{limits.maximum:g}"
            text = f": {error.axis} cannot {what}{room} ({self.rig}); use a longer {run}, or another offset"
            raise UnplayableError([self._problem(text)]) from None

    def _fitted(
        self, fit: FramesFit, table: Table, numbers: Sequence[int], positions: Mapping[Axis, Array]
    ) -> FittedTable:
        step = fit.factor / self.section.rate(self.fps)
        times = (np.array(numbers) - numbers[0]) * step
        lines = {f"frame {number}": row.line for number, row in zip(numbers, table.rows, strict=True)}
        count = numbers[-1] - numbers[0]
        keys = {
            axis: [
                Key(
                    place * step,
                    position,
                    where=_name(place, numbers[0], count),
                    tension=0.0,
                    overshoot=None if place == max(of_axis) else math.inf,
                )
                for place, position in of_axis.items()
            ]
            for axis, of_axis in fit.keys.items()
        }
        frames = {
            axis: TimedFrames(table.name, numbers, times, of_axis, self.section.allowed(axis))
            for axis, of_axis in positions.items()
        }
        remarks = []
        if fit.factor > 1:
            shown = f"stretched the table {fit.factor:.3f} x: its frames go by at {shown_rate(1 / step)} fps"
            remarks.append(self.document.problem(("fit",), shown))
        return FittedTable(keys, frames, fit.runs.up * step, count * step, table.name, lines, remarks)


def _name(place: int, first: int, count: int) -> str:
    if not 0 <= place <= count:
        return RUN_UP if place < 0 else RUN_OUT
    return f"frame {first + place}"


def _placed(axis: Axis, values: Array, column: ColumnSection, limits: Limits) -> Array:
    """A column's values in units; angles without a seam, and within the soft limits where whole turns do that."""
    positions = values * column.scale + column.offset
    if not axis.is_angle:
        return positions
    return within_turns(positions, limits)


def within_turns(angles: Array, limits: Limits) -> Array:
    """Angles without a seam, moved by whole turns into the soft limits where that brings all of them there."""
    positions = np.unwrap(angles, period=360.0)
    if limits.continuous:
        return positions
    least, most = float(np.nanmin(positions)), float(np.nanmax(positions))
    middle = (least + most - limits.minimum - limits.maximum) / 2
    turned = positions - 360.0 * round(middle / 360.0)
    return turned if _within(turned, limits) and not _within(positions, limits) else positions


def _within(positions: Array, limits: Limits) -> bool:
    least, most = np.nanmin(positions), np.nanmax(positions)
    return bool(least >= limits.minimum - SHIFT and most <= limits.maximum + SHIFT)


def furthest_outside(positions: Array, limits: Limits) -> int | None:
    """Where it is furthest outside the soft limits, None for nowhere; NaN is no position."""
    outside = np.nan_to_num(np.maximum(limits.minimum - positions, positions - limits.maximum), nan=-1.0)
    worst = int(outside.argmax())
    return worst if outside[worst] > SHIFT else None


def _too_fast(error: TooFastError, rig: str, rate: float, first: int) -> str:
    what = f": {error.axis} is too fast for {rig}"
    if error.share > 1:
        share = f"{error.share:.3g}" if error.share < 10 else f"{error.share:.0f}"
        what += f" (its {error.limit} would be {share} x the limit at frame {first + error.place})"
    if error.factor is None:
        return f"{what}; use a higher tolerance"
    slower = math.floor(1000 * rate / error.factor) / 1000
    return f"{what}; use fps: {slower:g} ({rate / slower:.2f} x slower), `fit: stretch`, or a higher tolerance"

"""Sticks replayed from a CSV file, as a joystick would have reported them.

The file is read and checked whole before anything moves. A row's deflections hold until the next row; the last row
marks the end, where every stick is let go. A centered stick has no opinion, so whatever lies beneath it drives; but a
drone's stick is held where the row has it, in its center too.
"""

from __future__ import annotations

import bisect
import csv
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from teleop.config.documents.document import DocumentError
from teleop.config.documents.messages import nearest
from teleop.core.axes import Axis, Motion
from teleop.core.events import SourceEvent, TickEvent
from teleop.core.interfaces import Feedback
from teleop.core.setpoints import Demand, PositionTarget, Setpoint, VelocityTarget

MAX_PROBLEMS = 20  # a file with its columns swapped is wrong in every row


@dataclass(frozen=True)
class Sticks:
    """A recording of sticks: `times` in s from its start, rising; for each a deflection (-1..1) of each of the axes."""

    axes: Sequence[Axis]
    times: Sequence[float]
    deflections: Sequence[Sequence[float]]


def read_sticks(file: Path, known: Sequence[Axis]) -> Sticks:
    """The CSV file's sticks, for axes among those `known`; raises DocumentError with a line for everything wrong."""
    try:
        with file.open(newline="", encoding="utf-8-sig") as stream:
            rows = [(reader.line_num, row) for reader in [csv.reader(stream)] for row in reader if any(row)]
    except OSError as error:
        raise DocumentError([f"{file}: cannot be read: {error.strerror or error}"]) from None
    except (UnicodeDecodeError, csv.Error) as error:
        raise DocumentError([f"{file}: is not a CSV file: {error}"]) from None
    if not rows:
        raise DocumentError([f"{file}:1: the file is empty; its first line names the columns: time,pan,tilt"])
    columns = [column.strip() for column in rows[0][1]]
    if problems := _column_problems(columns, known):
        raise DocumentError([f"{file}:{rows[0][0]}: {problem}" for problem in problems])
    return _read_rows(file, columns, rows[1:])


def _column_problems(columns: Sequence[str], known: Sequence[Axis]) -> list[str]:
    problems = [] if "time" in columns else ["there is no column called time"]
    if columns == ["time"]:
        problems.append("no column names an axis")
    for index, column in enumerate(columns):
        if column in columns[:index]:
            problems.append(f"duplicate column {column}")
        elif column != "time" and column not in [axis.value for axis in known]:
            names = [axis.value for axis in known]
            near = nearest(column, names) or f"; it has {', '.join(names)}"
            problems.append(f"{column!r} is not an axis of this rig{near}")
    return problems


def _read_rows(file: Path, columns: Sequence[str], rows: Sequence[tuple[int, Sequence[str]]]) -> Sticks:
    problems: list[str] = [] if rows else [f"{file}:1: there are no rows below the column names"]
    axes = [Axis(column) for column in columns if column != "time"]
    times: list[float] = []
    deflections: list[Sequence[float]] = []
    for line, row in rows:
        try:
            values = _row(columns, row)
            if times and values["time"] <= times[-1]:
                raise ValueError(f"time must be after the row before it ({times[-1]:g} s)")
        except ValueError as error:
            problems.append(f"{file}:{line}: {error}")
            continue
        times.append(values["time"])
        deflections.append([values[axis] for axis in axes])
    if problems:
        more = len(problems) - MAX_PROBLEMS
        raise DocumentError(problems[:MAX_PROBLEMS] + ([f"{file}: and {more} more"] if more > 0 else []))
    return Sticks(axes, times, deflections)


def _row(columns: Sequence[str], row: Sequence[str]) -> Mapping[str, float]:
    if len(row) != len(columns):
        raise ValueError(f"has {len(row)} values for {len(columns)} columns")
    values = {}
    for column, text in zip(columns, row, strict=True):
        try:
            value = float(text)
        except ValueError:
            raise ValueError(f"{column} must be a number, not {text!r}") from None
        if column == "time" and not (math.isfinite(value) and value >= 0):
            raise ValueError(f"time must be 0 s or later, not {text}")
        if column != "time" and not -1 <= value <= 1:
            raise ValueError(f"{column} must be -1..1, not {text}")
        values[column] = value
    return values


class SticksSource:
    """Plays `sticks`; `velocity` turns an axis's deflection into unit/s."""

    def __init__(self, sticks: Sticks, velocity: Callable[[Axis, float], float]) -> None:
        self._sticks, self._velocity = sticks, velocity
        self._suspended = math.inf  # when the axes were halted, on the loop's clock
        self.begin = math.inf  # when the recording's time is zero, on the loop's clock

    pauses = busy = quits = False  # it has no path to pause on, and begins nothing

    @property
    def resumable(self) -> bool:
        """A drone's sticks, held for longer, fly it somewhere else."""
        return not any(axis.is_stick for axis in self._sticks.axes)

    def pause(self, now: float) -> bool | None:  # noqa: ARG002 - see `pauses`
        return False

    def suspend(self, now: float) -> None:
        """The recording stands still."""
        self._suspended = now

    def linger(self, now: float) -> Sequence[TickEvent]:  # noqa: ARG002 - it does nothing but move
        return ()

    def resume(self, now: float, motion: Motion) -> None:  # noqa: ARG002 - sticks do not mind where the axes are
        self.begin += now - self._suspended
        self._suspended = math.inf

    def start(self, now: float, motion: Motion) -> None:  # noqa: ARG002 - sticks do not mind where the axes are
        self.begin = now

    def read(self, now: float, _feedback: Feedback) -> tuple[Demand, Sequence[SourceEvent]]:
        """The deflections of the last row whose time has come, as velocities."""
        row = bisect.bisect_right(self._sticks.times, now - self.begin + 1e-9) - 1
        if row < 0 or row == len(self._sticks.times) - 1:
            return {axis: PositionTarget(0.0) for axis in self._sticks.axes if axis.is_stick}, ()
        held = zip(self._sticks.axes, self._sticks.deflections[row], strict=True)
        demand: dict[Axis, Setpoint] = {}
        for axis, deflection in held:
            if axis.is_stick:
                demand[axis] = PositionTarget(deflection)
            elif velocity := self._velocity(axis, deflection):
                demand[axis] = VelocityTarget(velocity)
        return demand, ()

    def next_change(self, now: float) -> float:
        now = min(now, self._suspended)
        row = bisect.bisect_right(self._sticks.times, now - self.begin + 1e-9)
        return self.begin + self._sticks.times[row] if row < len(self._sticks.times) else math.inf

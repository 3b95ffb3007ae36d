"""Text files with a row for each frame: how much of one is read, and how its columns become axes."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from fractions import Fraction

import numpy as np

from teleop.config.documents.document import DocumentError
from teleop.core.axes import Axis
from teleop.interchange.motion import MOST_FRAMES, out_of_reach, reach
from teleop.interchange.table import Hints
from teleop.planner.polynomial import Array
from teleop.sequence.tables.table_file import Table, decoded, parse_table

LONGEST_LINE = 4096  # characters: 200 columns
COMMENTS = 1000  # lines beside those of frames


def bounded(raw: bytes, name: str) -> str:
    """The text of a file that is a table at all. Raises DocumentError."""
    text = decoded(raw, name)
    if not text.strip():
        raise DocumentError([f"{name}: is empty"])
    lines = re.split(r"\r\n|\r|\n", text)
    if len(lines) > MOST_FRAMES + COMMENTS:
        raise DocumentError([f"{name}:{MOST_FRAMES + COMMENTS}: is too long: at most {MOST_FRAMES} frames"])
    for number, line in enumerate(lines, 1):
        if len(line) > LONGEST_LINE:
            raise DocumentError([f"{name}:{number}: is too long for a row: {len(line)} characters"])
    return text


def rows(text: str, name: str, *, chan: bool = False) -> Table:
    """The table in a text, with as many values in every row. Raises DocumentError."""
    table = parse_table(text, name, chan=chan)
    for row in table.rows:
        if len(row.cells) != table.width:
            wrong = f"has {len(row.cells)} values, and line {table.rows[0].line} has {table.width}"
            raise DocumentError([f"{name}:{row.line}: {wrong}"])
    return table


def values(table: Table, index: int, axis: Axis) -> Array:
    """A column (n,), finite, and of angles no more than a hundred turns. Raises DocumentError."""
    found = numbers(table, index)
    wrong = out_of_reach(axis, found)
    if wrong.any():
        row = table.rows[int(wrong.argmax())]
        given = row.cells[index].text[:40]
        raise DocumentError([f"{table.place(row, index)}: {axis} must be {reach(axis)}, not {given}"])
    return found


def numbers(table: Table, index: int) -> Array:
    """A column. Raises DocumentError with the first cell that is no number."""
    try:
        return table.values(index)
    except DocumentError as error:
        raise DocumentError(error.problems[:1]) from None


def rising(table: Table, index: int, what: str) -> Array:
    """A column of times or frames, from row to row later. Raises DocumentError."""
    found = numbers(table, index)
    wrong = ~np.isfinite(found)
    wrong[1:] |= ~(np.diff(found) > 0)
    if wrong.any():
        row = table.rows[int(wrong.argmax())]
        place = table.place(row, index)
        raise DocumentError([f"{place}: {what} must be later than in the row before, not {row.cells[index].text[:40]}"])
    return found


def frame_times(table: Table, index: int, rate: Fraction) -> tuple[Array, int]:
    """The times (s) of whole frames, and the number of the first. Raises DocumentError."""
    found = rising(table, index, "frame")
    broken = (found != np.round(found)) | (found - found[0] >= MOST_FRAMES) | (np.abs(found) > 1e9)
    if broken.any():
        row = table.rows[int(broken.argmax())]
        text = f"frame must be a whole number, at most {MOST_FRAMES} after the first, not {row.cells[index].text[:40]}"
        raise DocumentError([f"{table.place(row, index)}: {text}"])
    return (found - found[0]) / float(rate), int(found[0])


def needed_rate(hints: Hints, name: str) -> Fraction:
    """The rate of a file that does not have one. Raises DocumentError with the cure."""
    if hints.rate is None:
        raise DocumentError([f"{name}: does not say its frame rate: give --rate, as in --rate 24"])
    return hints.rate


def columns_of(hints: Hints, table: Table, name: str, names: Sequence[str] = ()) -> Mapping[Axis, int]:
    """Which column is which axis, by the user's list, else by `names`. Raises DocumentError."""
    listed = hints.columns if hints.columns is not None else [axis_named(each) for each in names]
    found: dict[Axis, int] = {}
    for index, each in enumerate(listed):
        if each in [*Axis]:
            axis = Axis(str(each))
            if axis in found:
                raise DocumentError([f"{name}:{table.rows[0].line}: has {axis} in two columns: give --columns"])
            found[axis] = index
    if hints.columns is not None and len(listed) != table.width:
        text = f"has {table.width} columns, and --columns (or the file beside it) names {len(listed)}"
        raise DocumentError([f"{name}:{table.rows[0].line}: {text}"])
    if not found:
        text = "does not say which column is which axis: give --columns, as in --columns pan,tilt,- (- skips one)"
        raise DocumentError([f"{name}: {text}"])
    return found


def axis_named(name: str) -> Axis | None:
    """The axis that other programs' names mean: `vPAN` is what Dragonframe and Kuper call a virtual one."""
    plain = name.strip().strip('"').lower()
    plain = plain[1:] if plain[1:] in ("pan", "tilt", "roll", "focus") and plain[0] == "v" else plain
    return Axis(plain) if plain in [*Axis] else {"yaw": Axis.PAN, "pitch": Axis.TILT}.get(plain)


def number(value: float, digits: int = 9) -> str:
    """With so many digits behind the point at most, no exponent, and no minus before nothing."""
    if not math.isfinite(value):
        raise ValueError(value)
    return f"{round(value, digits) + 0.0:.{digits}f}"

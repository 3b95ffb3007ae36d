"""A table of numbers in a text file: CSV or columns with blanks between, with or without names, a row for each frame.

Nuke's .chan, Kuper's ASCII, Dragonframe's raw moves and what spreadsheets save differ in separators, names, comments
and byte order marks only. A cell is read as a number when its column is used, so that columns of text do no harm.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import takewhile
from pathlib import Path
from typing import NamedTuple

import numpy as np

from teleop.config.documents.document import DocumentError
from teleop.config.documents.messages import decimal_comma, nearest, shown
from teleop.config.documents.read_bytes import read_bytes
from teleop.planner.polynomial import Array

MAX_BYTES = 16_000_000
MOST_FRAMES = 20_000  # 14 minutes at 24 fps
MOST_REPORTED = 20  # errors of one column
CHAN = ("frame", "tx", "ty", "tz", "rx", "ry", "rz", "vfov")  # the columns of Nuke's .chan, which has no names
UNITS = ("", "deg", "degrees", "°", "mm", "cm", "m", "in", "s", "frame", "frames", "counts", "steps")

_COMMENT = re.compile(r"\s*(#|//|%|!|;)")
_NUMBER = re.compile(r"[-+]?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][-+]?[0-9]+)?")
_BLANKS = re.compile(r"(?P<cell>\S+)")


class Cell(NamedTuple):
    """A value as it is written, and its column in the line, from 1."""

    text: str
    column: int

    @property
    def is_number(self) -> bool:
        return bool(_NUMBER.fullmatch(self.text))


class Row(NamedTuple):
    """The cells of a line, which has a number from 1."""

    line: int
    cells: Sequence[Cell]


@dataclass(frozen=True)
class Table:
    """The `rows` of a file that is called `name` in errors; `names` are those of its columns, if it has any."""

    name: str
    names: Sequence[str]
    rows: Sequence[Row]

    @property
    def width(self) -> int:
        return len(self.rows[0].cells)

    def index(self, column: str | int) -> int:
        """The place of a column, from 0. Raises ValueError with what is wrong, and which there are."""
        if isinstance(column, int):
            if column > self.width:
                raise ValueError(f"{self.name} has {self.width} columns")
            return column - 1
        found = [i for i, name in enumerate(self.names) if name == column]
        found = found or [i for i, name in enumerate(self.names) if name.lower() == column.strip().lower()]
        if len(found) > 1:
            raise ValueError(f"{self.name} has {len(found)} columns {column!r}; use the number of one, from 1")
        if found:
            return found[0]
        if not self.names:
            raise ValueError(f"{self.name} has no names; use a number from 1 to {self.width}")
        near = nearest(column, self.names) or f"; it has {', '.join(name for name in self.names if name)}"
        raise ValueError(f"{self.name} has no column {column!r}{near}")

    def has(self, column: str) -> bool:
        return [name.lower() for name in self.names].count(column) == 1

    def values(self, index: int) -> Array:
        """The numbers (n,) of a column. Raises DocumentError with a line for each cell that is none."""
        called = repr(self.names[index]) if self.names and self.names[index] else f"column {index + 1}"
        problems = []
        for row in self.rows:
            if index >= len(row.cells):
                text = f"has {len(row.cells)} values, and line {self.rows[0].line} has {self.width}"
                problems.append(f"{self.place(row, 0)}: {text}")
            elif not row.cells[index].is_number:
                given = row.cells[index].text
                wrong = decimal_comma(given) or f"{called} must be a number, not {shown(given) if given else 'empty'}"
                problems.append(f"{self.place(row, index)}: {wrong}")
        if problems:
            raise DocumentError(problems[:MOST_REPORTED], max(0, len(problems) - MOST_REPORTED))
        return np.array([float(row.cells[index].text) for row in self.rows])

    def place(self, row: Row, index: int) -> str:
        """`track.csv:12:7`."""
        return f"{self.name}:{row.line}:{row.cells[index].column}"


def read_table(file: Path, name: str) -> Table:
    """The table in `file`. Raises DocumentError where it cannot be read, or has no numbers."""
    raw = read_bytes(file, name, MAX_BYTES)
    return parse_table(decoded(raw, name), name, chan=file.suffix.lower() == ".chan")


def decoded(raw: bytes, name: str) -> str:
    """The text of a table's bytes, UTF-8 or UTF-16. Raises DocumentError for what is no text."""
    text = raw.decode("utf-16" if raw[:2] in (b"\xff\xfe", b"\xfe\xff") else "utf-8-sig", "replace")
    if "\0" in text:
        raise DocumentError([f"{name}:1:1: is not text; save the table as CSV"])
    return text


def parse_table(text: str, name: str, *, chan: bool = False) -> Table:
    """The table in a text; one of `chan` that has no names has those of the format. Raises DocumentError."""
    lines = [(number, line) for number, line in enumerate(re.split(r"\r\n|\r|\n", text), 1) if line.strip()]
    separator = _separator([line for _, line in lines if not _COMMENT.match(line)])
    kept = [(number, line) for number, line in lines if not _is_comment(line, separator)]
    rows = [Row(number, _cells(line, separator)) for number, line in kept]
    above = list(takewhile(lambda row: not any(cell.is_number for cell in row.cells), rows))
    rows = rows[len(above) :]
    if not rows:
        raise DocumentError([f"{name}:1:1: has no row of numbers"])
    if len(rows) > MOST_FRAMES:
        raise DocumentError([f"{name}:{rows[MOST_FRAMES].line}:1: is too much: at most {MOST_FRAMES} frames"])
    comments = [line for number, line in lines if number < rows[0].line and _is_comment(line, separator)]
    above += [Row(0, _cells(_COMMENT.sub("", line, count=1), separator)) for line in comments[-1:]]
    width = max(_filled(row) for row in (*rows, *(row for row in above if len(row.cells) == len(rows[0].cells))))
    rows, above = ([Row(row.line, _ended(row, width)) for row in each] for each in (rows, above))
    named = next((row for row in reversed(above) if len(row.cells) == len(rows[0].cells) and not _has_units(row)), None)
    names = [cell.text for cell in named.cells] if named else CHAN[: len(rows[0].cells)] if chan else []
    return Table(name, names, rows)


def _has_units(row: Row) -> bool:
    """Whether it is a line of units below the names."""
    return all(cell.text.lower().strip("()[]") in UNITS for cell in row.cells)


def _is_comment(line: str, separator: str) -> bool:
    found = _COMMENT.match(line)
    return found is not None and found[1] != separator


def _separator(lines: Sequence[str]) -> str:
    """What is between the cells, by the line with the most numbers in it: a tab, `;`, `,`, or "" for blanks."""
    line = next((line for line in lines if any(map(str.isdigit, line)) and not any(map(str.isalpha, line))), "")
    line = line or (lines[0] if lines else "")
    if any(decimal_comma(part) for part in line.split()) and len(line.split()) > 1:
        return next((mark for mark in "\t;" if mark in line), "")
    return next((mark for mark in "\t;," if mark in line.strip()), "")


def _cells(line: str, separator: str) -> Sequence[Cell]:
    if not separator:
        return [Cell(found["cell"].strip('"'), found.start() + 1) for found in _BLANKS.finditer(line)]
    cells, start = [], 0
    for part in _split(line, separator):
        text = part.strip()
        column = start + len(part) - len(part.lstrip()) + 1 if text else start + 1
        quoted = len(text) > 1 and text[0] == text[-1] == '"'
        cells.append(Cell(text[1:-1].replace('""', '"').strip() if quoted else text, column))
        start += len(part) + 1
    return cells


def _filled(row: Row) -> int:
    """How many cells it has, without an empty one at its end."""
    return len(row.cells) - (len(row.cells) > 1 and not row.cells[-1].text)


def _ended(row: Row, width: int) -> Sequence[Cell]:
    """Its cells, without a separator at its end that begins no column: a last column may be empty in some rows."""
    return row.cells[: _filled(row)] if len(row.cells) > width else row.cells


def _split(line: str, separator: str) -> Sequence[str]:
    """At separators that are not within double quotes."""
    parts, quoted = [""], False
    for letter in line:
        quoted ^= letter == '"'
        if letter == separator and not quoted:
            parts.append("")
        else:
            parts[-1] += letter
    return parts

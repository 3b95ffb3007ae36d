"""Dragonframe's raw move text: a row for each frame, a column for each axis, each 12 characters and 4 blanks wide.

Angles are in degrees. There are no names, no units and no rate: they are in the file beside it. Source: the exporter
BlenderMoco, whose files Dragonframe imports as Raw Move.
"""

from __future__ import annotations

import re

import numpy as np

from teleop.config.documents.document import DocumentError
from teleop.interchange.motion import Motion
from teleop.interchange.table import Hints, WriteOptions
from teleop.interchange.text import bounded, columns_of, needed_rate, number, rows, values

WIDTH, BETWEEN = 12, 4
DIGITS = 7
ROW = re.compile(rb"(?:[-+.0-9eE]+ *(?<=[-+.0-9eE ]{12}) {4})+\r?\n")


def write(motion: Motion, options: WriteOptions) -> bytes:
    """The columns are the axes in the order of `options`. Raises DocumentError for what 12 characters cannot hold."""
    columns = np.array([motion.column(axis) for axis in options.axes]).T.tolist()
    return "".join("".join(map(_cell, row)) + "\n" for row in columns).encode()


def _cell(value: float) -> str:
    text = number(value, DIGITS)[:WIDTH]
    if abs(float(text) - value) > 1e-6:
        raise DocumentError([f"raw move: {value:g} does not fit into 12 characters; use another format"])
    return text.ljust(WIDTH) + " " * BETWEEN


def read(raw: bytes, name: str, hints: Hints) -> Motion:
    """Which column is which axis is the user's, or in the file beside it."""
    table = rows(bounded(raw, name), name)
    columns = columns_of(hints, table, name)
    times = np.arange(len(table.rows)) / float(needed_rate(hints, name))
    positions = {axis: values(table, index, axis) for axis, index in columns.items()}
    return Motion("", times, positions, hints.rate, lines=[row.line for row in table.rows])


def is_raw_move(raw: bytes) -> bool:
    """Whether a file is certainly one of these: its first row has numbers in columns of 16 characters."""
    return ROW.match(raw) is not None

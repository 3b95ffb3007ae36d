"""Kuper's ASCII moves: a first line `Axes = Pan, Tilt`, then a row of positions for each frame; lines end with CR LF.

The first row is the marker frame. There are no units and no rate: they are in the file beside it. Source: Kuper's
manual, "SAVE ASCII FILE", as Michael Karp has it on his pages of the system.
"""

from __future__ import annotations

import re

import numpy as np

from teleop.config.documents.document import DocumentError
from teleop.interchange.motion import Motion
from teleop.interchange.table import Hints, WriteOptions
from teleop.interchange.text import axis_named, bounded, columns_of, needed_rate, number, rows, values

HEADER = re.compile(r"\s*Axes\s*=\s*(.*?)\s*$", re.IGNORECASE)


def write(motion: Motion, options: WriteOptions) -> bytes:
    """The axes are in the order of `options`, with tabs between."""
    lines = [f"Axes = {', '.join(axis.value.capitalize() for axis in options.axes)}"]
    positions = np.array([motion.column(axis) for axis in options.axes]).T.tolist()
    lines += ["\t".join(map(number, row)) for row in positions]
    return "".join(f"{line}\r\n" for line in lines).encode()


def read(raw: bytes, name: str, hints: Hints) -> Motion:
    """By the names in the first line, or by the user's list."""
    text = bounded(raw, name)
    head, rest = re.split(r"\r\n|\r|\n", text, maxsplit=1)[0], ""
    rest = text[len(head) :]
    found = HEADER.match(head)
    if found is None:
        raise DocumentError([f"{name}:1: must begin with the line `Axes = Pan, Tilt`, as Kuper writes it"])
    names = [each.strip() for each in found[1].split(",")]
    table = rows(f"#{rest}", name)
    if len(names) != table.width:
        raise DocumentError([f"{name}:{table.rows[0].line}: has {table.width} values, and line 1 names {len(names)}"])
    columns = columns_of(hints, table, name, names)
    times = np.arange(len(table.rows)) / float(needed_rate(hints, name))
    positions = {axis: values(table, index, axis) for axis, index in columns.items()}
    unknown = [each for each in names if axis_named(each) is None] if hints.columns is None else []
    remarks = [f"axes that a head does not have: {', '.join(unknown)}"] if unknown else []
    return Motion("", times, positions, hints.rate, lines=[row.line for row in table.rows], remarks=remarks)


def is_kuper(raw: bytes) -> bool:
    """Whether a file is certainly one of these: its first line says so."""
    return HEADER.match(next(iter(raw[:200].decode("utf-8-sig", "replace").splitlines()), "")) is not None

"""CSV: a row for each frame, `frame,time,pan,tilt,roll,focus`; a take has a row for each reading, at its own `time`.

Names are in the first line, decimals have a point, lines end with a line feed. What is read may have commas, semicolons
or tabs between the cells, other columns, and comments. Source: RFC 4180.
"""

from __future__ import annotations

import io

import numpy as np

from teleop.config.documents.document import DocumentError
from teleop.interchange.motion import Motion
from teleop.interchange.table import Hints, WriteOptions
from teleop.interchange.text import bounded, columns_of, frame_times, needed_rate, number, rising, rows, values
from teleop.sequence.written_values import decimal

FRAME, TIME = "frame", "time"


def write(motion: Motion, options: WriteOptions) -> bytes:
    """The columns are the axes in the order of `options`; rows that are no frames have a time only."""
    text = io.StringIO()
    whole = motion.by_frame
    text.write(",".join([*([FRAME] if whole else []), TIME, *(axis.value for axis in options.axes)]) + "\n")
    columns = np.array([motion.times, *(motion.column(axis) for axis in options.axes)]).T.tolist()
    for frame, (time, *cells) in zip(motion.frames.tolist(), columns, strict=True):
        row = [f"{frame:.0f}"] if whole else []
        text.write(",".join([*row, decimal(time, 9), *map(number, cells)]) + "\n")
    return text.getvalue().encode()


def read(raw: bytes, name: str, hints: Hints) -> Motion:
    """By names; a column of times is followed, else frames with the rate that the user or the file beside gives."""
    table = rows(bounded(raw, name), name)
    names = [str(each).strip().lower() for each in hints.columns or table.names]
    columns = columns_of(hints, table, name, names)
    if hints.axes:
        columns = {axis: index for axis, index in columns.items() if axis in hints.axes}
        if not columns:
            raise DocumentError([f"{name}: has no column for {', '.join(hints.axes)}; it has {', '.join(names)}"])
    positions = {axis: values(table, index, axis) for axis, index in columns.items()}
    first = 1
    if TIME in names:
        times = rising(table, names.index(TIME), TIME)
        if abs(times[0]) > 1e9 or times[-1] - times[0] > 1e6:
            raise DocumentError([f"{name}:{table.rows[-1].line}: time must be in seconds, within 11 days"])
        times = times - times[0]
    elif FRAME in names:
        times, first = frame_times(table, names.index(FRAME), needed_rate(hints, name))
    else:
        times = np.arange(len(table.rows)) / float(needed_rate(hints, name))
    return Motion("", times, positions, hints.rate, first, lines=[row.line for row in table.rows])

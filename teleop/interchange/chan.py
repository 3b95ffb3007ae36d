"""Nuke's .chan: a row of blanks-separated numbers for each frame, `frame tx ty tz rx ry rz vfov`, angles in degrees.

The file has no rotation order, no rate and no names: they are in the file beside it. Blender's and Houdini's exports
have the same columns, `vfov` only for cameras. Sources: Foundry's user guide (import chan file) and reference of the
Camera node (rotation order ZXY unless it is changed); Blender's manual of its Nuke Animation add-on (the columns).
"""

from __future__ import annotations

import numpy as np

from teleop.config.documents.document import DocumentError
from teleop.core.axes import Axis
from teleop.interchange.motion import CAMERA, Motion
from teleop.interchange.rotation import HEAD, euler_matrices, head_angles
from teleop.interchange.table import Hints, WriteOptions
from teleop.interchange.text import bounded, frame_times, needed_rate, number, numbers, rows, values
from teleop.planner.polynomial import Array
from teleop.sequence.tables.table_file import CHAN, Table


def write(motion: Motion, options: WriteOptions) -> bytes:
    """A line for each frame; vfov is 0 where it is not known."""
    turns = np.array([motion.column(Axis.TILT), -motion.column(Axis.PAN), -motion.column(Axis.ROLL)]).T.tolist()
    vfov = f"{options.vfov or 0:g}"
    lines = []
    for frame, angles in zip(motion.frames.tolist(), turns, strict=True):
        lines.append(f"{frame:.0f} 0 0 0 {' '.join(map(number, angles))} {vfov}\n")
    return "".join(lines).encode()


def read(raw: bytes, name: str, hints: Hints) -> Motion:
    """The rotation order and the rate are the user's, or those of the file beside it."""
    table = rows(bounded(raw, name), name, chan=True)
    if table.width not in (7, 8):
        text = f"has {table.width} columns, not 7 or 8: {' '.join(CHAN)}"
        raise DocumentError([f"{name}:{table.rows[0].line}: {text}"])
    if hints.rotation_order is None:
        text = f"does not say its rotation order: give --rotation-order, as in --rotation-order {HEAD} (Nuke's own)"
        raise DocumentError([f"{name}: {text}"])
    times, first = frame_times(table, 0, needed_rate(hints, name))
    x, y, z = (values(table, index, Axis.TILT) for index in (4, 5, 6))
    pan, tilt, roll = -y, x, -z
    if hints.rotation_order != HEAD:
        pan, tilt, roll = head_angles(euler_matrices(x, y, z, hints.rotation_order), hints.start)
    remarks = list(_left_out(table))
    lines = [row.line for row in table.rows]
    positions = dict(zip(CAMERA, (pan + 0.0, tilt + 0.0, roll + 0.0), strict=True))
    return Motion("", times, positions, hints.rate, first, lines=lines, remarks=remarks)


def _left_out(table: Table) -> list[str]:
    found = []
    if any(_varies(numbers(table, index)) for index in (1, 2, 3)):
        found.append("positions (tx ty tz): the camera travels, and a head only turns")
    if table.width == 8 and bool(np.any(numbers(table, 7))):
        found.append("vfov: a sequence has no field of view")
    return found


def _varies(column: Array) -> bool:
    return bool(np.any(column != column[0]))

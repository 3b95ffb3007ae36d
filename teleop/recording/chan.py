"""The measured path of a pass for other programs: `.chan`, as Nuke, Maya and Houdini import it, and CSV.

A line of `.chan` is `frame tx ty tz rx ry rz vfov`, angles in degrees. A camera there looks along -z with y up, and
turns about z first, then x, then y (Nuke: ZXY): so a pan to the right is a negative ry, a tilt up a positive rx, and a
roll clockwise seen from behind a negative rz. Source: Nuke's reference of the Camera node and its import of chan files.
"""

from __future__ import annotations

import csv
import math
from collections.abc import Mapping
from typing import TextIO

import numpy as np

from teleop.core.axes import Axis
from teleop.recording.passes import Pass

ORDER = "ZXY"
TURNS: Mapping[Axis, float] = {Axis.TILT: 1.0, Axis.PAN: -1.0, Axis.ROLL: -1.0}  # rx, ry, rz, and their signs


def write_chan(each: Pass, fps: float, vfov: float, text: TextIO) -> None:
    """Frame 1 is the move's own zero; between two readings a frame lies on the line through them."""
    end = max((float(times[-1]) for times, _ in each.measured.values()), default=0.0)
    times = np.arange(math.floor(max(end, 0.0) * fps + 1e-9) + 1) / fps
    columns = [
        sign * np.interp(times, *each.measured[axis]) if axis in each.measured else np.zeros(len(times))
        for axis, sign in TURNS.items()
    ]
    for frame, turns in enumerate(np.array(columns).T.tolist(), 1):
        angles = " ".join(f"{turn + 0.0:.4f}" for turn in turns)
        text.write(f"{frame} 0 0 0 {angles} {vfov:g}\n")


def write_path(each: Pass, text: TextIO) -> None:
    """A row for each time (s of the move) at which an axis was measured, with where it was to be."""
    axes = [axis for axis in each.planned if axis in each.measured]
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(["time", *(f"{axis}_{what}" for axis in axes for what in ("measured", "planned"))])
    rows: dict[float, dict[Axis, float]] = {}
    for axis in axes:
        times, positions = each.measured[axis]
        for time, position in zip(times.tolist(), positions.tolist(), strict=True):
            rows.setdefault(round(time, 6), {})[axis] = position
    for time, found in sorted(rows.items()):
        cells: list[object] = [time]
        for axis in axes:
            planned = float(np.interp(time, *each.planned[axis]))
            cells += [round(found[axis], 4), round(planned, 6)] if axis in found else ["", ""]
        writer.writerow(cells)

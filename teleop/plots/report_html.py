"""A take as the preview's page: what was commanded with what was measured over it, the error, actions and the end.

Both are drawn over one set of times, the ticks and the readings together; what was measured lies on straight lines
between two readings and is nowhere drawn before the first or after the last.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from teleop.core.axes import Axis
from teleop.planner.polynomial import Array
from teleop.plots.downsample import MOST, outline
from teleop.plots.numbers import finite, short
from teleop.plots.page import assembled
from teleop.plots.style import COLORS, PER, UNIT_SIGNS
from teleop.recording.reader import Take
from teleop.recording.report import AxisReport

QUANTITIES = ("position", "error", "velocity", "acceleration")
ROWS = (*QUANTITIES, "measured")
MOST_MARKS = 200  # actions: more would be a wall of lines
NEAR = 0.03  # of the run: what was done that near to its end is named with it
LONGEST = 70  # letters of why it stopped, at its line


def page(take: Take, found: Mapping[Axis, AxisReport]) -> str:
    """The HTML text of a page about a run and its report."""
    about = take.about
    data = {
        "title": about.title,
        "rig": about.rig,
        "facts": f"{take.duration:.2f} s on {about.rig}; ended: {take.ended}",
        "duration": take.duration,
        "cues": [{"at": time, "name": name} for time, name in marks(take)],
        "quantities": [{"name": name, "per": PER[name]} for name in QUANTITIES],
        "axes": [_axis(take, axis, of_axis) for axis, of_axis in found.items()],
        "warnings": [line for line in (take.remark,) if line],
    }
    return assembled(about.title, data)


def marks(take: Take) -> Sequence[tuple[float, str]]:
    """(s, text) of each action, turns of a dial left out, and at last of how the run ended."""
    actions = [(time, action) for time, action in take.actions if action["action"] != "dialled"]
    done = [(time, action.get("words") or action["action"]) for time, action in actions]
    shown = done[:MOST_MARKS]
    ended = f"ended: {take.ended}" if len(take.ended) <= LONGEST else f"ended: {take.ended[:LONGEST]}..."
    near = [name for time, name in shown if time > (1 - NEAR) * take.duration]
    return [*shown[: len(shown) - len(near)], (take.duration, "; ".join([*near[-1:], ended]))]


def curves(take: Take, axis: Axis) -> tuple[Array, Array]:
    """Times (m,) in s and the ROWS (5, m) of an axis; NaN where nothing is known. m is at most MOST."""
    read_at, read = take.measured.get(axis, np.empty((2, 0)))
    during = (read_at >= take.times[0]) & (read_at <= take.times[-1])
    times = np.union1d(take.times, read_at[during])
    position, velocity, acceleration = (np.interp(times, take.times, row) for row in take.motion[axis])
    measured = np.full_like(times, math.nan)
    if during.any():
        measured = np.interp(times, read_at, read, left=math.nan, right=math.nan)
    rows = np.array([position, position - measured, velocity, acceleration, measured])
    if len(times) > MOST:
        kept = outline(np.nan_to_num(rows))
        times, rows = times[kept], rows[:, kept]
    return times, rows


def _axis(take: Take, axis: Axis, found: AxisReport) -> Mapping[str, Any]:
    limits, position = take.about.limits[axis], take.motion[axis][0]
    times, rows = curves(take, axis)
    reach = {name: [-getattr(limits, name), getattr(limits, name)] for name in ("velocity", "acceleration")}
    used = {name: [short(getattr(found, name) * getattr(limits, name))] for name in ("velocity", "acceleration")}
    return {
        "name": axis.value.replace("_", " "),
        "color": COLORS[axis],
        "unit": UNIT_SIGNS[axis.unit],
        "limits": {"position": [finite(limits.minimum), finite(limits.maximum)], "error": [], **reach},
        "peaks": {
            "position": [short(float(position.min())), short(float(position.max()))],
            "error": [short(found.peak)] if found.readings else [],
            **used,
        },
        "keys": [],
        "times": [round(time, 6) for time in times.tolist()],
        "samples": {
            name: [None if math.isnan(value) else short(value) for value in row]
            for name, row in zip(ROWS, rows.tolist(), strict=True)
        },
    }

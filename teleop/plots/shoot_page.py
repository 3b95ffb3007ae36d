"""A timelapse for the preview's page: by output frames, with the shoot's own clock and its intervals.

What the clip shows is where the axes are at each frame and how far they go from one to the next; when each is shot
follows from the interval, which has a curve of its own.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from teleop.config.frame_rates import shown_rate
from teleop.config.profile import Profile
from teleop.core.axes import Axis
from teleop.planner.keyframes.keys import Key
from teleop.planner.polynomial import Array
from teleop.plots.downsample import MOST, outline
from teleop.plots.numbers import finite, short
from teleop.plots.style import COLORS, UNIT_SIGNS, mark

if TYPE_CHECKING:
    from teleop.timelapse.compile import Timelapse

OF_AXES = ("position", "step")
INTERVAL_COLOR = "#e9ecef"


def shoot_data(timelapse: Timelapse, profile: Profile) -> dict[str, Any]:
    """What the page draws: its times are output frames."""
    slots, last = timelapse.slots, timelapse.frames - 1
    axes = [_axis(axis, timelapse, profile) for axis in timelapse.keys]
    return {
        "title": timelapse.title,
        "rig": profile.name,
        "facts": f"{timelapse.frames} frames on {profile.name}: {', '.join(_facts(timelapse))}",
        "duration": last,
        "shoot": {"first": slots.first, "change": slots.change},
        "cues": [],
        "quantities": [
            {"name": "position", "per": ""},
            {"name": "step", "per": " from frame to frame"},
            {"name": "interval", "per": ""},
        ],
        "axes": [*axes, _interval(timelapse)],
        "warnings": list(timelapse.warnings),
    }


def _facts(timelapse: Timelapse) -> Iterator[str]:
    seconds = round(timelapse.slots.at(timelapse.frames - 1))
    yield f"{seconds // 3600}:{seconds // 60 % 60:02}:{seconds % 60:02} of shooting"
    if timelapse.clip and timelapse.fps:
        yield f"{timelapse.clip:.2f} s of clip at {shown_rate(timelapse.fps)} fps"
    yield "in motion while it exposes" if timelapse.continuous else "at rest while it exposes"


def _axis(axis: Axis, timelapse: Timelapse, profile: Profile) -> dict[str, Any]:
    limits, lead = profile.limits[axis], timelapse.path.lead
    positions = timelapse.path.positions(timelapse.frames)[axis]
    steps = np.diff(positions, append=positions[-1:])
    rows, kept = _kept(np.array([positions, steps]))
    peak = float(np.abs(steps).max(initial=0.0))
    return {
        "name": axis.value.replace("_", " "),
        "color": COLORS[axis],
        "unit": UNIT_SIGNS[axis.unit],
        "limits": {"position": [finite(limits.minimum), finite(limits.maximum)], "step": []},
        "peaks": {"position": [short(float(positions.min())), short(float(positions.max()))], "step": [short(peak)]},
        "keys": [_key(key, lead) for key in timelapse.keys[axis]],
        "times": kept.tolist(),
        "samples": {name: [short(value) for value in row] for name, row in zip(OF_AXES, rows.tolist(), strict=True)},
    }


def _key(key: Key, lead: int) -> dict[str, Any]:
    place = {"at": key.at + lead, "hold": key.hold, "position": key.position}
    return {**place, "name": key.where, "mark": mark(key.where)}


def _interval(timelapse: Timelapse) -> dict[str, Any]:
    """The interval after each frame, as an axis that has nothing else."""
    slots = timelapse.slots
    intervals = np.array([slots.interval(frame) for frame in range(timelapse.frames)])
    rows, kept = _kept(intervals[None])
    return {
        "name": "interval",
        "color": INTERVAL_COLOR,
        "unit": "s",
        "limits": {"interval": []},
        "peaks": {"interval": [short(float(intervals.min())), short(float(intervals.max()))]},
        "keys": [],
        "times": kept.tolist(),
        "samples": {"interval": [short(value) for value in rows[0].tolist()]},
    }


def _kept(rows: Array) -> tuple[Array, NDArray[np.intp]]:
    """The rows (k, n) at few enough frames to draw, and which frames those are."""
    count = rows.shape[1]
    kept = np.arange(count) if count <= MOST else outline(rows)
    return rows[:, kept], kept

"""The colors and words that page and drawing share, so that pan is the same blue in both."""

from __future__ import annotations

import re
from collections.abc import Mapping

from teleop.core.axes import Axis

COLORS: Mapping[Axis, str] = {
    Axis.PAN: "#4cc9f0",
    Axis.TILT: "#ffa23e",
    Axis.ROLL: "#94d82d",
    Axis.FOCUS: "#c77dff",
    Axis.STICK_ROLL: "#ff7eb6",
    Axis.STICK_PITCH: "#ffd43b",
    Axis.STICK_THROTTLE: "#38d9a9",
    Axis.STICK_YAW: "#ff8787",
}

UNIT_SIGNS: Mapping[str, str] = {"deg": "°", "": ""}
"""By `Axis.unit`. Axes of one unit share a scale: focus and the sticks would be flat lines among degrees."""

PER: Mapping[str, str] = {"position": "", "error": "", "velocity": "/s", "acceleration": "/s²", "jerk": "/s³"}


def mark(where: str) -> str:
    """A key's name beside its diamond: 3 for key 3, 1.2 for key 2 of include 1, 57 for frame 57 of a table."""
    return re.sub(r"(include|key|shot|frame) ", "", where).replace(", ", ".")

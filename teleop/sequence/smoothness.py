"""Tension and overshoot as people write them in a sequence: rules over the plain data, with errors in plain words."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import Any

from teleop.config.documents.document import Wrong, mapping, number
from teleop.config.documents.messages import ALIASES, nearest, shown
from teleop.core.axes import Axis
from teleop.planner.keyframes.tension import EVEN

AXES = tuple(axis.value for axis in Axis)


def smoothness_rules(data: Any) -> Iterator[Wrong]:
    """A tension is a share or `even`, an overshoot a distance, or one for each of some axes."""
    tension = mapping(data).get("tension", EVEN)
    share = number(tension)
    if tension != EVEN and (share is None or not 0 <= share <= 1):
        yield ("tension",), f"must be 0 to 1, or {EVEN}, not {shown(tension)}"
    if "overshoot" not in mapping(data):
        return
    overshoot = mapping(data)["overshoot"]
    if not isinstance(overshoot, Mapping):
        if not _is_distance(overshoot):
            yield ("overshoot",), f"must be a distance such as 2, or {{pan: 2}}, not {shown(overshoot)}"
        return
    for axis, distance in overshoot.items():
        if axis not in AXES:
            near = f"; did you mean {ALIASES[axis]}?" if axis in ALIASES else nearest(str(axis), AXES)
            yield ("overshoot", axis), f": unknown axis{near}"
        elif not _is_distance(distance):
            yield ("overshoot", axis), f"must be a distance such as 2, not {shown(distance)}"


def _is_distance(value: Any) -> bool:
    distance = number(value)
    return distance is not None and math.isfinite(distance) and distance >= 0

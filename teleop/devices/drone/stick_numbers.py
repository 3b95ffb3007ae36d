"""Four sticks as the four numbers of a movement command: one place for every sign and unit.

A number is the stick times what the profile's `full` gives, except where the table says "from here": these count from
the heading and the height that the drone had when it was taken.

| number | control | of which stick | unit and sign |
|---|---|---|---|
| x | TILT | roll | deg, right |
| x | VELOCITY, POSITION | pitch | m/s or m, forward or north |
| y | TILT | pitch, negated | deg, nose up: a stick pushed forward is nose down |
| y | VELOCITY, POSITION | roll | m/s or m, right or east |
| z | VELOCITY | throttle | m/s, up |
| z | POSITION | throttle | m above the take-off place, from here |
| yaw | RATE | yaw | deg/s, clockwise seen from above |
| yaw | ANGLE | yaw | deg from north, clockwise, from here |

Source: OPENProtocol.md 3.1.9, 01 03, offsets 1 ("Roll or X-axis") and 5 ("Pitch or Y-axis"); Appendix.md for the
units. Thrust (modes 13 and 14) has no stick: which thrust hovers depends on the drone, so there is no neutral.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import NamedTuple

from teleop.core.axes import STICKS, Axis
from teleop.dji.drone.movement import Combination, Horizontal, Vertical, Yaw


class Numbers(NamedTuple):
    """x, y, z and yaw of a movement command."""

    x: float
    y: float
    z: float
    yaw: float


def numbers(
    combination: Combination, full: Mapping[str, float], sticks: Mapping[Axis, float], heading: float, height: float
) -> Numbers:
    """The numbers of `sticks` (-1..1), counted from `heading` (deg) and `height` (m) where the mode is a place.

    Raises ValueError for thrust.
    """
    if combination.vertical == Vertical.THRUST:
        raise ValueError("thrust has no neutral, so sticks cannot fly it")
    roll, pitch, throttle, yaw = (sticks[axis] for axis in STICKS)
    across = full["horizontal"]
    tilts = combination.horizontal == Horizontal.TILT
    x, y = (roll * across, -pitch * across) if tilts else (pitch * across, roll * across)
    rise, turn = throttle * full["vertical"], yaw * full["yaw"]
    if combination.vertical == Vertical.POSITION:
        rise = max(0.0, height + rise)
    if combination.yaw == Yaw.ANGLE:
        turn = math.remainder(heading + turn, 360.0)
    return Numbers(x + 0.0, y + 0.0, rise, turn)  # + 0.0: a centered stick is 0, never -0

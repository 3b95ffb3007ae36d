"""To a place and rest, gently: back-to-one, the way to the first key, a preset in rehearsal.

One rest-to-rest minimum-jerk quintic for all axes, so that they set off and arrive together and nothing can overshoot.
Its peaks over distance d and time T are 15/8 d/T, 10/sqrt(3) d/T2 and 60 d/T3, so the shortest T is a formula.
"""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np

from teleop.core.axes import Axis, Limits, Motion
from teleop.planner.polynomial import Array
from teleop.planner.trajectory import Move, Track

PEAK_VELOCITY = 15 / 8
PEAK_ACCELERATION = 10 / math.sqrt(3)
PEAK_JERK = 60.0
NEGLIGIBLE = 1e-12  # units: already there, and too near to divide by the time it takes


def rest_to_rest(
    start: Motion, target: Mapping[Axis, float], limits: Mapping[Axis, Limits], share: float = 0.5, least: float = 0.0
) -> Move:
    """From rest at `start` to rest at `target`, within `share` of each axis' V, A and J; 0 s long when already there.

    The axes of the move are those of `target`; each needs a start and limits. A move takes `least` s or longer.
    """
    distances = {axis: position - start[axis].position for axis, position in target.items()}
    duration = max(
        (float(shortest(np.abs(distance), limits[axis].scaled(share))) for axis, distance in distances.items()),
        default=0.0,
    )
    if duration:
        duration = max(duration, least)
    return Move({axis: _quintic(start[axis].position, target[axis], duration) for axis in target})


def shortest(distance: Array, limits: Limits) -> Array:
    """Seconds from rest to rest over distances (>= 0, units), whatever their shape."""
    times = np.maximum(
        np.maximum(
            PEAK_VELOCITY * distance / limits.velocity, np.sqrt(PEAK_ACCELERATION * distance / limits.acceleration)
        ),
        np.cbrt(PEAK_JERK * distance / limits.jerk),
    )
    return np.where(distance > NEGLIGIBLE, times, 0.0)


def _quintic(start: float, end: float, duration: float) -> Track:
    if abs(end - start) <= NEGLIGIBLE:
        return Track(np.array([duration]), np.empty((0, 6)), end)
    distance = end - start
    row = [start, 0.0, 0.0, 10 * distance / duration**3, -15 * distance / duration**4, 6 * distance / duration**5]
    return Track(np.array([0.0, duration]), np.array([row]), end)

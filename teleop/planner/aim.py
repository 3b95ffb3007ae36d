"""Where a camera has to look to see a point, and where a point is that was looked at.

Positions are in meters: x right, y forward, z up, from where the tripod stands when its pan is 0. Pan and tilt are in
degrees, + right and + up, tilt after pan, so roll (around the lens) changes neither.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

NEAREST = 0.01  # m: a point that is nearer to the camera has no direction
LEAST_PARALLAX = 5.0  # deg between two sights: below it the distance is a guess


class Point(NamedTuple):
    """Meters."""

    x: float
    y: float
    z: float


class Sight(NamedTuple):
    """A look at a point: where the camera was, and its pan and tilt in deg."""

    camera: Point
    pan: float
    tilt: float


class AimError(Exception):
    """A point that cannot be aimed at, or was not found; one line."""


def look_at(target: Point, camera: Point) -> tuple[float, float]:
    """Pan in -180..180 and tilt in -90..90, in deg. Raises AimError for a target at the camera."""
    right, forward, up = (to - start for to, start in zip(target, camera, strict=True))
    if math.hypot(right, forward, up) < NEAREST:
        raise AimError("the target is where the camera is")
    return math.degrees(math.atan2(right, forward)), math.degrees(math.atan2(up, math.hypot(right, forward)))


def nearest_turn(pan: float, near: float) -> float:
    """The same direction, within half a turn of `near`; all in deg."""
    return near + math.remainder(pan - near, 360.0)


def at_distance(sight: Sight, distance: float) -> Point:
    """The point that is looked at, `distance` m from the camera. Raises AimError for a distance of next to nothing."""
    if not distance >= NEAREST:
        raise AimError(f"the distance must be at least {NEAREST:g} m")
    point = np.array(sight.camera) + distance * _direction(sight)
    return Point(*point.tolist())


def intersection(sights: Sequence[Sight]) -> tuple[Point, float]:
    """The point that two sights meet at, and by how many m they miss each other there.

    Raises AimError where they are too much alike, or meet behind a camera.
    """
    first, second = (_direction(sight) for sight in sights)
    parallax = math.degrees(math.atan2(float(np.linalg.norm(np.cross(first, second))), float(first @ second)))
    parallax = min(parallax, 180 - parallax)
    if parallax < LEAST_PARALLAX:
        raise AimError(
            f"the two sights differ by {parallax:.1f} deg, and {LEAST_PARALLAX:g} are needed: look from further apart"
        )
    start, other = (np.array(sight.camera) for sight in sights)
    ways = np.linalg.lstsq(np.stack([first, -second], axis=1), other - start, rcond=None)[0]
    if ways.min() < NEAREST:
        raise AimError("the two sights meet behind the camera: check the two places")
    near, far = start + ways[0] * first, other + ways[1] * second
    return Point(*((near + far) / 2).tolist()), float(np.linalg.norm(near - far))


def _direction(sight: Sight) -> NDArray[np.float64]:
    pan, tilt = math.radians(sight.pan), math.radians(sight.tilt)
    return np.array([math.sin(pan) * math.cos(tilt), math.cos(pan) * math.cos(tilt), math.sin(tilt)])

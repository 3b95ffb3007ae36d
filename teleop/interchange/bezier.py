"""Curves of animation programs: cubic Bezier from point to point, of which the position at a frame is asked.

Points and handles are (frame, position). The frame of a cubic is a cubic too, so the place on the curve is found by
halving; handles are shortened so that frames only go on, as Blender does it. Source: Blender's manual, "F-Curves".
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from teleop.planner.polynomial import Array

HALVINGS = 60

Point = tuple[float, float]  # frame, position


def curve(given: Sequence[Point], given_handles: Sequence[Point], frames: Array) -> Array:
    """The position at each frame, at rest before the first point and after the last one; no handles: straight ways."""
    points = np.array(given)
    if len(points) == 1:
        return np.full(len(frames), points[0, 1])
    handles = np.array(given_handles or _straight(given)).reshape(-1, 2, 2)
    place = np.clip(np.searchsorted(points[:, 0], frames, side="right") - 1, 0, len(points) - 2)
    first, last = points[place], points[place + 1]
    one, two = _shortened(first, handles[place, 0], handles[place, 1], last)
    at = np.clip(frames, points[0, 0], points[-1, 0])
    low, high = np.zeros(len(frames)), np.ones(len(frames))
    for _ in range(HALVINGS):
        middle = (low + high) / 2
        before = _bezier(middle, first[:, 0], one[:, 0], two[:, 0], last[:, 0]) <= at
        low, high = np.where(before, middle, low), np.where(before, high, middle)
    found = _bezier(low, first[:, 1], one[:, 1], two[:, 1], last[:, 1])
    found = np.where(at == first[:, 0], first[:, 1], found)
    return np.where(at >= last[:, 0], last[:, 1], found)


def _straight(points: Sequence[Point]) -> list[Point]:
    return [
        (x + (after[0] - before[0]) * share, y + (after[1] - before[1]) * share)
        for before, after in pairwise(points)
        for (x, y), share in ((before, 1 / 3), (after, -1 / 3))
    ]


def _shortened(first: Array, one: Array, two: Array, last: Array) -> tuple[Array, Array]:
    """Handles so short that no frame comes twice, as Blender does it: both by the same factor."""
    width = last[:, 0] - first[:, 0]
    reach = np.abs(one[:, 0] - first[:, 0]) + np.abs(last[:, 0] - two[:, 0])
    factor = np.where(reach > width, width / np.maximum(reach, 1e-300), 1.0)[:, None]
    ahead = np.where((one[:, :1] < first[:, :1]), 0.0, factor)
    back = np.where((two[:, :1] > last[:, :1]), 0.0, factor)
    return first + (one - first) * ahead, last + (two - last) * back


def _bezier(t: Array, a: Array, b: Array, c: Array, d: Array) -> Array:
    s = 1 - t
    return s * s * s * a + 3 * s * s * t * b + 3 * s * t * t * c + t * t * t * d

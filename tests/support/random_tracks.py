"""Tracks from random numbers, without the planner: smooth pieces of any widths, rests among them."""

from __future__ import annotations

import numpy as np

from teleop.planner.polynomial import HERMITE
from teleop.planner.trajectory import Track


def random_track(pieces: int, seed: int, start: float = 0.0) -> Track:
    """C2 over `pieces` quintics from `start` s, each 0.01 to 100 s long; about a third of them stand still."""
    random = np.random.default_rng(seed)
    widths = 10 ** random.uniform(-2, 2, pieces)
    breaks = start + np.concatenate([[0.0], np.cumsum(widths)])
    knots = random.normal(size=(pieces + 1, 3)) * (20, 5, 5)
    if pieces == 0:
        return Track.constant(start, float(knots[0, 0]))
    for i in np.flatnonzero(random.random(pieces) < 1 / 3):
        knots[i, 1:] = 0
        knots[i + 1] = knots[i]
    scale = widths[:, None] ** np.arange(3)
    ends = np.hstack([knots[:-1] * scale, knots[1:] * scale])
    coefficients = ends @ HERMITE.T / widths[:, None] ** np.arange(6)
    still = (knots[:-1] == knots[1:]).all(axis=1) & (knots[:-1, 1:] == 0).all(axis=1)
    coefficients[still, 1:] = 0
    return Track(breaks, coefficients, float(knots[-1, 0]))

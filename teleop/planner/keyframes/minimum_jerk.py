"""The curve of least jerk through keys, from rest to rest, without limits: a quintic spline, in a millisecond.

Where a plan touches no limit it is this curve, so a search for keys tries many of them here and plans once.
"""

from __future__ import annotations

import numpy as np

from teleop.planner.polynomial import GRAM_JERK, Array
from teleop.planner.trajectory import Track

BANDS = 4  # of the symmetric system: velocity and acceleration of a key meet those of the next


def minimum_jerk(times: Array, positions: Array) -> Track:
    """The curve through `positions` (n,) at `times` (n,), rising, in s."""
    widths = np.diff(times)
    scale = np.stack([np.ones_like(widths), widths, widths**2] * 2, axis=1)
    weights = GRAM_JERK[None] * scale[:, :, None] * scale[:, None, :] / widths[:, None, None] ** 5
    states = np.zeros((3, len(times)))
    states[0] = positions
    if len(times) > 2:
        states[1:, 1:-1] = _free(weights, positions).T
    return Track.through(times, states)


def _free(weights: Array, positions: Array) -> Array:
    """Velocity and acceleration (n - 2, 2) at the inner keys, of the pieces' `weights` (n - 1, 6, 6)."""
    from scipy.linalg import solveh_banded  # where keys are sought: loading it takes as long as checking a file

    inner = len(positions) - 2
    own = weights[:-1, 4:, 4:] + weights[1:, 1:3, 1:3]
    beside = weights[1:-1, 1:3, 4:]
    pull = np.einsum("ij,ijk->ik", np.stack([positions[:-2], positions[1:-1]], 1), weights[:-1][:, [0, 3], 4:])
    pull += np.einsum("ij,ijk->ik", np.stack([positions[1:-1], positions[2:]], 1), weights[1:][:, [0, 3], 1:3])
    bands = np.zeros((BANDS, 2 * inner))  # below the diagonal
    bands[0, 0::2], bands[0, 1::2], bands[1, 0::2] = own[:, 0, 0], own[:, 1, 1], own[:, 1, 0]
    bands[2, 0:-2:2], bands[3, 0:-2:2] = beside[:, 0, 0], beside[:, 0, 1]
    bands[1, 1:-2:2], bands[2, 1:-2:2] = beside[:, 1, 0], beside[:, 1, 1]
    return solveh_banded(bands, -pull.ravel(), lower=True).reshape(-1, 2)

"""The smoothest positions within a band, one for each frame: a table without its noise, and within the limits.

Finite differences stand for the derivatives. The mean of a derivative over a frame is never more than its greatest
value, so a band without such positions has no legal move in it either.
"""

from __future__ import annotations

import numpy as np
from scipy import sparse

from teleop.core.axes import Limits
from teleop.planner.keyframes.program import HEADROOM
from teleop.planner.keyframes.qp_solver import Sparse, minimize
from teleop.planner.polynomial import Array

RESTING = 2  # samples before the first and after the last one, of an axis that rests there
UNBOUND = 1e6  # a limit so many times beyond the whole range is left out


def smoothest(low: Array, high: Array, step: float, limits: Limits | None, rests: tuple[bool, bool]) -> Array | None:
    """Positions (n,) every `step` seconds between `low` and `high` (n,), infinite where they are free.

    `rests` is whether the axis rests at its start and at its end; without `limits` there are none. None where the
    limits leave no way.
    """
    finite = np.concatenate([low[np.isfinite(low)], high[np.isfinite(high)]])
    origin, scale = float(finite.mean()), max(float(np.ptp(finite)), 1e-9)
    orders = [_difference(len(low), order, rests) for order in (1, 2, 3)]
    rows, bounds = [], []
    if limits is not None:
        for order, matrix in enumerate(orders, 1):
            limit = (limits.velocity, limits.acceleration, limits.jerk)[order - 1]
            bound = HEADROOM * limit * step**order / scale
            if bound < UNBOUND:
                rows += [matrix, -matrix]
                bounds += [np.full(matrix.shape[0], bound)] * 2
    for sign, edge in ((1.0, high), (-1.0, low)):
        known = np.isfinite(edge)
        rows.append(sign * sparse.csr_matrix(sparse.identity(len(low)))[known])
        bounds.append(sign * (edge[known] - origin) / scale)
    cost = sparse.triu(orders[2].T @ orders[2], format="csc")
    found = minimize(cost, np.zeros(len(low)), sparse.vstack(rows, format="csc"), np.concatenate(bounds))
    return None if found is None else np.clip(found * scale + origin, low, high)


def _difference(count: int, order: int, rests: tuple[bool, bool]) -> Sparse:
    """The `order`-th differences of `count` samples, with those of a rest before and after."""
    before, after = (RESTING * rest for rest in rests)
    index = np.clip(np.arange(-before, count + after), 0, count - 1)
    repeated = sparse.csr_matrix((np.ones(len(index)), (np.arange(len(index)), index)), shape=(len(index), count))
    for _ in range(order):
        repeated = repeated[1:] - repeated[:-1]
    return repeated

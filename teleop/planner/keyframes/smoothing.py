"""The smoothest positions within a band, one for each frame: a table without its noise, and within the limits.

Finite differences stand for the derivatives. The mean of a derivative over a frame is never more than its greatest
value, so a band without such positions has no legal move in it either.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from teleop.core.axes import Limits
from teleop.planner.keyframes.mesh import Indices
from teleop.planner.keyframes.program import HEADROOM
from teleop.planner.keyframes.qp_solver import minimize
from teleop.planner.keyframes.sparse import Columns, Entries, below_each_other
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
    differences = [_Differences.of(len(low), order, rests) for order in (1, 2, 3)]
    rows, bounds = [], []
    if limits is not None:
        for order, difference in enumerate(differences, 1):
            limit = (limits.velocity, limits.acceleration, limits.jerk)[order - 1]
            bound = HEADROOM * limit * step**order / scale
            if bound < UNBOUND:
                rows += [difference.entries().times(sign) for sign in (1.0, -1.0)]
                bounds += [np.full(len(difference.samples), bound)] * 2
    for sign, edge in ((1.0, high), (-1.0, low)):
        known = np.flatnonzero(np.isfinite(edge))
        rows.append(Entries(np.arange(len(known)), known, np.full(len(known), sign), (len(known), len(low))))
        bounds.append(sign * (edge[known] - origin) / scale)
    cost, matrix = differences[2].squares(), below_each_other(rows)
    found = minimize(cost, np.zeros(len(low)), matrix, np.concatenate(bounds))
    return None if found is None else np.clip(found * scale + origin, low, high)


class _Differences(NamedTuple):
    """Differences of one order: the `samples` (k, order + 1) of `width` that each is made of, and their `weights`."""

    samples: Indices
    weights: Array
    width: int

    @staticmethod
    def of(count: int, order: int, rests: tuple[bool, bool]) -> _Differences:
        """The `order`-th differences of `count` samples, with those of a rest before and after."""
        before, after = (RESTING * rest for rest in rests)
        repeated = np.clip(np.arange(-before, count + after), 0, count - 1)
        weights = np.diff(np.eye(2 * order + 1)[order], n=order)  # of a single 1, from its last to its first
        first = np.arange(max(len(repeated) - order, 0))
        return _Differences(repeated[first[:, None] + np.arange(order + 1)], weights, count)

    def entries(self) -> Entries:
        """As rows, one for each."""
        row = np.repeat(np.arange(len(self.samples)), len(self.weights))
        value = np.tile(self.weights, len(self.samples))
        return Entries(row, self.samples.ravel(), value, (len(self.samples), self.width))

    def squares(self) -> Columns:
        """The sum of their squares, as the upper triangle of a quadratic form."""
        shape = (*self.samples.shape, len(self.weights))
        row = np.broadcast_to(self.samples[:, :, None], shape)
        column = np.broadcast_to(self.samples[:, None, :], shape)
        value = np.broadcast_to(np.outer(self.weights, self.weights), shape)
        upper = row <= column
        return Entries(row[upper], column[upper], value[upper], (self.width, self.width)).by_column()

"""The correction that by the model of an axis leaves the least error, within the limits of the axis.

The error is filtered with no shift in time: a correction costs what its third derivative is, so that only what is
slower than about 3 Hz of an error is worked against; faster it is noise. Least squares with bounds is what makes it
legal: nothing is cut off afterwards.
"""

from __future__ import annotations

import math

import numpy as np
import scipy.sparse as sparse
from scipy.sparse.linalg import spsolve

from teleop.learning.basis import Basis, Sparse, diagonals
from teleop.learning.response_model import STEP
from teleop.learning.room import Room
from teleop.planner.keyframes.qp_solver import minimize
from teleop.planner.keyframes.sparse import Columns
from teleop.planner.polynomial import Array

CUTOFF = 3.0  # Hz
KEPT = 1e-9  # units: a bound that is passed by no more is kept


class Improver:
    """For one axis of one move, by errors at `times` (n,), which are STEP apart: planned less measured."""

    def __init__(self, basis: Basis, room: Room, times: Array) -> None:
        self._basis, self._room = basis, room
        self._values = basis.values(np.clip(times, basis.knots[0], basis.knots[-1]))
        third = basis.derivative(3)
        widths = _widths(basis)
        self._roughness = third.T @ sparse.diags(widths / STEP) @ third / (2 * math.pi * CUTOFF) ** 6

    def better(self, present: Array, error: Array, taps: Array, counts: Array) -> tuple[Array, float]:
        """The coefficients after `present`, which left `error`, and the RMS that they should leave.

        `counts` (n,) is 1 for an error that counts and 0 for one that does not.
        """
        count = len(error)
        answer = diagonals(
            [np.full(count - k, tap) for k, tap in enumerate(taps) if k < count],
            [-k for k in range(min(len(taps), count))],
            shape=(count, count),
            format="csc",
        )
        effect = sparse.diags(counts) @ (answer @ self._values)[:, self._basis.free]
        rough = self._roughness[self._basis.free][:, self._basis.free]
        cost = (effect.T @ effect + rough).tocsc()
        aim = effect.T @ (counts * error + effect @ present[self._basis.free])
        found = np.zeros(self._basis.count)
        found[self._basis.free] = np.asarray(spsolve(cost, aim))
        if not self._is_legal(found):
            found = self._bounded(cost, aim)
        left = counts * error - effect @ (found - present)[self._basis.free]
        return found, float(np.sqrt(np.sum(left**2) / np.sum(counts)))

    def _is_legal(self, coefficients: Array) -> bool:
        for order, (low, high) in enumerate(self._room.bounds):
            values = self._basis.derivative(order) @ coefficients
            if (values > high + KEPT).any() or (values < low - KEPT).any():
                return False
        return True

    def _bounded(self, cost: Sparse, aim: Array) -> Array:
        """No correction where the solver finds none."""
        rows, bound = [], []
        for order, (low, high) in enumerate(self._room.bounds):
            matrix = self._basis.derivative(order)[:, self._basis.free]
            for sign, limit in ((1.0, high), (-1.0, -low)):
                finite = np.isfinite(limit)
                unit = max(float(np.abs(limit[finite]).max(initial=0.0)), 1.0)
                rows.append(sign / unit * matrix[finite])
                bound.append(limit[finite] / unit)
        upper, matrix = sparse.triu(cost), sparse.vstack(rows)
        answer = minimize(_columns(upper), -aim, _columns(matrix), np.concatenate(bound))
        found = np.zeros(self._basis.count)
        if answer is not None:
            found[self._basis.free] = answer
        return found


def _columns(matrix: Sparse) -> Columns:
    by_column = matrix.tocsc()
    by_column.sum_duplicates()
    numbers = by_column.data, by_column.indices, by_column.indptr
    data, indices, starts = (each.tolist() for each in numbers)
    return Columns(data, indices, starts, by_column.shape)


def _widths(basis: Basis) -> Array:
    """How long (s) each coefficient of the third derivative counts."""
    first, last = basis.supports(3)
    return (basis.knots[last] - basis.knots[first]) / 3

"""The functions that a correction is made of: quintic B-splines, at rest and 0 at both ends and at every wait.

A spline never leaves the hull of its coefficients, and its derivatives are splines of the differences of these. So a
few linear rows bound a correction, and what it does to velocity, acceleration and jerk, at every time, not at samples.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from itertools import pairwise
from typing import Any

import numpy as np
import scipy.sparse as sparse
from numpy.typing import NDArray
from scipy.interpolate import BSpline

from teleop.planner.polynomial import Array
from teleop.planner.trajectory import Track

DEGREE = 5
SPACING = 0.08  # s between knots: twice as fine as 3 Hz needs
ORDERS = 4  # position, velocity, acceleration, jerk
_ENDS = 3  # coefficients that are 0 at either end: no offset, at rest
Numbers = NDArray[np.intp]
Sparse = Any  # scipy.sparse: its own type stubs do not say what an operation returns
diagonals: Any = sparse.diags


class Basis:
    """Splines over the spans between `edges` (s, rising); `knots` are all their knots once."""

    def __init__(self, edges: Sequence[float]) -> None:
        spans = list(pairwise(edges))
        inner = [np.linspace(low, high, max(1, round((high - low) / SPACING)) + 1) for low, high in spans]
        self.knots: Array = np.concatenate([inner[0], *(each[1:] for each in inner[1:])])
        self._vectors = [np.concatenate([[each[0]] * DEGREE, each, [each[-1]] * DEGREE]) for each in inner]
        self._counts = [len(vector) - DEGREE - 1 for vector in self._vectors]

    @property
    def count(self) -> int:
        return sum(self._counts)

    @cached_property
    def free(self) -> Numbers:
        """The numbers of the coefficients that are not held at 0."""
        kept, first = [], 0
        for count in self._counts:
            kept.append(np.arange(first + _ENDS, first + max(count - _ENDS, _ENDS)))
            first += count
        return np.concatenate(kept)

    def values(self, times: Array) -> Sparse:
        """The matrix (m, count) that takes coefficients to the offset at `times` (m,)."""
        blocks, done = [], np.zeros(len(times), dtype=bool)
        for vector in self._vectors:
            here = (times >= vector[0]) & (times <= vector[-1]) & ~done
            done |= here
            rows: Sparse = BSpline.design_matrix(times[here], vector, DEGREE).tocoo()
            index = np.flatnonzero(here)[rows.row]
            blocks.append(sparse.coo_matrix((rows.data, (index, rows.col)), (len(times), rows.shape[1])))
        return sparse.hstack(blocks).tocsc()

    def derivative(self, order: int) -> Sparse:
        """The matrix that takes coefficients to those of the derivative, in units/s ** order."""
        blocks = []
        for vector, count in zip(self._vectors, self._counts, strict=True):
            matrix, knots = sparse.identity(count, format="csc"), vector
            for degree in range(DEGREE, DEGREE - order, -1):
                widths = knots[degree + 1 : -1] - knots[1 : -degree - 1]
                size = len(widths)
                ones = np.ones(size)
                step = diagonals([-ones, ones], [0, 1], shape=(size, size + 1))
                matrix, knots = sparse.diags(degree / widths) @ step @ matrix, knots[1:-1]
            blocks.append(matrix)
        return sparse.block_diag(blocks).tocsc()

    def supports(self, order: int) -> tuple[Numbers, Numbers]:
        """Of each coefficient of that derivative, the first of the spans between `knots` it reaches, and one past."""
        first, last = [], []
        for vector in self._vectors:
            knots = vector[order : len(vector) - order]
            reach = DEGREE - order + 1
            first.append(np.searchsorted(self.knots, knots[:-reach]))
            last.append(np.searchsorted(self.knots, knots[reach:]))
        return np.concatenate(first), np.concatenate(last)

    def track(self, coefficients: Array) -> Track:
        """The offset over time."""
        states = np.array([self._at_knots(self.derivative(order) @ coefficients, order) for order in range(3)])
        states[:, [0, -1]] = 0.0
        return Track.through(self.knots, states)

    def coefficients(self, offset: Track) -> Array:
        """Those of an offset that is made of these functions."""
        from scipy.sparse.linalg import spsolve

        times = np.union1d(self.knots, np.linspace(self.knots[0], self.knots[-1], 4 * len(self.knots)))
        matrix = self.values(times)[:, self.free]
        found = np.zeros(self.count)
        found[self.free] = np.asarray(spsolve((matrix.T @ matrix).tocsc(), matrix.T @ offset.sample(times)[0]))
        return found

    def _at_knots(self, coefficients: Array, order: int) -> Array:
        """A derivative at the knots, from its own coefficients."""
        values, first = [], 0
        for vector, count in zip(self._vectors, self._counts, strict=True):
            spline = BSpline(
                vector[order : len(vector) - order], coefficients[first : first + count - order], DEGREE - order
            )
            at = np.unique(vector)
            values.append(spline(at)[1 if values else 0 :])
            first += count - order
        return np.concatenate(values)

"""Sparse matrices as the solver takes them, without scipy: loading that takes longer than checking a file.

A matrix is written as entries, those of one place added; the solver asks for it column by column (`columns`).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar, NamedTuple

import numpy as np

from teleop.planner.keyframes.mesh import Indices
from teleop.planner.polynomial import Array


@dataclass(frozen=True, slots=True)
class Columns:
    """A matrix column by column, with the names that Clarabel asks a matrix for: those of scipy's csc_matrix.

    Lists, because Clarabel takes the numbers one by one, and those of an array are slow to take.
    """

    data: list[float]
    indices: list[int]
    indptr: list[int]
    shape: tuple[int, int]
    has_canonical_format: ClassVar[bool] = True

    @property
    def nnz(self) -> int:
        return len(self.data)


class Entries(NamedTuple):
    """`values` at `rows` and `columns`, each (k,), of a matrix of `shape`; what is at one place is added."""

    rows: Indices
    columns: Indices
    values: Array
    shape: tuple[int, int]

    def plus(self, other: Entries) -> Entries:
        """The sum of both, of the same shape."""
        rows = np.concatenate([self.rows, other.rows])
        columns = np.concatenate([self.columns, other.columns])
        return Entries(rows, columns, np.concatenate([self.values, other.values]), self.shape)

    def times(self, factor: float) -> Entries:
        return self._replace(values=factor * self.values)

    def by_column(self) -> Columns:
        """As the solver takes it: sorted, and no place twice."""
        height, width = self.shape
        place = self.columns * height + self.rows
        order = np.argsort(place, kind="stable")
        place, values = place[order], self.values[order]
        first = np.flatnonzero(np.diff(place, prepend=-1))
        if len(first) < len(place):
            place, values = place[first], np.add.reduceat(values, first)
        column, row = np.divmod(place, max(height, 1))
        starts = np.concatenate([[0], np.cumsum(np.bincount(column, minlength=width))])
        return Columns(values.tolist(), row.tolist(), starts.tolist(), self.shape)


def zero(size: int) -> Columns:
    """The square matrix of `size` without entries: the cost of a linear program."""
    return Columns([], [], [0] * (size + 1), (size, size))


def diagonal(values: Array) -> Columns:
    """The square matrix with `values` in its diagonal."""
    every = np.arange(len(values))
    return Entries(every, every, values, (len(values), len(values))).by_column()


def below_each_other(blocks: Sequence[Entries]) -> Columns:
    """The rows of all blocks, which have the same columns."""
    heights = [block.shape[0] for block in blocks]
    offsets = np.concatenate([[0], np.cumsum(heights)])
    rows = np.concatenate([block.rows + offset for block, offset in zip(blocks, offsets[:-1], strict=True)])
    columns, values = (np.concatenate([block[part] for block in blocks]) for part in (1, 2))
    return Entries(rows, columns, values, (int(offsets[-1]), blocks[0].shape[1])).by_column()

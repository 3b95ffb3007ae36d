"""The solver: the least of a quadratic cost within bounds, None where there is nothing within them."""

from __future__ import annotations

import numpy as np
import pytest

from teleop.planner.keyframes.qp_solver import minimize
from teleop.planner.keyframes.sparse import Entries, diagonal


def solved(rows: list[list[float]], bound: list[float]) -> list[float] | None:
    """The x nearest to (1, 2) with rows x <= bound."""
    matrix = np.array(rows, float)
    row, column = np.nonzero(matrix)
    entries = Entries(row, column, matrix[row, column], (len(bound), 2))
    found = minimize(diagonal(np.ones(2)), np.array([-1.0, -2.0]), entries.by_column(), np.array(bound))
    return None if found is None else found.tolist()


def test_the_least_lies_inside_or_on_a_bound() -> None:
    assert solved([[1, 0]], [5]) == pytest.approx([1, 2], abs=1e-6)
    assert solved([[1, 0], [0, 1]], [5, 0.5]) == pytest.approx([1, 0.5], abs=1e-6)


def test_bounds_that_exclude_each_other_have_no_solution() -> None:
    assert solved([[1, 0], [-1, 0]], [1, -2]) is None

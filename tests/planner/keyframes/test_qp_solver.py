"""The solver: the least of a quadratic cost within bounds, None where there is nothing within them."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import sparse

from teleop.planner.keyframes.qp_solver import minimize


def solved(rows: list[list[float]], bound: list[float]) -> list[float] | None:
    """The x nearest to (1, 2) with rows x <= bound."""
    cost = sparse.identity(2, format="csc")
    found = minimize(cost, np.array([-1.0, -2.0]), sparse.csc_matrix(np.array(rows)), np.array(bound))
    return None if found is None else found.tolist()


def test_the_least_lies_inside_or_on_a_bound() -> None:
    assert solved([[1, 0]], [5]) == pytest.approx([1, 2], abs=1e-6)
    assert solved([[1, 0], [0, 1]], [5, 0.5]) == pytest.approx([1, 0.5], abs=1e-6)


def test_bounds_that_exclude_each_other_have_no_solution() -> None:
    assert solved([[1, 0], [-1, 0]], [1, -2]) is None

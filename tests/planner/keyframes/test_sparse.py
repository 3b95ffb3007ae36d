"""The solver's matrices are those of scipy, which they stand for because it takes long to load."""

from __future__ import annotations

import subprocess
import sys

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import sparse

from teleop.planner.keyframes.sparse import Columns, Entries, below_each_other, diagonal, zero


def dense(matrix: Columns) -> list[list[float]]:
    return sparse.csc_matrix((matrix.data, matrix.indices, matrix.indptr), shape=matrix.shape).toarray().tolist()


@st.composite
def entries(draw: st.DrawFn, width: int = 4) -> Entries:
    height = draw(st.integers(1, 4))
    places = draw(st.lists(st.tuples(st.integers(0, height - 1), st.integers(0, width - 1), st.integers(-9, 9))))
    rows, columns, values = (np.array([place[part] for place in places], int) for part in range(3))
    return Entries(rows, columns, values.astype(float), (height, width))


@settings(max_examples=50)
@given(entries(), entries())
def test_entries_are_sorted_and_those_of_one_place_are_added(first: Entries, second: Entries) -> None:
    matrix = below_each_other([first, second.times(2.0)])

    expected = [sparse.coo_matrix((each.values, (each.rows, each.columns)), each.shape) for each in (first, second)]
    assert dense(matrix) == sparse.vstack([expected[0], 2 * expected[1]]).toarray().tolist()
    for start, end in zip(matrix.indptr, matrix.indptr[1:], strict=False):
        rows = matrix.indices[start:end]
        assert rows == sorted(set(rows))
    assert matrix.nnz == len(matrix.data) == matrix.indptr[-1]


def test_a_sum_a_diagonal_and_nothing() -> None:
    one = Entries(np.array([0]), np.array([1]), np.array([2.0]), (2, 2))

    assert dense(one.plus(one).by_column()) == [[0, 4], [0, 0]]
    assert dense(diagonal(np.array([1.0, 3.0]))) == [[1, 0], [0, 3]]
    assert dense(zero(2)) == [[0, 0], [0, 0]]


def test_planning_a_move_does_not_load_scipy() -> None:
    code = "import sys, teleop.sequence.compile, teleop.planner.keyframes.frame_keys; print('scipy' in sys.modules)"

    found = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)

    assert found.stdout == "False\n"

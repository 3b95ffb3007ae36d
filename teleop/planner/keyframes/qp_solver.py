"""Clarabel, the solver of the planner's quadratic programmes, and the only place that knows it.

Chosen over OSQP because it holds constraints to 1e-8 without tuning (libraries.md). One thread: the programmes are
small, and starting threads costs more than they give.
"""

from __future__ import annotations

from importlib import import_module
from typing import Any

import numpy as np

from teleop.planner.polynomial import Array

clarabel: Any = import_module("clarabel")  # a compiled module without types
Sparse = Any  # scipy.sparse: its types say less than nothing about what an operation returns

SOLVED = (clarabel.SolverStatus.Solved, clarabel.SolverStatus.AlmostSolved)


def minimise(cost: Sparse, linear: Array, matrix: Sparse, bound: Array) -> Array | None:
    """The x of least x P x / 2 + q x with A x <= b, or None when there is none.

    `cost` is the upper triangle of P in csc, `linear` q, `matrix` A in csc, `bound` b.
    """
    settings = clarabel.DefaultSettings()
    settings.verbose = False
    settings.max_threads = 1
    cones = [clarabel.NonnegativeConeT(len(bound))]
    solution = clarabel.DefaultSolver(cost, linear, matrix, bound, cones, settings).solve()
    return np.asarray(solution.x) if solution.status in SOLVED else None

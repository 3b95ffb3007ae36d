"""Solves the planner's quadratic programs with Clarabel, which only this module knows.

Clarabel holds constraints to 1e-8 without tuning; OSQP does not (docs/explanation/planning.md, "B. Keyframes"). It
runs on one thread: the programs are small, and starting threads takes longer than solving.
"""

from __future__ import annotations

from importlib import import_module
from typing import Any

import numpy as np

from teleop.planner.keyframes.sparse import Columns
from teleop.planner.polynomial import Array

clarabel: Any = import_module("clarabel")  # a compiled module without types

SOLVED = (clarabel.SolverStatus.Solved, clarabel.SolverStatus.AlmostSolved)
SURE = (*SOLVED, clarabel.SolverStatus.PrimalInfeasible)


def minimize(cost: Columns, linear: Array, matrix: Columns, bound: Array, *, quickly: bool = False) -> Array | None:
    """The x of least x P x / 2 + q x with A x <= b, or None when there is none.

    `cost` is the upper triangle of P, `linear` q, `matrix` A, `bound` b. `quickly` is for linear programs of
    well scaled rows whose answer is tried afterwards: in a third of the time, to about 1e-6. Where that comes to no
    answer, it is solved again with care.
    """
    settings = clarabel.DefaultSettings()
    settings.iterative_refinement_enable = settings.equilibrate_enable = not quickly
    settings.verbose = False
    settings.max_threads = 1
    cones = [clarabel.NonnegativeConeT(len(bound))]
    solution = clarabel.DefaultSolver(cost, linear, matrix, bound, cones, settings).solve()
    if quickly and solution.status not in SURE:
        return minimize(cost, linear, matrix, bound)
    return np.asarray(solution.x) if solution.status in SOLVED else None

"""Solves a segment: minimum jerk from rest, through keys, to rest; and what would have to give where nothing does."""

from __future__ import annotations

import numpy as np

from teleop.core.axes import Limits
from teleop.planner.keyframes.program import QuadraticProgram, Rows, Rule, stacked
from teleop.planner.keyframes.qp_solver import minimize
from teleop.planner.keyframes.segment import Segment
from teleop.planner.keyframes.sparse import zero
from teleop.planner.polynomial import Array

UNBOUND = 1e6  # a limit this many times beyond the segment's whole range is left out


def inequalities(program: QuadraticProgram, relaxed: frozenset[int]) -> list[Rows]:
    """Rows of A x <= b for V, A, J, the direction and, where there is none, the range of positions."""
    blocks = []
    mixed = bool(relaxed) or bool(np.any(program.stray) and not np.all(program.stray))
    for order in (1, 2, 3):
        # v and a at a piece's start are its neighbor's at the end, unless that neighbor has other limits
        rows, piece = program.rows(order, skip=0 if mixed or order == 3 else 1)
        limit = program.bounds(order)
        limit = np.where(np.isin(program.interval, list(relaxed)) | (limit >= UNBOUND), np.inf, limit)
        upper, lower = limit, -limit
        if order == 1:
            direction = program.direction[program.interval]
            upper, lower = np.where(direction < 0, 0.0, limit), np.where(direction > 0, 0.0, -limit)
        blocks += program.within(rows, lower[piece], upper[piece])
    return blocks + _positions(program)


def _positions(program: QuadraticProgram) -> list[Rows]:
    low, high = program.range()
    if not (np.isfinite(low).any() or np.isfinite(high).any()):
        return []
    rows, piece = program.rows(0, skip=1)
    return program.within(rows, low[piece], high[piece])


def solve(
    segment: Segment, limits: Limits, rule: Rule, relaxed: frozenset[int] = frozenset()
) -> tuple[Array, Array] | None:
    """Widths (m,) and coefficients (m, 6) of the smoothest pieces, or None when this rule allows none.

    V, A and J do not apply to the intervals `relaxed`.
    """
    program = QuadraticProgram(segment, limits, rule)
    solution = minimize(*program.cost(), *stacked(inequalities(program, relaxed), program.unknowns))
    if solution is None:
        return None
    values = program.hermite(solution)
    if not program.keeps_limits(values, relaxed):
        return None
    return program.widths, program.coefficients(values)


def least_factors(segment: Segment, limits: Limits, rule: Rule) -> Array | None:
    """By what each interval would have to exceed V, A and J: (n, 3) factors >= 1, as few above 1 as possible.

    The elastic program: a slack per interval and limit, their sum minimized. None when the soft limits forbid
    even that.
    """
    program = QuadraticProgram(segment, limits, rule)
    intervals, unknowns = len(segment.steps), program.unknowns
    slacks = np.arange(unknowns, unknowns + 3 * intervals)
    blocks = [*_positions(program), Rows(-np.ones((len(slacks), 1)), slacks[:, None], np.zeros(len(slacks)))]
    for order in (1, 2, 3):
        rows, piece = program.rows(order, skip=0)
        limit = program.bounds(order)[piece]
        slack = slacks[3 * program.interval[piece] + order - 1]
        for sign in (1.0, -1.0):
            relative = Rows(sign * rows.values / limit[:, None], rows.columns, 1.0 + sign * rows.bounds / limit)
            blocks.append(relative.with_slack(-1.0, slack))
    linear = np.concatenate([np.zeros(unknowns), np.ones(3 * intervals)])
    solution = minimize(zero(len(linear)), linear, *stacked(blocks, len(linear)))
    return None if solution is None else 1.0 + solution[unknowns:].reshape(-1, 3)

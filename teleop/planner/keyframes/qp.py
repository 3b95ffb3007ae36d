"""The quadratic program of one segment: minimum jerk from rest, through keys, to rest.

The unknowns are position, velocity and acceleration at the knots, with a quintic between two knots. The Bernstein
coefficients of its derivatives are bounded, so the limits hold in continuous time. What is known in advance (keys, rest
at the ends, velocity 0 at a key where the direction changes) is no unknown. Ramps are a matter of cost: a segment with
ramps is cut where they end, and acceleration between them is so expensive that there is only what keys and limits need.
See docs/explanation/planning.md, "B. Keyframes".

Durations may differ by a factor of a million (a twitch, then a drift of a day), so the numbers are kept within what a
double can resolve: knots beside a short interval are graded (`mesh`), each knot has the time scale of its shorter
piece, and the weights of the pieces are clipped.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy import sparse

from teleop.core.axes import Limits
from teleop.planner.keyframes.mesh import Indices, mesh
from teleop.planner.keyframes.qp_solver import Sparse, minimize
from teleop.planner.keyframes.segment import Segment
from teleop.planner.polynomial import BERNSTEIN, GRAM_ACCELERATION, GRAM_JERK, GRAM_VELOCITY, HERMITE, Array

HEADROOM = 0.95  # share of V, A and J, so that each sample is one legal step from the last (planning page, "B")
CLIP = 1e6  # largest ratio of a piece's weight to the median
SMOOTHING = 1e-6  # least weight of jerk beside tension, or a day's drift would have none
STEADY = 5.0  # acceleration between ramps weighs T / STEADY, jerk its ramp cubed: the speed is even within 2 %
TAU = 0.25  # s: tension 1 weighs velocity as 1/TAU^4
TOLERANCE = 1.01  # on the headroom: the solver's, small beside the 5 % that are left
SMALLEST = 1e-9  # units; a segment that moves less is not scaled up further
UNBOUND = 1e6  # a limit this many times beyond the segment's whole range is left out


@dataclass(frozen=True, slots=True)
class Rule:
    """How to solve a segment: pieces per interval, `directed` for no overshoot, `tension` 0..1 for even speed."""

    pieces: int
    directed: bool
    tension: float = 0.0


class QuadraticProgram:
    """The arrays of one segment: knots, unknowns, and rows. Limits are those the planner may use, before HEADROOM."""

    def __init__(self, segment: Segment, limits: Limits, rule: Rule) -> None:
        self.segment, self.limits, self.rule = segment, limits, rule
        durations, intervals, ramps = segment.cuts()
        cut, self.widths, knots = mesh(durations, rule.pieces)
        self.interval, self.ramps = intervals[cut], ramps[cut]
        keys = knots[np.searchsorted(intervals, np.arange(len(segment.steps) + 1))]
        count = len(self.widths) + 1
        self.scale = max(float(np.ptp(segment.positions)), SMALLEST)
        self.origin = float(segment.positions[0])
        self.direction = np.sign(segment.steps) if rule.directed else np.zeros(len(segment.steps))
        times = np.concatenate([self.widths[:1], np.minimum(self.widths[:-1], self.widths[1:]), self.widths[-1:]])
        self.times = times
        self.known = np.full((count, 3), np.nan)
        self.known[keys, 0] = (segment.positions - self.origin) / self.scale
        self.known[[0, -1], 1:] = segment.ends * times[[0, -1], None] ** (1, 2) / self.scale
        if rule.directed:
            self.known[keys[1:-1][self.direction[:-1] != self.direction[1:]], 1] = 0.0
        free = np.isnan(self.known).ravel()
        self.unknowns = int(free.sum())
        self.column = np.where(free, np.cumsum(free) - 1, -1)
        self.given = np.where(free, 0.0, self.known.ravel())
        knots = np.arange(count - 1)[:, None]
        self.index = np.hstack([3 * knots + np.arange(3), 3 * knots + 3 + np.arange(3)])
        powers = np.arange(3)
        self.local = np.hstack(
            [(self.widths / times[:-1])[:, None] ** powers, (self.widths / times[1:])[:, None] ** powers]
        )

    def cost(self) -> tuple[Sparse, Array]:
        """The weighted squares of jerk, acceleration and velocity, as the solver's P (upper triangle) and q."""
        jerk, acceleration = self._smoothness()
        velocity = (self.rule.tension / TAU) ** 4 / self.widths
        middle = np.median(jerk + velocity)
        velocity = np.clip(velocity / middle, 0.0, CLIP)
        acceleration = np.clip(acceleration / middle, 0.0, CLIP)
        jerk = np.clip(jerk / middle, np.maximum(1 / CLIP, SMOOTHING * np.maximum(velocity, acceleration)), CLIP)
        blocks = jerk[:, None, None] * GRAM_JERK / 720 + velocity[:, None, None] * GRAM_VELOCITY
        blocks += acceleration[:, None, None] * GRAM_ACCELERATION
        blocks *= self.local[:, :, None] * self.local[:, None, :]
        rows = np.broadcast_to(self.index[:, :, None], blocks.shape).ravel()
        columns = np.broadcast_to(self.index[:, None, :], blocks.shape).ravel()
        size = len(self.given)
        whole = sparse.coo_matrix((blocks.ravel(), (rows, columns)), shape=(size, size)).tocsc()
        free = self.column >= 0
        kept = whole[free][:, free]
        return sparse.triu(kept, format="csc"), whole[free] @ self.given

    def _smoothness(self) -> tuple[Array, Array]:
        """The weights of jerk and acceleration by piece.

        A ramp's jerk counts by the cube of its duration: a change of speed then costs the same in a short ramp as in a
        long one, or the whole way would be made in the longer of the two.
        """
        if self.segment.ramps is None:
            return self.widths**-5.0, np.zeros_like(self.widths)
        whole = float(self.segment.times[-1] - self.segment.times[0])
        least = max(min(self.segment.ramps), whole / CLIP)
        jerk = np.maximum(self.ramps, least) ** 3 / self.widths**5
        return jerk, np.where(self.ramps == 0, whole / STEADY / self.widths**3, 0.0)

    def rows(self, order: int, skip: int) -> tuple[Sparse, Array, Indices]:
        """Bernstein coefficients of the `order`-th derivative by u, less the first `skip` of each piece.

        The matrix over the unknowns, the part that the known values give, and each row's piece.
        """
        basis = BERNSTEIN[order][skip:]
        per_piece = len(basis)
        blocks = basis[None] * self.local[:, None, :]
        count = len(self.widths) * per_piece
        row = np.broadcast_to(np.arange(count).reshape(-1, per_piece, 1), blocks.shape).ravel()
        column = np.broadcast_to(self.index[:, None, :], blocks.shape).ravel()
        value = blocks.ravel()
        given = np.zeros(count)
        np.add.at(given, row, value * self.given[column])
        keep = self.column[column] >= 0
        matrix = sparse.csr_matrix((value[keep], (row[keep], self.column[column[keep]])), shape=(count, self.unknowns))
        return matrix, given, np.repeat(np.arange(len(self.widths)), per_piece)

    def bounds(self, order: int) -> Array:
        """Per piece the limit on the `order`-th derivative by u, in units of the scale."""
        limit = (self.limits.velocity, self.limits.acceleration, self.limits.jerk)[order - 1]
        return HEADROOM * limit * self.widths**order / self.scale

    def hermite(self, solution: Array) -> Array:
        """What the solver found, as the pieces' Hermite values (m, 6), in units of the scale."""
        values = self.given.copy()
        values[self.column >= 0] = solution
        return values[self.index] * self.local

    def keeps_limits(self, values: Array, relaxed: frozenset[int]) -> bool:
        """Whether V, A and J hold in continuous time: checked here, whatever the solver reports."""
        bound = ~np.isin(self.interval, list(relaxed))
        return all(
            bool(np.all(np.abs(values @ BERNSTEIN[order].T)[bound] <= self.bounds(order)[bound, None] * TOLERANCE))
            for order in (1, 2, 3)
        )

    def coefficients(self, values: Array) -> Array:
        """The pieces (m, 6) of those values, ascending in local seconds."""
        pieces = (values * self.scale @ HERMITE.T) / self.widths[:, None] ** np.arange(6)
        pieces[:, 0] += self.origin
        return pieces


def _inequalities(program: QuadraticProgram, relaxed: frozenset[int]) -> tuple[list[Sparse], list[Array]]:
    """Rows and bounds of A x <= b for V, A, J, the direction and, without one, the soft limits."""
    matrices, bounds = [], []
    for order in (1, 2, 3):
        # v and a at a piece's start are its neighbor's at the end, unless that neighbor has no limits
        matrix, given, piece = program.rows(order, skip=0 if relaxed or order == 3 else 1)
        limit = program.bounds(order)[piece]
        limit[np.isin(program.interval[piece], list(relaxed))] = np.inf
        upper = lower = limit
        if order == 1:
            direction = program.direction[program.interval[piece]]
            upper = np.where(direction < 0, 0.0, limit)
            lower = np.where(direction > 0, 0.0, limit)
        for sign, bound in ((1.0, upper), (-1.0, lower)):
            keep = (bound < UNBOUND) & (np.diff(matrix.indptr) > 0)
            matrices.append(sign * matrix[keep])
            bounds.append(bound[keep] - sign * given[keep])
    if not program.rule.directed:
        for matrix, bound in _soft_limits(program):
            matrices.append(matrix)
            bounds.append(bound)
    return matrices, bounds


def _soft_limits(program: QuadraticProgram) -> list[tuple[Sparse, Array]]:
    matrix, given, _ = program.rows(0, skip=1)
    limits = program.limits
    rows = []
    for sign, limit in ((1.0, limits.maximum), (-1.0, limits.minimum)):
        if np.isfinite(limit):
            bound = sign * (limit - program.origin) / program.scale - sign * given
            keep = np.diff(matrix.indptr) > 0
            rows.append((sign * matrix[keep], bound[keep]))
    return rows


def solve(
    segment: Segment, limits: Limits, rule: Rule, relaxed: frozenset[int] = frozenset()
) -> tuple[Array, Array] | None:
    """Widths (m,) and coefficients (m, 6) of the smoothest pieces, or None when this rule allows none.

    V, A and J do not apply to the intervals `relaxed`.
    """
    program = QuadraticProgram(segment, limits, rule)
    matrices, bounds = _inequalities(program, relaxed)
    cost, linear = program.cost()
    solution = minimize(cost, linear, sparse.vstack(matrices, format="csc"), np.concatenate(bounds))
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
    matrices: list[Sparse] = []
    bounds: list[Array] = []
    for order in (1, 2, 3):
        matrix, given, piece = program.rows(order, skip=0)
        limit = program.bounds(order)[piece]
        slack = sparse.csr_matrix(
            (-np.ones(len(piece)), (np.arange(len(piece)), 3 * program.interval[piece] + order - 1)),
            shape=(len(piece), 3 * intervals),
        )
        for sign in (1.0, -1.0):
            matrices.append(sparse.hstack([sparse.diags(sign / limit) @ matrix, slack]))
            bounds.append(1.0 - sign * given / limit)
    for matrix, bound in [] if rule.directed else _soft_limits(program):
        matrices.append(sparse.hstack([matrix, sparse.csr_matrix((matrix.shape[0], 3 * intervals))]))
        bounds.append(bound)
    matrices.append(sparse.hstack([sparse.csr_matrix((3 * intervals, unknowns)), -sparse.identity(3 * intervals)]))
    bounds.append(np.zeros(3 * intervals))
    linear = np.concatenate([np.zeros(unknowns), np.ones(3 * intervals)])
    cost = sparse.csc_matrix((len(linear), len(linear)))
    solution = minimize(cost, linear, sparse.vstack(matrices, format="csc"), np.concatenate(bounds))
    return None if solution is None else 1.0 + solution[unknowns:].reshape(-1, 3)

"""The arrays of one segment's quadratic program: its unknowns, its cost, and rows that bound it.

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

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from teleop.core.axes import Limits
from teleop.planner.keyframes.evenness import STEADY, change_times, velocity_weights
from teleop.planner.keyframes.mesh import Indices, mesh
from teleop.planner.keyframes.segment import Segment
from teleop.planner.keyframes.sparse import Columns, Entries
from teleop.planner.keyframes.tension import Tension
from teleop.planner.median import median
from teleop.planner.polynomial import BERNSTEIN, GRAM_ACCELERATION, GRAM_JERK, GRAM_VELOCITY, HERMITE, Array

HEADROOM = 0.95  # share of V, A and J, so that each sample is one legal step from the last (planning page, "B")
CLIP = 1e6  # largest ratio of a piece's weight to the median
SMOOTHING = 1e-6  # least weight of jerk beside tension, or a day's drift would have none
TOLERANCE = 1.01  # on the headroom: the solver's, small beside the 5 % that are left
SMALLEST = 1e-9  # units; a segment that moves less is not scaled up further


@dataclass(frozen=True, slots=True)
class Rule:
    """How to solve a segment: pieces of all or of each interval, `directed` for no overshoot, `tension` for even speed.

    Without `directed` each interval may leave the range of its keys by the segment's `stray`. `fine` cuts finer at the
    keys, where an overshoot is; of intervals with unequal pieces, those that have most.
    """

    pieces: int | Indices
    directed: bool
    tension: Tension = 0.0
    fine: bool = False


class Rows(NamedTuple):
    """Rows of A x <= b as few entries each: their values and columns (k, e), a column -1 for none, and b (k,)."""

    values: Array
    columns: Indices
    bounds: Array

    def where(self, keep: NDArray[np.bool_]) -> Rows:
        """Only those rows, without those that have no unknown."""
        keep = keep & (self.columns >= 0).any(axis=1)
        return Rows(self.values[keep], self.columns[keep], self.bounds[keep])

    def with_slack(self, values: Array | float, columns: Indices) -> Rows:
        """With one more entry in each row."""
        extra = np.broadcast_to(np.asarray(values, float), (len(self.bounds),))
        return Rows(
            np.concatenate([self.values, extra[:, None]], axis=1),
            np.concatenate([self.columns, columns[:, None]], axis=1),
            self.bounds,
        )


def stacked(blocks: Sequence[Rows], unknowns: int) -> tuple[Columns, Array]:
    """All rows as one matrix A, and its b."""
    rows, columns, values, count = [], [], [], 0
    for block in blocks:
        row, entry = np.nonzero(block.columns >= 0)
        rows.append(row + count)
        columns.append(block.columns[row, entry])
        values.append(block.values[row, entry])
        count += len(block.bounds)
    matrix = Entries(np.concatenate(rows), np.concatenate(columns), np.concatenate(values), (count, unknowns))
    return matrix.by_column(), np.concatenate([block.bounds for block in blocks])


class QuadraticProgram:
    """The arrays of one segment: knots, unknowns, and rows. Limits are those the planner may use, before HEADROOM."""

    def __init__(self, segment: Segment, limits: Limits, rule: Rule) -> None:
        self.segment, self.limits, self.rule = segment, limits, rule
        durations, intervals, ramps = segment.cuts(segment.resolved(limits.jerk) / 2)
        near = change_times(segment, rule.tension)[intervals] if len(intervals) == len(segment.steps) else None
        pieces = np.broadcast_to(rule.pieces, len(segment.steps))
        if rule.fine:
            finest = np.where(pieces == pieces.max(), FINE * limits.acceleration / limits.jerk, np.inf)
            near = np.stack([finest, finest], axis=1)[intervals]
        cut, self.widths, knots = mesh(durations, pieces[intervals], near)
        self.interval, self.ramps = intervals[cut], ramps[cut]
        keys = knots[np.searchsorted(intervals, np.arange(len(segment.steps) + 1))]
        self.scale = max(float(np.ptp(segment.positions)), SMALLEST)
        self.origin = float(segment.positions[0])
        self.stray = segment.strays(rule.directed)
        self.direction = np.where(self.stray == 0, np.sign(segment.steps), 0.0)
        self._number(keys)

    def _number(self, keys: Indices) -> None:
        """What is known at each knot, and the columns of what is not."""
        segment, widths = self.segment, self.widths
        count = len(widths) + 1
        self.times = times = np.concatenate([widths[:1], np.minimum(widths[:-1], widths[1:]), widths[-1:]])
        known = np.full((count, 3), np.nan)
        known[keys, 0] = (segment.positions - self.origin) / self.scale
        known[[0, -1], 1:] = segment.ends * times[[0, -1], None] ** (1, 2) / self.scale
        held = self.stray == 0
        turns = held[:-1] & held[1:] & (self.direction[:-1] != self.direction[1:])
        known[keys[1:-1][turns], 1] = 0.0
        free = np.isnan(known).ravel()
        self.unknowns = int(free.sum())
        self.column = np.where(free, np.cumsum(free) - 1, -1)
        self.given = np.where(free, 0.0, known.ravel())
        self.index = 3 * np.arange(count - 1)[:, None] + np.arange(6)
        self.columns = self.column[self.index]
        powers = np.arange(3)
        self.local = np.hstack([(widths / times[:-1])[:, None] ** powers, (widths / times[1:])[:, None] ** powers])

    def cost(self) -> tuple[Columns, Array]:
        """The weighted squares of jerk, acceleration and velocity, as the solver's P (upper triangle) and q."""
        jerk, acceleration = self._smoothness()
        velocity = velocity_weights(self.segment, self.rule.tension)[self.interval] / self.widths
        middle = median(jerk + velocity)
        velocity = np.clip(velocity / middle, 0.0, CLIP)
        acceleration = np.clip(acceleration / middle, 0.0, CLIP)
        jerk = np.clip(jerk / middle, np.maximum(1 / CLIP, SMOOTHING * np.maximum(velocity, acceleration)), CLIP)
        blocks = jerk[:, None, None] * GRAM_JERK / 720 + velocity[:, None, None] * GRAM_VELOCITY
        blocks += acceleration[:, None, None] * GRAM_ACCELERATION
        blocks *= self.local[:, :, None] * self.local[:, None, :]
        forces = np.einsum("kij,kj->ki", blocks, self.given[self.index])
        free = self.columns >= 0
        linear = np.bincount(self.columns[free], forces[free], minlength=self.unknowns).astype(float)
        rows = np.broadcast_to(self.columns[:, :, None], blocks.shape)
        columns = np.broadcast_to(self.columns[:, None, :], blocks.shape)
        kept = (rows >= 0) & (columns >= rows)
        size = (self.unknowns, self.unknowns)
        return Entries(rows[kept], columns[kept], blocks[kept], size).by_column(), linear

    def _smoothness(self) -> tuple[Array, Array]:
        """The weights of jerk and acceleration by piece.

        A ramp's jerk counts by the cube of its duration: a change of speed then costs the same in a short ramp as in a
        long one, or the whole way would be made in the longer of the two.
        """
        if self.segment.ramps is None:
            return self.widths**-5.0, np.zeros_like(self.widths)
        whole = float(self.segment.times[-1] - self.segment.times[0])
        least = max(float(self.segment.ramps.min()), whole / CLIP)
        jerk = np.maximum(self.ramps, least) ** 3 / self.widths**5
        return jerk, np.where(self.ramps == 0, whole / STEADY / self.widths**3, 0.0)

    def rows(self, order: int, skip: int) -> tuple[Rows, Indices]:
        """Bernstein coefficients of the `order`-th derivative by u, less the first `skip` of each piece, and the piece
        of each row. What the known values give is in the bounds, negative: to be added to what each row may be."""
        basis = BERNSTEIN[order][skip:]
        values = (basis[None] * self.local[:, None, :]).reshape(-1, 6)
        index = np.repeat(self.index, len(basis), axis=0)
        rows = Rows(values, self.column[index], -(values * self.given[index]).sum(axis=1))
        return rows, np.repeat(np.arange(len(self.widths)), len(basis))

    def within(self, rows: Rows, lower: Array, upper: Array) -> list[Rows]:
        """The rows at most `upper` and at least `lower`; infinite ones are left out."""
        above = Rows(rows.values, rows.columns, upper + rows.bounds).where(np.isfinite(upper))
        below = Rows(-rows.values, rows.columns, -lower - rows.bounds).where(np.isfinite(lower))
        return [above, below]

    def bounds(self, order: int) -> Array:
        """Per piece the limit on the `order`-th derivative by u, in units of the scale."""
        limit = (self.limits.velocity, self.limits.acceleration, self.limits.jerk)[order - 1]
        return HEADROOM * limit * self.widths**order / self.scale

    def range(self) -> tuple[Array, Array]:
        """Per piece the least and greatest position, in units of the scale; infinite where nothing bounds it."""
        positions = self.segment.positions
        low = np.maximum(np.minimum(positions[:-1], positions[1:]) - self.stray, self.limits.minimum)
        high = np.minimum(np.maximum(positions[:-1], positions[1:]) + self.stray, self.limits.maximum)
        monotone = self.direction != 0
        low, high = np.where(monotone, -np.inf, low), np.where(monotone, np.inf, high)
        return (low[self.interval] - self.origin) / self.scale, (high[self.interval] - self.origin) / self.scale

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


FINE = 0.5  # of the seconds in which jerk reaches the axis's acceleration: as fine as a fine rule cuts at a key

"""The least durations of a segment's intervals: the planner's own program, with the durations as unknowns too.

With durations the program is no longer linear. It is solved by a few linear programs, each about the solution of the
one before (sequential linear programming): their sum is minimized, and none becomes shorter than was asked for. At such
a minimum less of any one duration is impossible as long as the others stay. A limit may be exceeded at a price, so any
start will do; three to five rounds are enough.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from teleop.core.axes import Limits
from teleop.planner.keyframes.mesh import Indices, mesh
from teleop.planner.keyframes.program import FINE, HEADROOM, SMALLEST
from teleop.planner.keyframes.qp_solver import minimize
from teleop.planner.keyframes.segment import Segment
from teleop.planner.keyframes.sparse import Entries, below_each_other, diagonal
from teleop.planner.polynomial import BERNSTEIN, Array

PIECES = 8  # as the planner's finest rule, and as finely cut at the keys
ROUNDS = 8
STEP = 0.5  # the most by which a duration changes in one round, as a share of it
SETTLED = 0.02  # relative change of the sum at which no further round is needed: that would change it by 0.1 %
PRICE = 50.0  # of a limit that is exceeded by 100 %, in sums of all durations
MET = 1e-3  # a limit that is exceeded by less is kept
REGULAR = 1e-7  # a cost of every unknown: a linear program alone may have many solutions
FAR = 20.0  # ranges of the segment: a soft limit beyond is out of reach


class Window(NamedTuple):
    """What is to be timed: `group` (n,) numbers the duration of each interval, twins the same.

    `open_ends`: whether velocity and acceleration are free at the first and at the last key, where the segment goes on.
    `stray` (n,) is how far each interval may leave the range of its two keys, in units; None for any distance.
    """

    segment: Segment
    limits: Limits
    group: Indices
    open_ends: tuple[bool, bool] = (False, False)
    stray: Array | None = None


class _Rows(NamedTuple):
    matrix: Entries
    bound: Array


def least_durations(window: Window, guess: Array) -> Array | None:
    """Durations (n,), none shorter than asked for, from a first `guess` of them; None when no time would help."""
    program = _Program(window, guess)
    durations = program.asked.copy()
    np.maximum.at(durations, window.group, guess)
    states, before, kept = program.straight(durations), np.inf, None
    for _ in range(ROUNDS):
        found = program.improved(durations, states)
        if found is None:
            break
        durations, states, exceeded = found
        total = float(program.weight @ durations)
        if exceeded < MET:
            kept = durations
            if abs(total - before) < SETTLED * total:
                break
            before = total
    return None if kept is None else kept[window.group]


class _Program:
    """One linear program after another; its unknowns: free states of the knots, changes of durations, excesses."""

    def __init__(self, window: Window, guess: Array) -> None:
        segment, self.limits = window.segment, window.limits
        self.positions = segment.positions - segment.positions[0]
        self.origin, self.scale = float(segment.positions[0]), max(float(np.ptp(segment.positions)), SMALLEST)
        self.stray = window.stray
        near = np.full((len(guess), 2), FINE * self.limits.acceleration / self.limits.jerk)
        self.interval, widths, keys = mesh(guess, PIECES, near)
        self.share, self.keys = widths / guess[self.interval], keys
        self.group = window.group[self.interval]
        self.asked = np.zeros(int(window.group.max()) + 1)
        np.maximum.at(self.asked, window.group, segment.durations)
        self.weight = np.bincount(window.group).astype(float)
        known = np.full((len(self.interval) + 1, 3), np.nan)
        known[keys, 0] = self.positions / self.scale
        for end, is_open in zip((0, -1), window.open_ends, strict=True):
            if not is_open:
                known[end, 1:] = 0.0
        self.free = np.isnan(known).ravel()
        self.given = np.where(self.free, 0.0, known.ravel())
        self.column = np.where(self.free, np.cumsum(self.free) - 1, -1)
        knot = np.arange(len(self.interval))[:, None]
        self.index = np.hstack([3 * knot + np.arange(3), 3 * knot + 3 + np.arange(3)])
        self.states_free, self.intervals = int(self.free.sum()), len(segment.steps)
        self.width = self.states_free + len(self.asked) + self.intervals

    def straight(self, durations: Array) -> Array:
        """States (knots, 3) in units and seconds, from key to key in straight lines."""
        times = np.concatenate([[0.0], np.cumsum(durations[self.group] * self.share)])
        positions = np.interp(times, times[self.keys], self.positions)
        return np.stack([positions, np.gradient(positions, times), np.zeros_like(times)], axis=1)

    def improved(self, durations: Array, states: Array) -> tuple[Array, Array, float] | None:
        """Better durations and states, and by what the worst limit is still exceeded; None without a solution."""
        widths = durations[self.group] * self.share
        times = np.concatenate([widths[:1], np.minimum(widths[:-1], widths[1:]), widths[-1:]])
        units = self.scale / times[:, None] ** np.arange(3)
        powers = np.arange(3)
        local = np.hstack([(widths / times[:-1])[:, None] ** powers, (widths / times[1:])[:, None] ** powers])
        bends = (states / units).ravel()[self.index] * local * np.tile(powers, 2)  # what a longer piece does to them
        rows = [*self._limit_rows(widths, local, bends), *self._range_rows(local, bends), *self._step_rows(durations)]
        linear = np.zeros(self.width)
        linear[self.states_free : -self.intervals] = self.weight * durations / float(self.weight @ durations)
        linear[-self.intervals :] = PRICE
        cost = diagonal(np.where(linear == PRICE, 0.0, REGULAR))
        matrix = below_each_other([each.matrix for each in rows])
        solution = minimize(cost, linear, matrix, np.concatenate([each.bound for each in rows]), quickly=True)
        if solution is None:
            return None
        values = self.given.copy()
        values[self.free] = solution[: self.states_free]
        change = solution[self.states_free : -self.intervals]
        longer = np.maximum(durations * (1 + change), self.asked)
        return longer, values.reshape(-1, 3) * units, float(solution[-self.intervals :].max())

    def _limit_rows(self, widths: Array, local: Array, bends: Array) -> list[_Rows]:
        """Each Bernstein coefficient of a derivative within its limit, or as far beyond as is paid for."""
        rows = []
        limits = (self.limits.velocity, self.limits.acceleration, self.limits.jerk)
        for order, limit in enumerate(limits, start=1):
            allowed = HEADROOM * limit * widths**order / self.scale
            matrix, given, bend = self._coefficients(BERNSTEIN[order], local, bends, allowed)
            size = len(BERNSTEIN[order])
            excess = self._columns(np.repeat(self.interval, size), -np.ones(len(given)), -self.intervals)
            for sign in (1.0, -1.0):
                change = self._columns(np.repeat(self.group, size), sign * bend - order, self.states_free)
                rows.append(_Rows(matrix.times(sign).plus(change).plus(excess), 1.0 - sign * given))
        return rows

    def _range_rows(self, local: Array, bends: Array) -> list[_Rows]:
        """Each Bernstein coefficient of the position within the soft limits and the overshoot allowed, where near."""
        rows = []
        basis = BERNSTEIN[0][1:-1]  # its ends are knots, which the neighbors bound, or keys
        for sign, limit in ((1.0, self.limits.maximum), (-1.0, self.limits.minimum)):
            ends = sign * np.stack([self.positions[:-1], self.positions[1:]])
            beyond = ends.max(axis=0) + (np.inf if self.stray is None else self.stray)
            room = np.minimum(sign * (limit - self.origin), beyond)[self.interval] / self.scale
            if not np.any(room < FAR):
                continue
            matrix, given, bend = self._coefficients(basis, local, bends, np.ones(len(local)))
            change = self._columns(np.repeat(self.group, len(basis)), sign * bend, self.states_free)
            rows.append(
                _Rows(matrix.times(sign).plus(change), np.minimum(np.repeat(room, len(basis)), FAR) - sign * given)
            )
        return rows

    def _step_rows(self, durations: Array) -> list[_Rows]:
        """Durations that change by STEP at most and stay as long as asked for, and no excess below 0."""
        every, ones = np.arange(len(durations)), np.ones(len(durations))
        least = np.maximum(self.asked / durations - 1, -STEP)
        intervals = np.arange(self.intervals)
        return [
            _Rows(self._columns(every, ones, self.states_free), STEP * ones),
            _Rows(self._columns(every, -ones, self.states_free), -least),
            _Rows(self._columns(intervals, -np.ones(self.intervals), -self.intervals), np.zeros(self.intervals)),
        ]

    def _coefficients(self, basis: Array, local: Array, bends: Array, allowed: Array) -> tuple[Entries, Array, Array]:
        """Bernstein coefficients as shares of what each piece is `allowed`: matrix, known part, change by duration."""
        blocks = basis[None] * local[:, None, :] / allowed[:, None, None]
        count = len(local) * len(basis)
        row = np.broadcast_to(np.arange(count).reshape(-1, len(basis), 1), blocks.shape).ravel()
        place = np.broadcast_to(self.index[:, None, :], blocks.shape).ravel()
        value = blocks.ravel()
        given = np.bincount(row, value * self.given[place], minlength=count).astype(float)
        keep = self.free[place]
        matrix = Entries(row[keep], self.column[place[keep]], value[keep], (count, self.width))
        return matrix, given, (bends @ basis.T / allowed[:, None]).ravel()

    def _columns(self, column: Indices, value: Array, offset: int) -> Entries:
        """A matrix with one value in each row, in the unknowns that begin at `offset`."""
        begin = offset if offset >= 0 else self.width + offset
        return Entries(np.arange(len(column)), begin + column, value, (len(column), self.width))

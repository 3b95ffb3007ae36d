"""How far a segment has to overshoot: where the limits leave no way between two keys that stays in their range.

A linear program finds the least: first the largest overshoot, as a share of what is tolerated, then the sum of all. The
smoothest way within that is the plan. The rule of direction holds wherever there is no overshoot.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from teleop.core.axes import Axis, Limits
from teleop.planner.keyframes.program import QuadraticProgram, Rows, Rule, stacked
from teleop.planner.keyframes.qp import inequalities, solve
from teleop.planner.keyframes.qp_solver import minimize
from teleop.planner.keyframes.segment import Segment
from teleop.planner.keyframes.sparse import zero
from teleop.planner.keyframes.tension import Tension
from teleop.planner.keyframes.windows import NEARLY, TIGHT, WHOLE, around, graded, spread, tightness
from teleop.planner.polynomial import Array

SHARE = 0.01  # of the range between two keys: an overshoot tolerated where the file does not say
LEAST = 0.2  # deg, and 1 % of that for an axis without a unit: tolerated however near the keys
SMALLEST = 1e-3  # units: the least that an overshoot is weighed by
MOST = 0.1  # of the range of all keys: the most
LOOSER = 1.1  # times the least overshoot: what the smoothest way may use
ROOM = 0.02  # of what is tolerated, beside that
NONE = 1e-3  # of what is tolerated: less is the solver's tolerance
DOUBTFUL = 0.8, 2.0  # of what is tolerated: between these the least overshoot is found exactly
SUM = 0.01  # weight of all overshoots beside that of the largest
FINEST = Rule(pieces=8, directed=False, fine=True)


def tolerated(axis: Axis, segment: Segment, asked: Sequence[float | None]) -> Array:
    """Per interval the overshoot (n,) that is no error, in units: as `asked`, or what is usual where that is None."""
    usual = np.maximum(SHARE * np.abs(segment.steps), LEAST if axis.unit else LEAST / 100)
    own = np.array([np.nan if each is None else each for each in asked], float)
    is_loose = bool(np.isinf(own).all())
    return own if is_loose else np.where(np.isfinite(own), own, usual)


def least_overshoot(segment: Segment, limits: Limits) -> Array | None:
    """Per interval by how much (n,) it leaves the range of its two keys at least, in units; None if nothing helps.

    Least in shares of the segment's `stray`, the tolerated ones. A long segment is looked at only where it is tight.
    """
    count, parts = len(segment.steps), [(0, len(segment.steps))]
    if count > WHOLE:
        tight = tightness(segment, limits)
        parts = around(tight > min(TIGHT, NEARLY * float(tight.max())))
    states = np.full((count + 1, 2), np.nan)
    states[[0, -1]] = segment.ends
    windows = {part: segment if part == (0, count) else segment.window(*part, states) for part in parts}
    shares = {part: _least(window, limits, quickly=True) for part, window in windows.items()}
    worst = max(np.inf if share is None else float(share.max()) for share in shares.values())
    if DOUBTFUL[0] < worst < DOUBTFUL[1]:
        for part, share in shares.items():
            if share is not None and share.max() > DOUBTFUL[0]:
                shares[part] = _least(windows[part], limits, quickly=False)
    least = np.zeros(count)
    for (first, last), share in shares.items():
        if share is None:
            return None
        least[first:last] = share * _weight(windows[first, last])
    return least


def _least(segment: Segment, limits: Limits, *, quickly: bool) -> Array | None:
    """The same in shares of the weights, by one linear program. Velocity and acceleration are free where not known."""
    program = QuadraticProgram(replace(segment, stray=None), limits, FINEST)
    count, unknowns = len(segment.steps), program.unknowns
    weight = _weight(segment)
    slacks = unknowns + np.arange(count)
    rows, piece = program.rows(0, skip=1)
    interval = program.interval[piece]
    positions = (segment.positions - program.origin) / program.scale
    low, high = np.minimum(positions[:-1], positions[1:]), np.maximum(positions[:-1], positions[1:])
    blocks = inequalities(program, frozenset())
    for sign, bound in ((1.0, high), (-1.0, -low)):
        side = Rows(sign * rows.values, rows.columns, bound[interval] + sign * rows.bounds)
        blocks.append(side.with_slack(-weight[interval] / program.scale, slacks[interval]))
    ones = np.ones(count)
    largest = np.full(count, unknowns + count)
    blocks.append(Rows(-ones[:, None], slacks[:, None], np.zeros(count)))
    blocks.append(Rows(np.stack([ones, -ones], axis=1), np.stack([slacks, largest], axis=1), np.zeros(count)))
    linear = np.concatenate([np.zeros(unknowns), SUM / count * ones, [1.0]])
    none = zero(len(linear))
    solution = minimize(none, linear, *stacked(blocks, len(linear)), quickly=quickly)
    return None if solution is None else np.maximum(solution[unknowns:-1], 0.0)


def _weight(segment: Segment) -> Array:
    """What is tolerated, as the measure of the least: a file that allows any distance asks for no more of it."""
    most = max(MOST * float(np.ptp(segment.positions)), SMALLEST)
    return np.clip(segment.strays(directed=False), SMALLEST, most)


def with_overshoot(segment: Segment, limits: Limits, least: Array, tension: Tension) -> tuple[Array, Array] | None:
    """Widths and coefficients of the smoothest way that overshoots about as little as the `least` (n,)."""
    weight, most = _weight(segment), np.maximum(segment.strays(directed=False), SMALLEST)
    strays = np.maximum(np.minimum(LOOSER * least + ROOM * weight, most), least + NONE * weight)
    rule = replace(FINEST, tension=tension)
    if len(segment.steps) > WHOLE:
        rule = replace(rule, pieces=graded(tightness(segment, limits)))
    flat = segment.steps == 0
    beyond = (least > NONE * weight) | flat
    for bent in (beyond, spread(beyond), np.ones_like(beyond)):
        bounded = replace(segment, stray=np.where(bent, strays, 0.0))
        solved = solve(bounded, limits, rule)
        if solved is not None:
            return solved
    return None

"""Questions about a move answered by a linear programme of its own: steps of constant jerk, sampled limits, HiGHS."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import linprog

from teleop.core.axes import Limits

HEADROOM = 0.95
STEPS = 160  # of constant jerk, about
FEWEST = 8  # of them between two keys

Array = NDArray[np.float64]
Indices = NDArray[np.intp]
Keys = Sequence[tuple[float, float]]


class _Motion(NamedTuple):
    """`states` (3, steps + 1, n): position, velocity, acceleration as rows over the jerks, one more unknown, and 1."""

    states: Array
    knots: Indices
    way: Indices  # of each step


def _motion(keys: Keys) -> _Motion:
    times, positions = np.array(keys, float).T
    counts = np.maximum(np.round(np.diff(times) / (times[-1] - times[0]) * STEPS).astype(int), FEWEST)
    widths = np.repeat(np.diff(times) / counts, counts)
    states = np.zeros((3, len(widths) + 1, len(widths) + 2))
    states[0, 0, -1] = positions[0]
    for step, width in enumerate(widths):
        p, v, a = states[:, step]
        states[:, step + 1] = p + width * v + width**2 / 2 * a, v + width * a, a
        states[:, step + 1, step] += width**3 / 6, width**2 / 2, width
    return _Motion(states, np.concatenate([[0], np.cumsum(counts)]), np.repeat(np.arange(len(counts)), counts))


def _least(motion: _Motion, keys: Keys, limits: Limits, rows: Array, most: Array, sign: float) -> float | None:
    """The one more unknown, least (sign 1) or largest (-1), with rows <= most and all limits; None if impossible."""
    states, positions = motion.states, np.array(keys, float)[:, 1]
    count = states.shape[1] - 1
    bounded = [(states[0], limits.maximum, limits.minimum)]
    bounded += [
        (states[order], HEADROOM * limit, -HEADROOM * limit)
        for order, limit in ((1, limits.velocity), (2, limits.acceleration))
    ]
    upper = np.concatenate([rows, *(part for state, _, _ in bounded for part in (state, -state))])
    bound = np.concatenate([most, *(np.full(count + 1, end) for _, high, low in bounded for end in (high, -low))])
    equal = np.concatenate([states[0, motion.knots[1:]], states[1:, -1]])
    goal = np.concatenate([positions[1:], [0.0, 0.0]])
    jerk = HEADROOM * limits.jerk
    cost = np.zeros(count + 1)
    cost[-1] = sign
    answer = linprog(
        cost,
        upper[:, :-1],
        bound - upper[:, -1],
        equal[:, :-1],
        goal - equal[:, -1],
        [(-jerk, jerk)] * count + [(0, None)],
        method="highs",
    )
    return sign * float(answer.fun) if answer.status == 0 else None


def least_overshoot_lp(keys: Keys, limits: Limits) -> float | None:
    """The largest distance (units) by which some way has to leave the range of its two keys; None if impossible."""
    motion, positions = _motion(keys), np.array(keys, float)[:, 1]
    low, high = np.minimum(positions[:-1], positions[1:]), np.maximum(positions[:-1], positions[1:])
    inside = motion.states[0, 1:]
    beyond = np.zeros_like(inside)
    beyond[:, -2] = 1.0
    rows = np.concatenate([inside - beyond, -inside - beyond])
    return _least(motion, keys, limits, rows, np.concatenate([high[motion.way], -low[motion.way]]), 1.0)


def slowest_speed_lp(keys: Keys, limits: Limits, middle: float) -> float | None:
    """The largest share of the mean speed that each way can keep in its `middle` share; None if one turns back."""
    motion, (times, positions) = _motion(keys), np.array(keys, float).T
    mean = np.diff(positions) / np.diff(times)
    place = np.concatenate([(np.arange(size) + 0.5) / size for size in np.diff(motion.knots)])
    forward = np.sign(mean)[motion.way, None] * motion.states[1, 1:]
    least = np.zeros_like(forward)
    least[np.abs(place - 0.5) < middle / 2, -2] = 1.0
    rows = least * np.abs(mean)[motion.way, None] - forward
    return _least(motion, keys, limits, rows, np.zeros(len(rows)), -1.0)

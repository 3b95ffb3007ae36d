"""Whether recorded states can be commanded again: a legal step must lead from each to the next.

Three equal spans of constant jerk connect any two states, and when they are legal the step is: that settles all but the
few ticks within which the jerk was switched, in one pass over arrays. Those few are asked of Ruckig, as the planner
itself does. A recording is cut to so many decimals, which is allowed for, and no more.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from teleop.core.axes import Limits, State
from teleop.planner.polynomial import Array
from teleop.planner.ruckig_solver import PositionSolver

ALLOWED = 1e-4  # share of a limit that Ruckig's tolerance and the decimals of a file may add
REACH = 1e-6  # units beyond a soft limit
MOST = 1e6  # times a limit: more is not distinguished


class Excess(NamedTuple):
    """At `time` s a limit is passed: a soft limit by `size` units, another by the factor `size`."""

    time: float
    limit: str
    size: float


def excess(times: Array, states: Array, limits: Limits) -> Iterator[Excess]:
    """The worst of each limit that the states (3, n) at `times` (n,) do not keep."""
    position, velocity, acceleration = states
    for limit, beyond in (("minimum", limits.minimum - position), ("maximum", position - limits.maximum)):
        if beyond.max(initial=0.0) > REACH:
            yield Excess(float(times[beyond.argmax()]), limit, float(beyond.max()))
    legal = True
    for limit, share in (
        ("velocity", np.abs(velocity) / limits.velocity),
        ("acceleration", np.abs(acceleration) / limits.acceleration),
    ):
        if share.max(initial=0.0) > 1 + ALLOWED:
            legal = False
            yield Excess(float(times[share.argmax()]), limit, float(share.max()))
    jerks = spans(np.diff(times), states)
    worst = np.abs(jerks).max(axis=0, initial=0.0) / limits.jerk
    candidates = np.flatnonzero(worst > 1 + ALLOWED)
    least = {index: _least_factor(times, states, index, limits) for index in candidates.tolist()} if legal else {}
    bad = {index: factor for index, factor in least.items() if factor > 1 + ALLOWED}
    if bad:
        index = max(bad, key=lambda each: bad[each])
        yield Excess(float(times[index + 1]), "jerk", bad[index])


def spans(widths: Array, states: Array) -> Array:
    """The jerks (3, n) of three equal spans that lead from each of the states (3, n + 1) to the next."""
    (p_0, v_0, a_0), (p_1, v_1, a_1) = states[:, :-1], states[:, 1:]
    span = widths / 3
    x = (a_1 - a_0) / span
    y = v_1 - v_0 - a_0 * widths
    z = (p_1 - p_0 - widths * (v_0 + a_0 * widths / 2)) / span
    first = (z - y) / span**2 + x / 3
    last = (z - 2 * y) / span**2 + x * (11 / 6)
    return np.array([first, x - first - last, last])


def _least_factor(times: Array, states: Array, index: int, limits: Limits) -> float:
    """The least multiple of the jerk with which Ruckig takes step `index` in its time."""
    start, end = (State(*states[:, each].tolist()) for each in (index, index + 1))
    seconds = float(times[index + 1] - times[index])
    low, high = 0.0, 1 + ALLOWED
    while high < MOST and not _reaches(start, end, seconds, limits, high):
        low, high = high, high * 2
    while low and high - low > 0.01 * high:
        middle = (low + high) / 2
        low, high = (low, middle) if _reaches(start, end, seconds, limits, middle) else (middle, high)
    return high if low else 1.0


def _reaches(start: State, end: State, seconds: float, limits: Limits, factor: float) -> bool:
    """Whether a legal step of this length leads from one state to the other, with so much jerk."""
    loose = 1 + ALLOWED
    answer = PositionSolver().solve(
        [start],
        [end],
        [limits.velocity * loose],
        [limits.acceleration * loose],
        [limits.jerk * factor],
        minimum_duration=seconds,
    )
    return answer is not None and answer.duration <= seconds * (1 + 1e-6)

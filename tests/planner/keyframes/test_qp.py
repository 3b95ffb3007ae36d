"""The quadratic program: keys are met, limits hold, and what is free or forbidden stays so."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from teleop.core.axes import Limits
from teleop.planner.keyframes.program import HEADROOM, TOLERANCE, Rule
from teleop.planner.keyframes.qp import least_factors, solve
from teleop.planner.keyframes.segment import Segment
from teleop.planner.polynomial import extremes

LIMITS = Limits(-170, 170, 60, 120, 600)


def segment(*keys: tuple[float, float]) -> Segment:
    times, positions = zip(*keys, strict=True)
    return Segment(np.array(times, float), np.array(positions, float))


@settings(max_examples=25, deadline=None)
@given(st.lists(st.tuples(st.floats(0.2, 5), st.floats(-50, 50)), min_size=1, max_size=5))
def test_whatever_it_returns_meets_the_keys_and_keeps_the_limits(steps: list[tuple[float, float]]) -> None:
    times = np.cumsum([0.0, *(seconds for seconds, _ in steps)])
    asked = Segment(times, np.array([0.0, *(position for _, position in steps)]))
    solved = solve(asked, LIMITS, Rule(4, directed=False))
    if solved is None:
        assert (least_factors(asked, LIMITS, Rule(4, directed=False)) > 1).any()  # type: ignore[operator]
        return
    widths, coefficients = solved
    starts = np.concatenate([[0.0], np.cumsum(widths)])
    for time, position in zip(times[:-1], asked.positions[:-1], strict=True):
        assert coefficients[np.abs(starts[:-1] - time).argmin(), 0] == pytest.approx(position, abs=1e-6)
    least, greatest = extremes(coefficients, widths)
    magnitudes = np.maximum(-least, greatest).max(axis=1)[1:]
    assert (magnitudes <= HEADROOM * TOLERANCE * np.array([60, 120, 600])).all()


def test_directed_forbids_what_undirected_may() -> None:
    tight = segment((0, 0), (1.3, 40), (1.6, 40.1), (4, 40.2))
    assert solve(tight, LIMITS, Rule(8, directed=True)) is None
    assert solve(tight, LIMITS, Rule(8, directed=False)) is not None


def test_a_relaxed_interval_has_no_limits_and_the_others_keep_theirs() -> None:
    fast = segment((0, 0), (3, 10), (3.2, 60), (8, 70))
    assert solve(fast, LIMITS, Rule(8, directed=False)) is None
    assert solve(fast, LIMITS, Rule(8, directed=False), relaxed=frozenset({1})) is not None


def test_the_factors_of_what_can_be_done_are_1_and_of_what_cannot_more() -> None:
    rule = Rule(8, directed=False)
    easy, fast = segment((0, 0), (3, 10), (8, 70)), segment((0, 0), (3, 10), (3.2, 60), (8, 70))
    assert least_factors(easy, LIMITS, rule) == pytest.approx(np.ones((2, 3)), abs=1e-6)
    factors = least_factors(fast, LIMITS, rule)
    assert factors is not None
    assert factors[1, 0] >= 50 / (0.2 * HEADROOM * LIMITS.velocity) * (1 - 1e-6)  # the mean speed that it asks for


def test_soft_limits_bind_the_undirected_program() -> None:
    walls = Limits(-170, 40.15, 60, 120, 600)
    tight = segment((0, 0), (1.3, 40), (1.6, 40.1), (4, 40.1))
    solved = solve(tight, walls, Rule(8, directed=False))
    if solved is not None:
        assert extremes(solved[1], solved[0])[1][0].max() <= 40.15 + 1e-6
    assert solve(segment((0, 0), (5, 40)), walls, Rule(8, directed=False)) is not None

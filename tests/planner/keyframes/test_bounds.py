"""What no plan can do is known without a solver, and never of what a plan can do."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from ruckig import InputParameter, Ruckig, Trajectory

from teleop.core.axes import Limits
from teleop.planner.keyframes.bounds import factors_needed, is_beyond, least_time, rest_to_rest
from teleop.planner.keyframes.program import HEADROOM, Rule
from teleop.planner.keyframes.qp import solve
from teleop.planner.keyframes.segment import Segment

LIMITS = Limits(-170, 170, 60, 120, 600)


@given(
    st.floats(1e-3, 300), st.floats(1, 200), st.floats(0.3, 20), st.floats(0.3, 30)
)  # distance, V, and how soon A and J reach it
def test_rest_to_rest_is_the_time_optimal_step(distance: float, velocity: float, quick: float, sudden: float) -> None:
    limits = Limits(-1e3, 1e3, velocity, velocity * quick, velocity * quick * sudden)
    question, answer = InputParameter(1), Trajectory(1)
    question.target_position = [distance]
    question.max_velocity = [HEADROOM * limits.velocity]
    question.max_acceleration = [HEADROOM * limits.acceleration]
    question.max_jerk = [HEADROOM * limits.jerk]
    Ruckig(1).calculate(question, answer)
    assert rest_to_rest(distance, limits) == pytest.approx(answer.duration, rel=1e-5)


@settings(max_examples=25)
@given(st.lists(st.tuples(st.floats(0.2, 2.0), st.floats(-60, 60)), min_size=1, max_size=6))
def test_what_is_beyond_has_no_plan(intervals: list[tuple[float, float]]) -> None:
    times = np.cumsum([0.0, *(seconds for seconds, _ in intervals)])
    segment = Segment(times, np.array([0.0, *(position for _, position in intervals)]))
    if is_beyond(segment, LIMITS):
        assert solve(segment, LIMITS, Rule(8, directed=False)) is None


def test_a_quick_zigzag_is_the_jerk_whatever_its_speed() -> None:
    segment = Segment(np.arange(6) / 24, np.array([0, 0.3, -0.3, 0.3, -0.3, 0.0]))
    factors = factors_needed(segment, LIMITS)
    assert is_beyond(segment, LIMITS)
    assert (factors.argmax(axis=1) == 2).all()
    assert (factors[:, 0] < 1).all()


def test_the_least_time_of_one_interval_among_others_is_at_full_speed() -> None:
    segment = Segment(np.array([0.0, 1.0, 2.0]), np.array([0.0, 5.7, 62.7]))
    assert least_time(segment, LIMITS, 1) == pytest.approx(1.0)
    alone = Segment(np.array([0.0, 1.0]), np.array([0.0, 57.0]))
    assert least_time(alone, LIMITS, 0) == pytest.approx(rest_to_rest(57, LIMITS))

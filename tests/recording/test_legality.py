"""Whether recorded states can be commanded again."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from teleop.core.axes import Axis, Limits
from teleop.planner.keyframes.planner import Key, plan
from teleop.recording.legality import excess, spans

LIMITS = Limits(-100, 100, 60, 120, 600)


def planned() -> tuple[np.ndarray, np.ndarray]:
    times = np.arange(401) / 100
    move = plan({Axis.PAN: [Key(0, 0), Key(2, 30), Key(4, -5)]}, {Axis.PAN: LIMITS})
    return times, move.sample(times)[Axis.PAN][:3]


def test_a_planned_move_keeps_its_limits() -> None:
    assert list(excess(*planned(), LIMITS)) == []


@pytest.mark.parametrize(
    ("limits", "limit"),
    [
        (Limits(-1, 100, 60, 120, 600), "minimum"),
        (Limits(-100, 20, 60, 120, 600), "maximum"),
        (Limits(-100, 100, 10, 120, 600), "velocity"),
        (Limits(-100, 100, 60, 20, 600), "acceleration"),
        (Limits(-100, 100, 60, 120, 50), "jerk"),
    ],
)
def test_a_limit_that_is_too_tight_is_named_with_the_worst_place(limits: Limits, limit: str) -> None:
    times, states = planned()
    [found] = excess(times, states, limits)
    assert found.limit == limit
    if limit == "velocity":
        assert found.size == pytest.approx(np.abs(states[1]).max() / 10)
        assert found.time == times[np.abs(states[1]).argmax()]


@given(st.lists(st.floats(-500, 500), min_size=3, max_size=3), st.floats(-20, 20), st.floats(-50, 50))
def test_three_spans_are_recovered_from_the_states_that_they_connect(
    jerks: list[float], velocity: float, acceleration: float
) -> None:
    state = [0.0, velocity, acceleration]
    start, t = list(state), 0.01 / 3
    for jerk in jerks:
        p, v, a = state
        state = [p + t * (v + t * (a / 2 + t * jerk / 6)), v + t * (a + t * jerk / 2), a + t * jerk]
    found = spans(np.array([0.01]), np.array([start, state]).T)
    assert found[:, 0] == pytest.approx(jerks, abs=1e-3)

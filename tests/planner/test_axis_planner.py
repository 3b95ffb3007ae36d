"""One axis of the live planner: the stop that is always possible, and what it does not let pass."""

from __future__ import annotations

import math

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from teleop.core.axes import Axis, Limits, State
from teleop.planner.axis_planner import INSET, SLACK, AxisPlanner

LIMITS = Limits(-10, 10, 20, 40, 200)
DT = 0.01


def shares(least: float = -1.2, most: float = 1.2) -> st.SearchStrategy[float]:
    return st.floats(least, most)


def placed(position: float = 0.0, velocity: float = 0.0, acceleration: float = 0.0) -> AxisPlanner:
    return AxisPlanner(Axis.PAN, LIMITS, State(position, velocity, acceleration))


@given(shares(), shares(), shares())
def test_the_guard_stop_keeps_the_reach_that_was_reckoned_at_its_start(p: float, v: float, a: float) -> None:
    """With more acceleration than the axis may have at the start, the stop once became longer on the way."""
    planner = placed(p * LIMITS.maximum, v * LIMITS.velocity, a * LIMITS.acceleration)
    low, high = planner.low, planner.high
    for _ in range(400):
        planner.state = planner.guard_stop(DT)
        planner.narrow()
        assert low - SLACK <= planner.state.position <= high + SLACK
    assert planner.rests


@given(shares(-1, 1), shares(), shares())
def test_a_state_that_trips_no_limit_can_be_stopped_inside(p: float, v: float, a: float) -> None:
    planner = placed()
    state = State(p * LIMITS.maximum, v * LIMITS.velocity, a * LIMITS.acceleration)
    assume(not planner.trips(state))
    planner.state = state
    for _ in range(400):
        planner.state = planner.guard_stop(DT)
        assert abs(planner.state.position) <= LIMITS.maximum + 2 * SLACK
    assert planner.rests


@pytest.mark.parametrize(("velocity", "side"), [(20.0, 1), (-20.0, -1), (1.0, 0)])
def test_it_says_on_which_side_a_stop_would_leave_the_limits(velocity: float, side: int) -> None:
    planner = placed()
    assert planner.trips(State(math.copysign(6, velocity), velocity)) == side


def test_outside_only_the_way_back_is_open() -> None:
    planner = placed(12.0)
    assert planner.outside
    assert planner.trips(State(12.1, 1.0)) == 1
    assert planner.trips(State(11.9, -1.0)) == 0


def test_the_limits_in_force_narrow_as_it_comes_back() -> None:
    planner = placed(12.0)
    assert planner.high == 12.0
    planner.state = State(9.0)
    planner.narrow()
    assert (planner.high, planner.outside) == (10.0, False)


def test_an_axis_on_its_soft_limit_holds_against_it_and_leaves_it() -> None:
    planner = placed(LIMITS.maximum - INSET)
    assert planner.holds(5.0)
    assert planner.holds(0.0)
    assert not planner.holds(-5.0)
    assert not placed(0.0, 1.0).holds(0.0)


def test_an_operators_limits_wait_until_the_axis_is_within_them() -> None:
    planner = placed(0.0, 5.0, 30.0)
    planner.soften(10.0, None)
    assert planner.now == planner.guard
    planner.state = State(0.0, 5.0, 5.0)
    planner.soften(10.0, None)
    assert planner.now == (10.0, LIMITS.jerk)

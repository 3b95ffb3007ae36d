"""From a deflection to a velocity: the low-pass, the ramp, and when nothing is asked."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from teleop.core.axes import Limits, State
from teleop.core.setpoints import VelocityTarget
from teleop.manual.velocity_shaping import VelocityShaping

LIMITS = Limits(-180, 180, 120, 240, 1200)
REST, MOVING = State(0.0), State(0.0, 60.0)
TICK = 0.01


@given(st.floats(-1, 1), st.floats(0.05, 1))
def test_without_a_low_pass_a_deflection_is_its_share_of_the_velocity(deflection: float, share: float) -> None:
    target = VelocityShaping(LIMITS, 0, 0).setpoint(deflection, share, MOVING, TICK)
    assert target is not None
    assert target.velocity == pytest.approx(deflection * share * 120)
    assert (target.acceleration, target.jerk) == (None, None)


def test_an_axis_that_rests_and_is_not_deflected_is_asked_nothing() -> None:
    shaping = VelocityShaping(LIMITS, 0.5, 0.1)
    assert shaping.setpoint(0.0, 1.0, REST, TICK) is None
    assert shaping.setpoint(0.0, 1.0, MOVING, TICK) == VelocityTarget(0.0, *shaping._gentle())


@given(st.lists(st.floats(-1, 1), min_size=1, max_size=50), st.floats(0.02, 1))
def test_the_low_pass_never_leaves_the_range_of_what_was_asked(deflections: list[float], constant: float) -> None:
    shaping = VelocityShaping(LIMITS, 0, constant)
    low, high = min(0.0, *deflections), max(0.0, *deflections)
    for deflection in deflections:
        target = shaping.setpoint(deflection, 1.0, MOVING, TICK)
        assert target is not None
        assert low * 120 - 1e-9 <= target.velocity <= high * 120 + 1e-9


def test_a_dropped_input_leaves_no_memory_in_the_low_pass() -> None:
    shaping = VelocityShaping(LIMITS, 0, 0.5)
    for _ in range(100):
        shaping.setpoint(1.0, 1.0, MOVING, TICK)
    shaping.drop()
    target = shaping.setpoint(0.0, 1.0, MOVING, TICK)
    assert target is not None
    assert target.velocity == 0


@given(st.floats(0.01, 3), st.floats(0.05, 1))
def test_a_ramp_is_gentler_and_never_beyond_the_limits(ramp: float, share: float) -> None:
    target = VelocityShaping(LIMITS, ramp, 0).setpoint(1.0, share, REST, TICK)
    assert target is not None
    assert target.acceleration is not None
    assert target.jerk is not None
    assert 0 < target.acceleration <= LIMITS.acceleration
    assert 0 < target.jerk <= LIMITS.jerk
    if target.acceleration < LIMITS.acceleration and target.jerk < LIMITS.jerk:
        rise = target.acceleration / target.jerk
        assert share * 120 / target.acceleration + rise == pytest.approx(ramp), "full speed takes that long"

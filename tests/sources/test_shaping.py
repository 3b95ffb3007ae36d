"""The stick's curve: exact at its ends, no jump at the dead zone's edge, odd and rising."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from teleop.sources.shaping import shape

deflections = st.floats(-1, 1)
dead_zones = st.floats(0, 0.3)
expos = st.floats(0, 0.75)


@given(deflections)
def test_no_dead_zone_and_no_expo_leave_the_deflection_as_it_is(deflection: float) -> None:
    assert shape(deflection, 0, 0) == deflection


@given(dead_zones, expos)
def test_full_is_full_and_the_dead_zone_is_dead(dead_zone: float, expo: float) -> None:
    assert shape(1, dead_zone, expo) == pytest.approx(1)
    assert shape(-1, dead_zone, expo) == pytest.approx(-1)
    assert shape(dead_zone, dead_zone, expo) == 0
    assert abs(shape(dead_zone + 1e-6, dead_zone, expo)) < 1e-5


@given(deflections, deflections, dead_zones, expos)
def test_it_rises_and_is_odd(one: float, other: float, dead_zone: float, expo: float) -> None:
    low, high = sorted((one, other))
    assert shape(low, dead_zone, expo) <= shape(high, dead_zone, expo) + 1e-15
    assert shape(-one, dead_zone, expo) == -shape(one, dead_zone, expo)


def test_expo_is_the_pages_formula() -> None:
    assert shape(0.5, 0, 0.4) == pytest.approx(0.6 * 0.5 + 0.4 * 0.125)
    assert shape(0.53, 0.06, 0.4) == pytest.approx(0.6 * 0.5 + 0.4 * 0.125)

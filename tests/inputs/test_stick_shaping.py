"""The stick's curve: exact at its ends, no jump at the dead zone's edge, odd and rising."""

from collections.abc import Sequence

import pytest
from hypothesis import given
from hypothesis import strategies as st

from teleop.inputs.stick_shaping import Center, deflect, shape

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


ends = st.tuples(st.integers(-32768, 65535), st.integers(1, 65535)).map(lambda pair: (pair[0], pair[0] + pair[1]))


@given(ends, st.floats(0, 1), st.floats(-1, 2), st.floats(-1, 2), st.booleans())
def test_a_deflection_has_its_ends_its_center_and_no_way_back(
    between: tuple[int, int], at: float, one: float, other: float, turned: bool
) -> None:
    low, high = reversed(between) if turned else between
    center = low + at * (high - low)
    lower, higher = sorted((one, other))
    below, above = (deflect(low + place * (high - low), low, center, high) for place in (lower, higher))
    assert -1 <= below <= above <= 1
    assert deflect(center, low, center, high) == 0
    if center not in (low, high):
        assert (deflect(low, low, center, high), deflect(high, low, center, high)) == (-1, 1)


def found(values: Sequence[float], low: float = 0, high: float = 255) -> Center:
    center = Center(low, high)
    for index, value in enumerate(values):
        center.see(value, 100 + index * 0.01)
    return center


def test_a_center_is_where_the_stick_lies_for_a_moment() -> None:
    assert found([131] * 25).value is None
    center = found([131] * 30)
    assert (center.value, center.centered, center.learned) == (131, True, True)
    center.see(255, 200)
    assert center.value == 131


@pytest.mark.parametrize(
    ("value", "centered"), [(0, False), (255, False), (158, False), (114, False), (115, True), (140, True)]
)
def test_a_center_is_learned_only_within_a_tenth_of_the_middle(value: float, centered: bool) -> None:
    center = found([value] * 30)
    assert (center.centered, center.learned, center.value) == (centered, centered, value if centered else 127.5)


def test_a_stick_that_is_moved_meanwhile_has_the_middle_of_its_range() -> None:
    center = found([118 + index for index in range(20)] + [138] * 10)
    assert (center.value, center.centered, center.learned) == (127.5, True, False)


def test_a_stick_that_was_held_at_first_learns_its_center_once_it_rests_near_the_middle() -> None:
    assert not found([200] * 30 + [131] * 24).learned
    assert not found([200] * 30 + [131, 160] * 30).learned
    center = found([200] * 30 + [131] * 27)
    assert (center.value, center.centered, center.learned) == (131, False, True)


def test_a_center_that_is_given_is_kept() -> None:
    center = Center(0, 255, given=120)
    center.see(255, 0)
    assert (center.value, center.centered) == (120, True)

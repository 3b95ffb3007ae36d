"""The stick's curve: exact at its ends, no jump at the dead zone's edge, odd and rising."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from teleop.inputs.stick_shaping import Centre, deflect, shape

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
def test_a_deflection_has_its_ends_its_centre_and_no_way_back(
    between: tuple[int, int], at: float, one: float, other: float, turned: bool
) -> None:
    low, high = reversed(between) if turned else between
    centre = low + at * (high - low)
    lower, higher = sorted((one, other))
    below, above = (deflect(low + place * (high - low), low, centre, high) for place in (lower, higher))
    assert -1 <= below <= above <= 1
    assert deflect(centre, low, centre, high) == 0
    if centre not in (low, high):
        assert (deflect(low, low, centre, high), deflect(high, low, centre, high)) == (-1, 1)


def found(values: list[float], low: float = 0, high: float = 255) -> Centre:
    centre = Centre(low, high)
    for index, value in enumerate(values):
        centre.see(value, 100 + index * 0.01)
    return centre


def test_a_centre_is_where_the_stick_lies_for_a_moment() -> None:
    assert found([131] * 25).value is None
    centre = found([131] * 30)
    assert (centre.value, centre.centred) == (131, True)
    centre.see(255, 200)
    assert centre.value == 131


@pytest.mark.parametrize(("value", "centred"), [(0, False), (255, False), (95, False), (97, True), (159, True)])
def test_what_rests_far_from_the_middle_is_no_stick(value: float, centred: bool) -> None:
    centre = found([value] * 30)
    assert (centre.centred, centre.value) == (centred, value if centred else 127.5)


def test_a_stick_that_is_moved_meanwhile_has_the_middle_of_its_range() -> None:
    centre = found([128 + index * 4 for index in range(30)])
    assert (centre.value, centre.centred) == (127.5, True)


def test_a_centre_that_is_given_is_not_looked_for() -> None:
    centre = Centre(0, 255, given=120)
    centre.see(255, 0)
    assert (centre.value, centre.centred) == (120, True)

"""Pieces of a flight: each closed form is the integral of its own velocity, and touches down when it is at 0."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from teleop.sim.drone.segments import GRAVITY, Climb, Level

STEP = 1e-4
speeds = st.floats(-10, 10)


@given(speeds, speeds, speeds, st.floats(-2, 2), st.floats(0.01, 20))
def test_the_way_of_level_flight_is_the_integral_of_its_velocity(
    forward: float, right: float, last: float, turn: float, time: float
) -> None:
    level = Level(0.0, 3 + 4j, complex(forward, right), complex(last, 0), heading=1.0, turn=turn)
    slope = (level.at(time + STEP) - level.at(time - STEP)) / (2 * STEP)
    assert abs(slope - level.velocity(time)) < 1e-4
    assert level.at(0.0) == 3 + 4j


def test_level_flight_without_a_turn_goes_where_it_points() -> None:
    level = Level(first=2 + 0j, last=2 + 0j, heading=math.radians(90))
    assert level.at(3.0) == pytest.approx(6j), "its nose is to the east"


@given(speeds, speeds, st.booleans(), st.floats(0.01, 20))
def test_height_is_the_integral_of_the_climb(first: float, last: float, falling: bool, time: float) -> None:
    climb = Climb(0.0, 50.0, first, last, falling=falling)
    slope = (climb.at(time + STEP) - climb.at(time - STEP)) / (2 * STEP)
    assert slope == pytest.approx(climb.rate(time), abs=1e-4)
    assert climb.at(0.0) == 50.0


def test_a_fall_takes_as_long_as_gravity_says() -> None:
    fall = Climb(10.0, 20.0, falling=True)
    assert fall.touchdown(100.0) == pytest.approx(10.0 + math.sqrt(2 * 20.0 / GRAVITY))
    assert fall.touchdown(11.0) == math.inf, "not yet"


@pytest.mark.parametrize(
    ("first", "last"),
    [(0.0, -1.0), (-3.0, -1.0), (2.0, -1.0)],  # the last one climbs over its height at first
)
def test_a_descent_touches_down_once_where_its_height_is_0(first: float, last: float) -> None:
    climb = Climb(0.0, 5.0, first, last)
    moment = climb.touchdown(60.0)
    assert climb.at(moment) == pytest.approx(0.0, abs=1e-9)
    assert climb.at(moment - 0.01) > 0.0


def test_a_descent_that_turns_into_a_climb_touches_down_only_if_it_comes_that_low() -> None:
    """With the lag of 0.4 s it sinks 0.4 * (4 - 4 * ln 2) m, about 0.49."""
    assert Climb(0.0, 0.5, -4.0, 4.0).touchdown(60.0) == math.inf
    assert Climb(0.0, 0.48, -4.0, 4.0).touchdown(60.0) < 0.4 * math.log(2.0)


def test_a_drone_that_leaves_the_ground_has_not_touched_it() -> None:
    assert Climb(0.0, 0.0, 0.0, 2.0).touchdown(10.0) == math.inf


@pytest.mark.parametrize("turn", [5e-324, 1e-16, 1e-12])
def test_a_turn_that_is_next_to_nothing_is_straight_on(turn: float) -> None:
    assert Level(first=2 + 0j, last=2 + 0j, turn=turn).at(3.0) == pytest.approx(6 + 0j, abs=1e-9)

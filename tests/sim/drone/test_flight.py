"""How a simulated drone flies: closed forms that do not care how often they are looked at, and honest ends."""

from __future__ import annotations

import math
from collections.abc import Callable

import pytest
from hypothesis import given
from hypothesis import strategies as st

from teleop.sim.drone.flight import Flight
from teleop.sim.drone.segments import CLIMB_LAG, GRAVITY, LAG


def airborne(height: float = 20.0) -> Flight:
    """At rest, so many m above where it started, 100 s later."""
    flight = Flight(0.0)
    flight.start_motors()
    flight.rise_to(height)
    flight.pass_to(100.0)
    flight.climb(0.0)
    return flight


def test_a_velocity_is_taken_up_with_a_lag_and_the_attitude_that_it_needs() -> None:
    flight = airborne()
    flight.fly(4 + 0j)
    pose = flight.pose()
    assert pose.pitch == pytest.approx(-math.atan(4 / LAG / GRAVITY)), "nose down to go forward"
    flight.pass_to(100 + LAG)
    assert flight.pose().velocity_north == pytest.approx(4 * (1 - math.exp(-1)))
    flight.pass_to(110)
    assert flight.pose().north == pytest.approx(4 * (10 - LAG), abs=1e-6)
    assert flight.pose().pitch == pytest.approx(0, abs=1e-6)


def test_it_flies_a_circle_while_it_turns() -> None:
    flight = airborne()
    flight.turn(math.radians(36))
    flight.fly(5 + 0j)
    flight.pass_to(105)
    before = flight.pose()
    flight.pass_to(115)
    after = flight.pose()
    assert (after.north, after.east) == (pytest.approx(before.north, abs=0.01), pytest.approx(before.east, abs=0.01))
    assert math.hypot(after.velocity_north, after.velocity_east) == pytest.approx(5, abs=1e-3)


def test_over_the_ground_it_goes_straight_however_it_turns() -> None:
    flight = airborne()
    flight.fly(0 + 3j, to_north=True)
    flight.turn(1.0)
    flight.pass_to(110)
    assert flight.pose().north == pytest.approx(0)
    assert flight.pose().east == pytest.approx(3 * (10 - LAG), abs=1e-6)


def test_it_lands_when_it_comes_down_and_not_before() -> None:
    flight = airborne(10)
    flight.climb(-2)
    flight.pass_to(104.9)
    assert flight.airborne
    flight.pass_to(120)
    assert not flight.airborne
    assert flight.landed == pytest.approx(100 + 5 + CLIMB_LAG, abs=1e-3)
    assert not flight.crashed
    assert flight.pose().height == 0


def test_motors_cut_in_the_air_let_it_fall() -> None:
    flight = airborne(10)
    flight.stop_motors()
    flight.climb(4)
    flight.fly(5 + 0j)
    flight.pass_to(120)
    assert flight.crashed
    assert flight.landed == pytest.approx(100 + math.sqrt(2 * 10 / GRAVITY), abs=1e-6)
    flight.start_motors()
    assert not flight.motors


def test_without_motors_it_stays_on_the_ground() -> None:
    flight = Flight(0.0)
    flight.climb(4)
    flight.fly(5 + 0j)
    flight.pass_to(10)
    assert flight.pose()[:3] == (0, 0, 0)


def test_it_turns_to_a_heading_the_shorter_way_and_stops_there() -> None:
    flight = airborne()
    flight.face(math.radians(-170))
    flight.pass_to(101)
    assert flight.pose().yaw == pytest.approx(math.radians(-100))
    flight.pass_to(110)
    assert flight.pose().yaw == pytest.approx(math.radians(-170))
    assert flight.pose().yaw_rate == 0


def test_a_place_and_a_height_are_reached() -> None:
    flight = airborne(5)
    flight.seek(3 - 4j)
    flight.rise_to(9)
    flight.pass_to(130)
    assert flight.pose()[:3] == (pytest.approx(3), pytest.approx(-4), pytest.approx(9))


def test_it_drifts_with_a_tilt_to_the_speed_that_the_air_holds() -> None:
    flight = airborne()
    flight.lean(math.radians(10), 0.0)
    flight.pass_to(160)
    assert flight.pose().pitch == pytest.approx(math.radians(-10))
    assert flight.pose().velocity_north == pytest.approx(math.tan(math.radians(10)) * GRAVITY * 3, rel=1e-3)


COMMANDS: list[Callable[[Flight], object]] = [
    lambda flight: flight.fly(3 - 2j),
    lambda flight: flight.fly(-4 + 1j, to_north=True),
    lambda flight: flight.lean(0.2, -0.1),
    lambda flight: flight.turn(1.2),
    lambda flight: flight.face(2.0),
    lambda flight: flight.climb(2.0),
    lambda flight: flight.climb(-3.0),
    lambda flight: flight.seek(2 + 2j),
    lambda flight: flight.rise_to(3.0),
    lambda flight: flight.stop_motors(),
]


@given(
    st.lists(st.tuples(st.floats(0.01, 3), st.sampled_from(COMMANDS)), max_size=8),
    st.lists(st.floats(0, 30), max_size=20),
)
def test_looking_often_or_seldom_makes_no_difference(
    script: list[tuple[float, Callable[[Flight], object]]], looks: list[float]
) -> None:
    once, often = airborne(6), airborne(6)
    now = 100.0
    for wait, command in script:
        for look in sorted(looks):
            if look < wait:
                often.pass_to(now + look)
        now += wait
        for flight in (once, often):
            flight.pass_to(now)
            command(flight)
    once.pass_to(now + 20)
    for look in sorted(looks):
        often.pass_to(now + min(look, 20))
    often.pass_to(now + 20)
    assert often.pose() == pytest.approx(once.pose(), abs=1e-6)
    assert (often.airborne, often.crashed) == (once.airborne, once.crashed)

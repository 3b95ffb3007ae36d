"""Where an axis was at an instant, from readings that come late, unevenly, out of order and around +-180 degrees."""

from __future__ import annotations

import random

import pytest

from teleop.core.axes import Axis
from teleop.exchange.measured import BEYOND, KEPT, Measured, Readings


def readings(*rows: tuple[float, float], turns: bool = True) -> Readings:
    made = Readings(turns)
    for time, position in rows:
        made.add(time, position)
    return made


def position(of: Readings, instant: float) -> float:
    found = of.at(instant)
    assert found is not None
    return found.position


def test_two_readings_are_joined_by_a_line():
    assert position(readings((1.0, 10.0), (1.04, 14.0)), 1.03) == pytest.approx(13.0)


def test_an_even_acceleration_is_met_between_any_readings():
    def way(time: float) -> float:
        return 3.0 - 20.0 * time + 120.0 * time * time

    uneven = readings(*((time, way(time)) for time in (0.0, 0.04, 0.09, 0.12, 0.2)))
    for time in (0.01, 0.04, 0.07, 0.1, 0.15, 0.199):
        assert position(uneven, time) == pytest.approx(way(time), abs=1e-9)


def test_readings_may_come_in_any_order():
    rows = [(0.04 * index, float(index * (20 - index))) for index in range(20)]
    shuffled = random.Random(1).sample(rows, len(rows))
    assert [position(readings(*shuffled), time) for time, _ in rows] == pytest.approx([at for _, at in rows])


def test_a_reading_that_is_seen_again_with_a_rounded_time_is_the_same():
    twice = readings((1.0, 10.0), (1.0001, 10.0), (1.04, 14.0), (1.03995, 14.0))
    assert position(twice, 1.02) == pytest.approx(12.0)


@pytest.mark.parametrize(("first", "second", "between"), [(179.0, -179.0, 180.0), (-179.5, 179.5, -180.0)])
def test_an_angle_goes_the_short_way_over_half_a_turn(first, second, between):
    assert position(readings((0.0, first), (0.04, second)), 0.02) == pytest.approx(between)


def test_a_late_reading_over_half_a_turn_is_continued_from_the_one_before_it():
    late = readings((0.0, 175.0), (0.08, -177.0), (0.04, 179.0))
    assert [position(late, time) for time in (0.0, 0.04, 0.08)] == pytest.approx([175.0, 179.0, 183.0])


def test_a_focus_has_no_turns():
    assert position(readings((0.0, 0.0), (0.1, 1.0), turns=False), 0.05) == pytest.approx(0.5)


def test_past_the_newest_reading_an_axis_goes_on_for_a_moment_and_then_stays():
    moving = readings((0.0, 0.0), (0.04, 4.0))
    found = moving.at(0.05)
    assert found is not None
    assert found.beyond
    assert found.position == pytest.approx(5.0)
    assert position(moving, 3.0) == pytest.approx(4.0 + 100 * BEYOND)


def test_readings_that_are_far_apart_say_nothing_of_a_speed():
    assert position(readings((0.0, 0.0), (1.0, 30.0)), 1.04) == 30.0


def test_nothing_is_known_before_the_first_reading():
    assert readings().at(1.0) is None
    assert readings((1.0, 5.0)).at(0.9) is None


def test_as_many_readings_are_kept_as_say_something():
    long = readings(*((0.04 * index, float(index)) for index in range(10 * KEPT)))
    assert len(long._times) == KEPT
    long.add(0.0, 99.0)
    assert len(long._times) == KEPT


def test_a_state_has_the_readings_of_each_axis_with_their_own_ages():
    measured = Measured()
    measured.take({})
    for step in range(3):
        axes = {
            "pan": {"measured": 10.0 * step, "measured_age_ms": 10.0},
            "focus": {"measured": 0.1 * step, "measured_age_ms": 30.0},
            "tilt": {"measured": None, "measured_age_ms": None},
        }
        measured.take({"time": 100.0 + step, "axes": axes})
    pan, focus = measured.at(Axis.PAN, 100.99), measured.at(Axis.FOCUS, 100.97)
    assert pan is not None
    assert focus is not None
    assert (pan.position, focus.position) == pytest.approx((10.0, 0.1))
    assert measured.at(Axis.TILT, 101.0) is None
    assert measured.newest([Axis.PAN, Axis.FOCUS]) == pytest.approx(101.97)
    assert not measured.knows([Axis.PAN, Axis.TILT])

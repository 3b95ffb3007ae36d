"""Feed-forward and correction: against a simple axis with lag, and what an old or absent reading does."""

import pytest

from teleop.motion import Axis, Limits, Reading, State, Tick
from teleop.sinks.correction import DEAD_BAND, FRESH, MAX_INTEGRAL, Correction

LIMITS = {Axis.PAN: Limits(-180, 180, 60, 120, 600)}


def tick(now: float, state: State, reading: Reading | None) -> Tick:
    return Tick(now, {Axis.PAN: state}, {}, (), {} if reading is None else {Axis.PAN: reading})


def speed(correction: Correction, now: float, state: State, reading: Reading | None) -> float:
    each = tick(now, state, reading)
    correction.note(each)
    return correction.speeds(each)[Axis.PAN]


def test_without_a_fresh_reading_it_is_feed_forward_alone() -> None:
    correction = Correction(LIMITS, 0.05)
    assert speed(correction, 1.0, State(0, 10, 20), None) == pytest.approx(11)
    assert speed(correction, 2.0, State(0, 10, 0), Reading(50.0, 2.0 - FRESH - 0.01)) == 10


def test_an_error_is_worked_against_but_not_within_the_grid() -> None:
    assert speed(Correction(LIMITS, 0.0), 1.0, State(0, 0, 0), Reading(1.0, 1.0)) < -1
    assert speed(Correction(LIMITS, 0.0), 1.0, State(0, 0, 0), Reading(DEAD_BAND * 0.9, 1.0)) == 0


def test_the_error_is_taken_where_the_reading_was() -> None:
    correction = Correction(LIMITS, 0.0)
    for number in range(10):
        now = 1 + number / 100
        reading = Reading(30 * (now - 0.04), now - 0.04)  # old, and exactly on course
        assert speed(correction, now, State(30 * now, 30, 0), reading) == pytest.approx(30)


def test_an_axis_held_by_hand_winds_up_no_lunge() -> None:
    correction, now = Correction(LIMITS, 0.0), 0.0
    while now < 60:
        now += 0.04
        assert abs(speed(correction, now, State(20, 0, 0), Reading(0.0, now))) <= 60
    assert speed(correction, now + 0.04, State(20, 0, 0), Reading(20.0, now + 0.04)) <= MAX_INTEGRAL


def test_a_steady_disturbance_is_corrected_to_the_grid() -> None:
    correction, position, now = Correction(LIMITS, 0.0), 0.0, 0.0
    for _ in range(1000):
        now += 0.02
        command = speed(correction, now, State(5.0, 0, 0), Reading(round(position, 1), now))
        position += 0.02 * (command - 1.5)  # the head is heavy on one side
    assert position == pytest.approx(5.0, abs=0.2)

"""After a stall the axes that moved are found by two fresh readings each, or held, or given up, by a deadline."""

from __future__ import annotations

import math

import pytest

from teleop.core.axes import Axis, Reading, State
from teleop.core.stall_recovery import READINGS_TIMEOUT, StallRecovery

PAN, TILT = Axis.PAN, Axis.TILT
SINCE = 5.0


def lost(**velocities: float) -> StallRecovery:
    return StallRecovery({Axis(axis): State(0.0, velocity) for axis, velocity in velocities.items()}, SINCE)


def test_two_readings_say_where_an_axis_is_and_how_fast():
    recovery = lost(pan=30.0)
    assert not recovery.known(5.02, {PAN: Reading(10.0, 5.01)})
    assert recovery.known(5.06, {PAN: Reading(10.4, 5.05)})
    state = recovery.found(5.07)[PAN]
    assert state == pytest.approx(State(10.6, 10.0))


@pytest.mark.parametrize(("commanded", "moved", "velocity"), [(5.0, 1.0, 5.0), (5.0, -1.0, 0.0), (-5.0, -1.0, -5.0)])
def test_none_is_faster_than_commanded_nor_turned_round(commanded: float, moved: float, velocity: float):
    recovery = lost(pan=commanded)
    recovery.known(5.02, {PAN: Reading(0.0, 5.01)})
    recovery.known(5.04, {PAN: Reading(moved, 5.03)})
    assert recovery.found(5.04)[PAN].velocity == velocity


@pytest.mark.parametrize("reading", [Reading(1.0, 4.99), Reading(1.0, 5.2), Reading(math.nan, 5.05)])
def test_a_reading_from_before_the_stall_from_the_future_or_without_a_number_does_not_count(reading: Reading):
    recovery = lost(pan=10.0)
    recovery.known(5.1, {PAN: reading})
    assert (recovery.unread, recovery.found(5.1)) == ([PAN], {})


def test_by_the_deadline_an_axis_read_once_is_held_and_one_not_read_is_given_up():
    recovery = lost(pan=10.0, tilt=10.0)
    readings = {PAN: Reading(3.0, 5.1)}
    assert not recovery.known(SINCE + READINGS_TIMEOUT - 0.01, readings)
    assert recovery.known(SINCE + READINGS_TIMEOUT, readings)
    assert (recovery.read_once, recovery.unread) == ([PAN], [TILT])
    assert recovery.found(SINCE + READINGS_TIMEOUT) == {PAN: State(3.0)}


def test_of_two_readings_at_the_same_time_the_later_one_counts_alone():
    recovery = lost(pan=10.0)
    recovery.known(5.1, {PAN: Reading(3.0, 5.1)})
    assert not recovery.known(5.11, {PAN: Reading(4.0, 5.1)})
    assert recovery.found(5.11) == {PAN: State(4.0)}


def test_an_axis_that_rested_is_not_looked_for():
    assert StallRecovery({PAN: State(7.0)}, SINCE).known(SINCE, {})

"""A start at a time of day follows the clock that people see, however it is set."""

import time
from datetime import datetime

import pytest

from teleop.core.errors import DeviceError
from teleop.sequence.triggers.time_of_day import ClockTrigger


class Wall:
    """A wall clock that a test sets."""

    def __init__(self, text: str) -> None:
        self.now = datetime.fromisoformat(text).timestamp()

    def __call__(self) -> float:
        return self.now


@pytest.fixture
def berlin(monkeypatch):
    monkeypatch.setenv("TZ", "Europe/Berlin")
    time.tzset()
    yield
    monkeypatch.undo()
    time.tzset()


def test_a_time_of_day_fires_when_the_wall_clock_is_there_and_counts_down():
    wall = Wall("2026-11-25T18:29:00")
    trigger = ClockTrigger("18:30:00", wall)
    trigger.arm(0.0)
    assert trigger.waits_for(0.0) == "18:30:00, in 1 min"
    wall.now += 59.98
    assert not trigger.fired(0.0)
    wall.now += 0.02
    assert trigger.fired(0.0)
    assert not trigger.again


def test_a_time_that_is_past_is_tomorrows_and_it_says_so():
    wall = Wall("2026-12-31T18:30:00")
    assert ClockTrigger("18:30", wall).waits_for(0.0) == "18:30:00 tomorrow, in 24 h"
    assert ClockTrigger("06:15:30", wall).waits_for(0.0) == "06:15:30 tomorrow, in 11 h 45 min 30 s"


def test_a_time_that_passes_before_the_rig_is_in_place_is_no_start():
    wall = Wall("2026-11-25T18:29:58")
    trigger = ClockTrigger("18:30", wall)
    wall.now += 5
    with pytest.raises(DeviceError, match=r"18:30:00 was 3\.0 s before the rig reached the start"):
        trigger.arm(0.0)


def test_a_clock_that_is_set_decides():
    wall = Wall("2026-11-25T12:00:00")
    trigger = ClockTrigger("18:30", wall)
    trigger.arm(0.0)
    wall.now += 7 * 3600
    assert trigger.fired(0.0)
    wall.now -= 4 * 3600
    assert not trigger.fired(0.0)


def test_summer_time_begins_and_ends(berlin):
    wall = Wall("2026-03-28T23:00:00")
    assert ClockTrigger("02:30", wall).waits_for(0.0) == "02:30:00 tomorrow, in 3 h 30 min"  # at 3:30 of that day
    assert ClockTrigger("08:00", wall).waits_for(0.0) == "08:00:00 tomorrow, in 8 h"
    wall = Wall("2026-10-24T23:00:00")
    assert ClockTrigger("02:30", wall).waits_for(0.0) == "02:30:00 tomorrow, in 3 h 30 min"  # the first of two
    assert ClockTrigger("08:00", wall).waits_for(0.0) == "08:00:00 tomorrow, in 10 h"


def test_a_clock_that_is_set_back_waits_for_the_next_time_from_there():
    """It was wrong by two hours: the time that had seemed to be past is still to come today."""
    wall = Wall("2026-11-25T19:00:00")
    trigger = ClockTrigger("18:30", wall)
    assert trigger.waits_for(0.0) == "18:30:00 tomorrow, in 23 h 30 min"
    trigger.arm(0.0)
    wall.now -= 2 * 3600
    assert trigger.waits_for(0.0) == "18:30:00, in 1 h 30 min"
    assert not trigger.fired(0.0)
    wall.now += 1.5 * 3600
    assert trigger.fired(0.0)


def test_a_clock_that_is_set_forward_before_the_rig_is_in_place_starts_it_there():
    wall, clock = Wall("2026-11-25T12:00:00"), [100.0]
    trigger = ClockTrigger("18:30", wall, lambda: clock[0])
    clock[0] += 5
    wall.now += 5 + 7 * 3600
    trigger.arm(clock[0])
    assert trigger.fired(clock[0])


def test_a_rig_that_is_late_by_the_clock_that_runs_is_no_start():
    wall, clock = Wall("2026-11-25T18:29:58"), [100.0]
    trigger = ClockTrigger("18:30", wall, lambda: clock[0])
    clock[0] += 5
    wall.now += 5
    with pytest.raises(DeviceError, match=r"18:30:00 was 3\.0 s before the rig reached the start"):
        trigger.arm(clock[0])


def test_a_time_that_there_is_twice_in_a_night_counts_both_times(berlin):
    first = datetime(2026, 10, 25, 2, 40, fold=0).timestamp()
    wall = Wall("2026-10-25T00:00:00")
    wall.now = first
    trigger = ClockTrigger("02:30", wall)
    assert trigger.waits_for(0.0) == "02:30:00, in 50 min"
    trigger.arm(0.0)
    wall.now = datetime(2026, 10, 25, 2, 29, 59, fold=1).timestamp()
    assert not trigger.fired(0.0)
    wall.now += 1
    assert trigger.fired(0.0)
    wall.now += 60
    assert ClockTrigger("02:30", wall).waits_for(0.0) == "02:30:00 tomorrow, in 23 h 59 min"


def test_a_clock_that_is_set_back_into_the_hour_before_waits_for_the_first_of_two(berlin):
    wall = Wall("2026-10-25T03:30:00")
    trigger = ClockTrigger("02:30", wall)
    wall.now = datetime(2026, 10, 25, 2, 10, fold=0).timestamp()
    assert trigger.waits_for(0.0) == "02:30:00, in 20 min"

"""When frames are due: a formula that agrees with adding the intervals up."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from teleop.timelapse.schedule import Schedule

schedules = st.builds(Schedule, st.floats(0.5, 100), st.floats(0.5, 100), st.integers(1, 300))


@given(schedules)
def test_a_frame_is_due_when_the_intervals_before_it_are_over(schedule: Schedule) -> None:
    total = 0.0
    for frame in range(schedule.frames):
        assert schedule.at(frame) == pytest.approx(total)
        total += schedule.interval(frame)


@given(schedules)
def test_the_first_and_the_last_interval_are_those_given(schedule: Schedule) -> None:
    assert schedule.interval(0) == schedule.first
    if schedule.frames > 2:
        assert schedule.interval(schedule.frames - 2) == pytest.approx(schedule.last)


@given(schedules, st.floats(0.1, 10))
def test_scaled_by_a_factor_everything_is_due_later_by_it(schedule: Schedule, factor: float) -> None:
    last = schedule.frames - 1
    assert schedule.scaled(factor).at(last) == pytest.approx(factor * schedule.at(last))


def test_frames_per_second_are_the_derivative_of_the_schedule() -> None:
    schedule = Schedule(2.0, 10.0, 100)
    for frame in (1.0, 40.0, 90.0):
        step = 1e-4
        slowness = (schedule.at(frame + step) - schedule.at(frame - step)) / (2 * step)
        speed, change = schedule.speed(frame)
        assert speed == pytest.approx(1 / slowness, rel=1e-6)
        later = schedule.speed(frame + step)[0]
        assert change == pytest.approx((later - speed) / (schedule.at(frame + step) - schedule.at(frame)), rel=1e-3)

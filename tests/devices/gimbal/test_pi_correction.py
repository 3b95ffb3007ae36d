"""Feed-forward and correction: against a simple axis with lag, and what an old or absent reading does."""

from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from teleop.core.axes import Axis, Limits, Reading, State
from teleop.core.events import Tick
from teleop.core.setpoints import Stop
from teleop.devices.gimbal.pi_correction import DEAD_BAND, FRESH, MAX_ERROR, MAX_INTEGRAL, Gains, PiCorrection

LIMITS = {Axis.PAN: Limits(-180, 180, 60, 120, 600)}


def tick(now: float, state: State, reading: Reading | None) -> Tick:
    return Tick(now, {Axis.PAN: state}, {}, (), {} if reading is None else {Axis.PAN: reading})


def speed(correction: PiCorrection, now: float, state: State, reading: Reading | None) -> float:
    each = tick(now, state, reading)
    correction.note(each)
    return correction.speeds(each)[Axis.PAN]


def test_without_a_fresh_reading_it_is_feed_forward_alone() -> None:
    correction = PiCorrection(LIMITS, 0.05)
    assert speed(correction, 1.0, State(0, 10, 20), None) == pytest.approx(11)
    assert speed(correction, 2.0, State(0, 10, 0), Reading(50.0, 2.0 - FRESH - 0.01)) == 10


def test_an_error_is_worked_against_but_not_within_the_grid() -> None:
    for measured, answer in ((1.0, -3.0), (-1.0, 3.0), (DEAD_BAND * 0.9, 0.0)):
        correction = PiCorrection(LIMITS, 0.0, Gains(3.0, 0.0))
        assert speed(correction, 1.0, State(0, 0, 0), Reading(measured, 1.0)) == 0
        assert speed(correction, 1.05, State(0, 0, 0), Reading(measured, 1.05)) == pytest.approx(answer)


@given(st.lists(st.tuples(st.floats(-400, 400), st.sampled_from([0.01, 0.02, 0.1])), min_size=1, max_size=50))
def test_whatever_is_measured_the_speed_never_jumps(readings: list[tuple[float, float]]) -> None:
    correction, now, before = PiCorrection(LIMITS, 0.05), 1.0, 0.0
    for measured, passed in readings:
        now += passed
        after = speed(correction, now, State(0, 0, 0), Reading(measured, now))
        assert abs(after - before) <= LIMITS[Axis.PAN].acceleration * passed + 1e-9
        assert abs(after) <= 3 * MAX_ERROR + MAX_INTEGRAL
        before = after


def test_it_fades_when_the_axis_is_told_to_halt() -> None:
    correction, now, speeds = PiCorrection(LIMITS, 0.0), 1.0, []
    while now < 2.0:
        now += 0.02
        demand = {Axis.PAN: Stop()} if now > 1.5 else {}
        each = Tick(now, {Axis.PAN: State(0)}, demand, (), {Axis.PAN: Reading(4.0, now)})
        correction.note(each)
        speeds.append(correction.speeds(each)[Axis.PAN])
    assert min(speeds) < -12
    assert speeds[-1] == 0
    assert max(abs(after - before) for before, after in pairwise(speeds)) <= 120 * 0.02 + 1e-9


def test_gains_of_zero_correct_nothing() -> None:
    correction = PiCorrection(LIMITS, 0.0, Gains(0.0, 0.0))
    for now in (1.0, 1.1, 1.2):
        assert speed(correction, now, State(0, 7, 0), Reading(3.0, now)) == 7


def test_the_error_is_taken_where_the_reading_was() -> None:
    correction = PiCorrection(LIMITS, 0.0)
    for number in range(10):
        now = 1 + number / 100
        reading = Reading(30 * (now - 0.04), now - 0.04)  # old, and exactly on course
        assert speed(correction, now, State(30 * now, 30, 0), reading) == pytest.approx(30)


def test_an_axis_held_by_hand_winds_up_no_lunge() -> None:
    correction, now = PiCorrection(LIMITS, 0.0), 0.0
    while now < 60:
        now += 0.04
        assert speed(correction, now, State(20, 0, 0), Reading(0.0, now)) <= 3 * MAX_ERROR + MAX_INTEGRAL
    speeds = [speed(correction, now + k / 25, State(20, 0, 0), Reading(20.0, now + k / 25)) for k in range(1, 6)]
    assert speeds == sorted(speeds, reverse=True)
    assert speeds[-1] <= MAX_INTEGRAL


def test_a_steady_disturbance_is_corrected_to_the_grid() -> None:
    correction, position, now = PiCorrection(LIMITS, 0.0), 0.0, 0.0
    for _ in range(1000):
        now += 0.02
        command = speed(correction, now, State(5.0, 0, 0), Reading(round(position, 1), now))
        position += 0.02 * (command - 1.5)  # the head is heavy on one side
    assert position == pytest.approx(5.0, abs=0.2)


def lagging(correction: PiCorrection, acceleration: float, place: float = 0.0, velocity: float = 10.0) -> float:
    """What is left of a correction at once after 2 s in which the axis was a degree behind, 50 times a second."""
    now = 1.0
    while now < 3.0:
        now += 0.02
        each = tick(now, State(place, velocity, acceleration), Reading(place - 1.0, now))
        correction.note(each)
        correction.speeds(each)
    return correction._integrals[Axis.PAN]


def test_the_integral_rests_while_the_plan_accelerates() -> None:
    assert lagging(PiCorrection(LIMITS, 0.0), 60.0) == 0.0
    assert lagging(PiCorrection(LIMITS, 0.0), 0.0) > 3.0


def test_the_integral_rests_where_the_soft_limit_is_near() -> None:
    assert lagging(PiCorrection(LIMITS, 0.0), 0.0, place=179.5) == 0.0
    assert lagging(PiCorrection(LIMITS, 0.0), 0.0, place=179.5, velocity=0.0) > 3.0  # it has to hold its place


def test_the_integral_gives_up_what_was_not_sent() -> None:
    correction, now = PiCorrection(LIMITS, 0.0), 1.0
    lagging(correction, 0.0)
    held = correction._integrals[Axis.PAN]
    for _ in range(50):
        now += 0.02
        correction.sent(3.0 + now, {Axis.PAN: 0.0})
    assert held > 3.0
    assert correction._integrals[Axis.PAN] == 0.0

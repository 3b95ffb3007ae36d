"""The guard stop against a simulation of its own phases and against brute force."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from teleop.core.axes import Axis, Limits, State
from teleop.core.guard_stop import (
    brake_reach,
    brake_state,
    braked,
    inevitable_velocity,
    longest_stop,
    stop_phases,
    stop_reach,
    stop_state,
)

A, J = 120.0, 600.0
velocities = st.floats(-60, 60)
accelerations = st.floats(-A, A)


def duration(velocity, acceleration):
    return sum(seconds for seconds, _ in stop_phases(velocity, acceleration, A, J))


@given(velocities, accelerations)
def test_the_stop_ends_at_rest_and_keeps_acceleration_and_jerk(velocity, acceleration):
    whole = duration(velocity, acceleration)
    state = State(3.0, velocity, acceleration)
    last = acceleration
    for i in range(1, 201):
        now = stop_state(state, A, J, whole * i / 200)
        assert abs(now.acceleration) <= A + 1e-9
        assert abs(now.acceleration - last) <= J * whole / 200 + 1e-9
        last = now.acceleration
    before = stop_state(state, A, J, whole * (1 - 1e-9))
    assert before.velocity == pytest.approx(0, abs=1e-5)
    after = stop_state(state, A, J, whole + 1)
    assert after[1:] == (0.0, 0.0)
    assert after.position == pytest.approx(before.position, abs=1e-6)


@given(velocities, accelerations)
def test_the_reach_is_the_range_of_positions_on_the_way(velocity, acceleration):
    low, high = stop_reach(velocity, acceleration, A, J)
    whole = duration(velocity, acceleration)
    on_the_way = [stop_state(State(0.0, velocity, acceleration), A, J, whole * i / 400).position for i in range(401)]
    assert min(on_the_way) >= low - 1e-9
    assert max(on_the_way) <= high + 1e-9
    step = (60 + A * whole) * whole / 400  # what the samples can miss of an extreme
    assert min(on_the_way) <= low + step
    assert max(on_the_way) >= high - step


@given(velocities, accelerations, st.floats(0, 1))
def test_stopping_in_two_parts_is_stopping_in_one(velocity, acceleration, share):
    whole = duration(velocity, acceleration)
    middle = stop_state(State(0.0, velocity, acceleration), A, J, whole * share)
    assert duration(middle.velocity, middle.acceleration) == pytest.approx(whole * (1 - share), abs=1e-5)


def test_the_three_phases_of_a_long_stop():
    # 60 deg/s at 120 deg/s2 and 600 deg/s3: 0.2 s to full braking, 0.3 s of it, 0.2 s out
    seconds, jerks = zip(*stop_phases(60.0, 0.0, A, J), strict=True)
    assert seconds == pytest.approx((0.2, 0.3, 0.2))
    assert jerks == (-J, 0.0, J)
    assert stop_reach(60.0, 0.0, A, J) == pytest.approx((0.0, 21.0))


def test_an_acceleration_beyond_its_limit_is_brought_back():
    state = stop_state(State(0.0, 60.0, -200.0), A, J, 0.1)
    assert state.acceleration == pytest.approx(-140)


def test_rest_is_left_alone():
    assert stop_reach(0.0, 0.0, A, J) == (0.0, 0.0)
    assert stop_state(State(1.25), A, J, 0.01) == State(1.25, 0.0, 0.0)


@given(velocities, accelerations)
def test_inevitable_velocity_is_what_remains_at_zero_acceleration(velocity, acceleration):
    t = abs(acceleration) / J
    assert inevitable_velocity(velocity, acceleration, J) == pytest.approx(velocity + acceleration * t / 2)


@given(velocities, accelerations)
def test_no_braking_goes_less_far_than_the_hardest(velocity, acceleration):
    reach = brake_reach(velocity, acceleration, A, J)
    assert reach <= stop_reach(velocity, acceleration, A, J)[1] + 1e-9
    if velocity > 0:
        start = State(0.0, velocity, acceleration)
        on_the_way = [brake_state(start, 1, A, J, i / 400) for i in range(601)]
        assert max(state.position for state in on_the_way) == pytest.approx(reach, abs=(60 + A) / 400)
        assert max(state.position for state in on_the_way) <= reach + 1e-9
        assert min(state.acceleration for state in on_the_way) >= -A - 1e-9


def test_every_axis_brakes_by_its_own_limits_and_the_slowest_sets_the_time():
    limits = {Axis.PAN: Limits(-180, 180, 60, 120, 600), Axis.TILT: Limits(-50, 50, 60, 30, 150)}
    motion = {Axis.PAN: State(0.0, 30.0), Axis.TILT: State(0.0, 30.0)}
    longest = longest_stop(motion, limits)
    assert longest == pytest.approx(sum(seconds for seconds, _ in stop_phases(30.0, 0.0, 30, 150)))
    before = braked(motion, limits, 0.9 * longest)
    assert before[Axis.PAN].velocity == 0
    assert before[Axis.TILT].velocity > 0
    assert all(state[1:] == (0, 0) for state in braked(motion, limits, longest + 1e-6).values())


def test_an_axis_in_a_state_without_numbers_does_not_count_for_the_time():
    limits = {Axis.PAN: Limits(-180, 180, 60, 120, 600), Axis.TILT: Limits(-50, 50, 60, 30, 150)}
    assert longest_stop({Axis.PAN: State(0.0, 0.0), Axis.TILT: State(math.nan, math.nan)}, limits) == 0.0

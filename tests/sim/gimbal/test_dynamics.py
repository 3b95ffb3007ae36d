"""How a simulated axis moves: lag, dead time, gain, drift, a second-order mode, backlash; exact at any moment."""

from __future__ import annotations

import math
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from teleop.sim.gimbal.dynamics import Dynamics
from teleop.sim.gimbal.motors import Motor

HOLD = 0.5
STEP = 1e-4  # s, of the integrations that know nothing of closed forms


def motor(*, low: float = -180.0, high: float = 180.0, **dynamics: Any) -> Motor:
    made = Motor(0.0, 0.05, low, high)
    made.dynamics = Dynamics(**dynamics)
    return made


def test_a_speed_comes_after_the_dead_time_through_the_lag_times_the_gain_with_the_drift() -> None:
    axis = motor(lag=0.1, dead_time=0.08, gain=0.9, drift=0.5)
    axis.cruise(1.0, 20.0, 1.0 + HOLD)
    assert axis.at(1.08) == (0.0, 0.0)
    for later in (0.02, 0.2, 0.45):
        speed = 18.5 * (1.0 - math.exp(-later / 0.1))
        position = 18.5 * (later - 0.1 * (1.0 - math.exp(-later / 0.1)))
        assert axis.at(1.08 + later) == pytest.approx((position, speed), abs=1e-9)
    assert axis.at(9.0) == pytest.approx((18.5 * HOLD, 0.0), abs=1e-9), "the speed counts for 0.5 s, drift and all"


def test_a_speed_of_zero_drifts_as_long_as_it_is_in_force() -> None:
    axis = motor(drift=-0.5)
    axis.cruise(0.0, 0.0, HOLD)
    assert axis.at(9.0)[0] == pytest.approx(-0.25, abs=1e-9)


def test_without_a_lag_a_speed_is_there_at_once() -> None:
    axis = motor(lag=0.0)
    axis.cruise(0.0, 30.0, HOLD)
    assert axis.at(0.25) == (7.5, 30.0)
    assert axis.at(0.6) == (15.0, 0.0)


def test_commands_within_the_dead_time_are_carried_out_one_after_the_other() -> None:
    axis, prompt = motor(dead_time=0.1), motor()
    for count in range(5):
        axis.cruise(count * 0.02, 10.0 * count, count * 0.02 + HOLD)
        prompt.cruise(count * 0.02, 10.0 * count, count * 0.02 + HOLD)
        assert axis.at(count * 0.02) == (0.0, 0.0)
    for time in (0.09, 0.2, 0.7, 3.0):
        assert axis.at(time + 0.1) == pytest.approx(prompt.at(time), abs=1e-9)


def test_a_position_is_exact_but_for_the_dead_time() -> None:
    axis, plain = motor(lag=0.2, dead_time=0.05, gain=0.85, drift=1.0), motor()
    axis.travel(0.0, 8.0, 0.1)
    plain.travel(0.0, 8.0, 0.1)
    assert axis.at(0.1) == pytest.approx((4.0, 80.0))
    for time in (0.05, 0.1, 5.0):
        assert axis.at(time + 0.05) == pytest.approx(plain.at(time), abs=1e-12)


def test_a_position_has_a_lag_of_its_own() -> None:
    axis = motor(position_lag=0.1)
    axis.travel(0.0, 20.0, 1.0)
    assert axis.at(0.9)[0] == pytest.approx(18.0 - 2.0 * (1.0 - math.exp(-9.0)), abs=1e-9)
    axis.travel(0.5, 30.0, 1.0)
    assert axis.at(1.4)[0] == pytest.approx(28.0 - 2.0, abs=1e-3), "it goes on from what it lagged behind"
    assert axis.at(9.0)[0] == pytest.approx(30.0, abs=1e-9)


@settings(max_examples=10)
@given(st.floats(0.8, 8.0), st.floats(0.05, 0.95), st.floats(0.02, 0.2), st.floats(-60, 60), st.floats(-60, 60))
def test_the_second_order_mode_is_that_of_an_integration(
    frequency: float, damping: float, lag: float, first: float, second: float
) -> None:
    axis = motor(lag=lag, natural_frequency=frequency, damping=damping)
    axis.cruise(0.0, first, HOLD)
    w = 2 * math.pi * frequency
    drive = speed = position = velocity = 0.0
    for count in range(8000):
        now = count * STEP
        if count == 3000:
            axis.cruise(now, second, now + HOLD)
        target = first if count < 3000 else second
        middle = drive + STEP / 2 * (target + (speed - target) * math.exp(-STEP / 2 / lag))
        speed = target + (speed - target) * math.exp(-STEP / lag)
        drive = drive + STEP * (target + (speed - target) * math.exp(STEP / 2 / lag))
        velocity += STEP * (w * w * (middle - position - STEP / 2 * velocity) - 2 * damping * w * velocity)
        position += STEP * velocity
        if count % 500 == 499:
            assert axis.at(now + STEP)[0] == pytest.approx(position, abs=0.02)


def test_backlash_is_the_play_of_the_shaft() -> None:
    plain, loose = motor(natural_frequency=2.5, damping=0.2), motor(natural_frequency=2.5, damping=0.2, backlash=1.0)
    for axis in (plain, loose):
        axis.cruise(0.0, 20.0, HOLD)
    load = apart = 0.0
    for count in range(8000):
        time = count * 5 * STEP
        if count in (800, 1800):
            for axis in (plain, loose):
                axis.cruise(time, -15.0 if count == 800 else 0.0, time + HOLD)
        shaft = plain.at(time)[0]
        load = min(max(load, shaft - 0.5), shaft + 0.5)
        apart = max(apart, shaft - load)
        if count % 40 == 0:
            assert loose.at(time)[0] == pytest.approx(load, abs=1e-4)
    assert apart == 0.5


wild = st.builds(
    Dynamics,
    lag=st.sampled_from([0.0, 0.05, 0.2]),
    dead_time=st.sampled_from([0.0, 0.03, 0.1]),
    gain=st.floats(0.85, 1.1),
    drift=st.floats(-1, 1),
    position_lag=st.sampled_from([0.0, 0.07]),
    natural_frequency=st.sampled_from([0.0, 1.0, 6.0]),
    damping=st.floats(0.02, 0.9),
    backlash=st.sampled_from([0.0, 0.5]),
)
commands = st.one_of(
    st.tuples(st.just("cruise"), st.floats(-360, 360)),
    st.tuples(st.just("travel"), st.floats(-200, 200)),
    st.tuples(st.just("ease"), st.floats(-200, 200)),
    st.tuples(st.just("coast"), st.none()),
    st.tuples(st.just("halt"), st.none()),
)
scripts = st.lists(st.tuples(st.floats(0.0, 1.0), wild, commands), min_size=1, max_size=5)


def give(axis: Motor, now: float, command: tuple[str, Any]) -> None:
    match command:
        case ("cruise", velocity):
            axis.cruise(now, velocity, now + HOLD)
        case ("travel", target):
            axis.travel(now, target, 0.4)
        case ("ease", target):
            axis.ease(now, target, 0.3)
        case ("coast", _):
            axis.coast(now)
        case ("halt", _):
            axis.halt(now)


@settings(max_examples=15)
@given(scripts)
def test_a_look_changes_nothing_the_stops_hold_and_nothing_leaps(script: list[Any]) -> None:
    watched, left_alone = motor(low=-30.0, high=45.0), motor(low=-30.0, high=45.0)
    now = 0.0
    for wait, dynamics, command in script:
        before = watched.at(now)[0]
        for axis in (watched, left_alone):
            axis.dynamics = dynamics
            give(axis, now, command)
        assert watched.at(now)[0] == pytest.approx(before, abs=1e-7)
        for count in range(50):
            position = watched.at(now + wait * count / 50)[0]
            assert -30.0 - 1e-9 <= position <= 45.0 + 1e-9
        now += wait
    for later in (0.0, 0.3, 4.0, 900.0):
        assert watched.at(now + later) == left_alone.at(now + later)
    assert watched.at(now + 900.0)[1] == pytest.approx(0.0, abs=1e-9)


def test_a_swing_at_a_stop_comes_to_rest_inside() -> None:
    axis = motor(natural_frequency=1.0, damping=0.05, low=-10.0, high=10.0)
    axis.travel(0.0, 9.5, 0.1)
    positions = [axis.at(count / 100)[0] for count in range(3000)]
    assert 9.999 < max(positions) <= 10.0 + 1e-9
    assert min(positions[50:]) < 9.1, "it swings back from the stop"
    assert positions[-1] == pytest.approx(9.5, abs=1e-3)


def test_other_dynamics_take_effect_with_the_next_command() -> None:
    axis = motor()
    axis.cruise(0.0, 10.0, HOLD)
    axis.dynamics = Dynamics(lag=0.0, gain=0.5)
    assert axis.at(0.4)[1] == pytest.approx(10.0, abs=0.01)
    axis.cruise(0.4, 10.0, 0.4 + HOLD)
    assert axis.at(0.5)[1] == 5.0

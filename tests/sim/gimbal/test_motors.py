import math
from itertools import pairwise

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from teleop.sim.gimbal.motors import SETTLED, Motor

LAG = 0.05
HOLD = 0.5

speeds = st.floats(-360, 360)
durations = st.floats(0.01, 3.0)
commands = st.one_of(
    st.tuples(st.just("cruise"), speeds),
    st.tuples(st.just("travel"), st.floats(-200, 200), durations),
    st.tuples(st.just("ease"), st.floats(-200, 200)),
    st.tuples(st.just("coast")),
    st.tuples(st.just("halt")),
)
scripts = st.lists(st.tuples(st.floats(0.0, 1.5), commands), max_size=8)


def give(motor: Motor, now: float, command: tuple) -> None:
    match command:
        case ("cruise", velocity):
            motor.cruise(now, velocity, now + HOLD)
        case ("travel", target, duration):
            motor.travel(now, target, duration)
        case ("ease", target):
            motor.ease(now, target, 0.3)
        case ("coast",):
            motor.coast(now)
        case ("halt",):
            motor.halt(now)


@given(scripts, st.lists(st.floats(0.0, 15.0), max_size=30))
def test_reading_a_motor_changes_nothing(script: list, looks: list[float]) -> None:
    watched, left_alone = Motor(10.0, LAG, -180.0, 180.0), Motor(10.0, LAG, -180.0, 180.0)
    now = 0.0
    for wait, command in script:
        for look in sorted(look for look in looks if now <= look <= now + wait):
            watched.at(look)
        now += wait
        give(watched, now, command)
        give(left_alone, now, command)
    assert watched.at(now + 7.0) == left_alone.at(now + 7.0)


@given(scripts)
def test_a_motor_stays_between_its_stops_and_never_jumps(script: list) -> None:
    motor = Motor(0.0, LAG, -30.0, 45.0)
    now = 0.0
    for wait, command in [*script, (2.0, ("halt",))]:
        times = [now + wait * step / 200 for step in range(201)]
        positions = [motor.at(time)[0] for time in times]
        assert min(positions) >= -30.0 - 1e-9
        assert max(positions) <= 45.0 + 1e-9
        fastest = max(360.0, 75.0 / 0.01, 75.0 / 0.3)
        for before, after in pairwise(positions):
            assert abs(after - before) <= fastest * wait / 200 + 1e-9
        now += wait
        before = motor.at(now)[0]
        give(motor, now, command)
        assert motor.at(now)[0] == pytest.approx(before, abs=1e-9)


@settings(max_examples=40)
@given(st.floats(-1, 1), st.floats(-300, 300), st.floats(-300, 300), st.floats(0.02, 0.2), st.floats(5, 60))
def test_cruising_is_the_first_order_lag_with_stops(
    share: float, first: float, second: float, lag: float, reach: float
) -> None:
    """Against an integration in small steps, which knows nothing of closed forms."""
    motor = Motor(share * reach, lag, -reach, reach)
    here, speed, step, turn = share * reach, 0.0, 1e-3, 300
    tolerance = step * max(abs(first), abs(second)) + 1e-3  # the integration sees a stop up to one step late
    for index in range(1200):
        now = index * step
        if index in (0, turn):
            motor.cruise(now, first if index == 0 else second, now + HOLD)
        wanted = first if index < turn else second if index < turn + round(HOLD / step) else 0.0
        before = speed
        speed = wanted + (speed - wanted) * math.exp(-step / lag)
        here += (before + speed) / 2 * step
        if not -reach <= here <= reach:
            here, speed = math.copysign(reach, here), 0.0
        if index % 20 == 0:
            assert motor.at(now + step)[0] == pytest.approx(here, abs=tolerance)


@given(st.floats(0.02, 0.2), speeds)
def test_a_speed_that_is_not_repeated_expires_and_the_motor_comes_to_rest(lag: float, velocity: float) -> None:
    motor = Motor(0.0, lag)
    motor.cruise(0.0, velocity, HOLD)
    assert motor.at(HOLD)[1] == pytest.approx(velocity * (1 - math.exp(-HOLD / lag)), abs=1e-9)
    assert motor.at(HOLD + lag)[1] == pytest.approx(motor.at(HOLD)[1] / math.e, abs=1e-9)
    assert motor.at(HOLD + 2 * SETTLED * lag)[1] == pytest.approx(0.0, abs=1e-20)
    assert motor.at(21_600.0) == (motor.at(7200.0)[0], 0.0)


def test_travelling_is_constant_speed_and_ends_exactly() -> None:
    motor = Motor(10.0, LAG)
    motor.travel(5.0, -20.0, 2.0)
    assert [motor.at(time) for time in (5.0, 6.0, 7.0, 8.0)] == [
        (10.0, -15.0),
        (-5.0, -15.0),
        (-20.0, 0.0),
        (-20.0, 0.0),
    ]


def test_a_target_beyond_a_stop_ends_at_the_stop_in_the_same_time() -> None:
    motor = Motor(0.0, LAG, -10.0, 10.0)
    motor.travel(0.0, 40.0, 2.0)
    assert motor.at(1.0) == (5.0, 5.0)
    assert motor.at(2.0) == (10.0, 0.0)


def test_easing_slows_down_and_ends_exactly() -> None:
    motor = Motor(90.0, LAG)
    motor.ease(0.0, 0.0, 0.3)
    positions = [motor.at(time / 10)[0] for time in range(16)]
    steps = [before - after for before, after in pairwise(positions)]
    assert steps == sorted(steps, reverse=True)
    assert positions[-1] < 1.0
    assert motor.at(30.0) == (0.0, 0.0)


def test_a_motor_at_its_stop_stands_still_until_it_is_driven_back() -> None:
    motor = Motor(0.0, LAG, -10.0, 10.0)
    motor.cruise(0.0, 100.0, HOLD)
    assert motor.at(0.4) == (10.0, 0.0)
    motor.cruise(0.4, 50.0, 0.4 + HOLD)
    assert motor.at(0.6) == (10.0, 0.0)
    motor.cruise(0.6, -10.0, 0.6 + HOLD)
    assert motor.at(0.7)[0] < 10.0


def test_a_motor_that_reverses_late_touches_the_stop_and_leaves_it() -> None:
    motor = Motor(0.0, 0.2, -10.0, 10.0)
    motor.cruise(0.0, 100.0, HOLD)
    before = motor.at(0.22)[0]
    motor.cruise(0.22, -100.0, 0.22 + HOLD)
    positions = [motor.at(0.22 + step / 1000)[0] for step in range(500)]
    assert before < 10.0
    assert max(positions) == pytest.approx(10.0, abs=0.03)  # it is there for an instant, seen to a millisecond
    assert positions[-1] == -10.0


def test_a_motor_beyond_a_stop_that_was_moved_can_only_come_back() -> None:
    motor = Motor(50.0, LAG, -180.0, 180.0)
    motor.maximum = 20.0
    motor.cruise(0.0, 60.0, HOLD)
    assert motor.at(0.4) == (50.0, 0.0)
    motor.cruise(1.0, -60.0, 1.0 + HOLD)
    assert motor.at(1.4)[0] < 45.0


def test_stops_without_room_hold_the_motor() -> None:
    motor = Motor(0.0, LAG, 0.0, 0.0)
    for velocity in (100.0, -100.0, 0.0):
        motor.cruise(0.0, velocity, HOLD)
        assert motor.at(0.3) == (0.0, 0.0)

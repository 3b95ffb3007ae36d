"""A move and its trim together keep the axis' limits; the offset is held, released or written back."""

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from teleop.motion import Axis, Cruise, Follow, Limits, State
from teleop.planner.keyframes import Key, plan
from teleop.planner.live import Live
from teleop.planner.trim import Trim, sequence_limits, trim_limits, trimmed, written_back

PAN, TILT = Axis.PAN, Axis.TILT
LIMITS = {PAN: Limits(-170, 170, 60, 120, 600), TILT: Limits(-30, 40, 40, 90, 480)}
KEYS = {
    PAN: [Key(0, 0), Key(2, 40), Key(4, 80, hold=1), Key(9, -30)],
    TILT: [Key(0, 0), Key(3, 35), Key(9, -20)],
}
DT = 0.01


@pytest.fixture(scope="module")
def move():
    return plan(KEYS, sequence_limits(LIMITS))


def test_the_trim_gets_what_the_sequence_leaves(move):
    left = trim_limits(move, LIMITS)
    assert left[PAN].velocity == pytest.approx(15)
    assert (left[PAN].minimum, left[PAN].maximum) == pytest.approx((-140, 90), abs=1e-6)
    assert (left[TILT].minimum, left[TILT].maximum) == pytest.approx((-10, 5), abs=1e-6)


sticks = st.lists(
    st.tuples(st.sampled_from([0, 20, 200]), st.floats(-100, 100), st.floats(-100, 100), st.booleans()), max_size=8
)


@settings(max_examples=20, deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(sticks)
def test_the_sum_keeps_every_limit_and_is_followed_exactly(move, phases):
    trim, live = Trim(move, LIMITS, DT), Live(LIMITS, DT)
    live.reset(move.start)
    tick = 0
    for ticks, pan, tilt, release in phases:
        if release:
            trim.release()
        for _ in range(ticks):
            tick += 1
            offsets = trim.step({} if release else {PAN: Cruise(pan), TILT: Cruise(tilt)})
            wanted = trimmed(move.at(tick * DT), offsets)
            before = live.motion
            after = live.step({axis: Follow(*state) for axis, state in wanted.items()})
            for axis, limits in LIMITS.items():
                assert after[axis] == pytest.approx(wanted[axis], abs=1e-6)
                assert limits.minimum - 1e-6 <= after[axis].position <= limits.maximum + 1e-6
                assert abs(after[axis].velocity) <= limits.velocity + 1e-6
                assert abs(after[axis].acceleration) <= limits.acceleration + 1e-6
                assert abs(after[axis].acceleration - before[axis].acceleration) / DT <= limits.jerk + 1e-6


def test_an_offset_is_held_then_released_smoothly_to_nothing(move):
    trim = Trim(move, LIMITS, DT)
    for _ in range(200):
        trim.step({PAN: Cruise(10.0)})
    for _ in range(100):
        trim.step({})
    held = trim.offsets[PAN]
    assert held.position > 10
    assert held[1:] == (0.0, 0.0)
    trim.release()
    positions = [trim.step({})[PAN].position for _ in range(400)]
    assert positions == sorted(positions, reverse=True)
    assert trim.offsets[PAN] == State(0.0)


def test_a_stick_takes_a_release_over(move):
    trim = Trim(move, LIMITS, DT)
    for _ in range(200):
        trim.step({PAN: Cruise(10.0)})
    trim.release()
    for _ in range(100):
        trim.step({PAN: Cruise(10.0)})
    for _ in range(200):
        trim.step({})
    assert trim.offsets[PAN].position > 20  # held again: the release is over


def test_written_back_the_keys_have_moved_and_nothing_else(move):
    offsets = {PAN: State(5.0)}
    moved = written_back(KEYS, offsets)
    assert [key.position for key in moved[PAN]] == [5, 45, 85, -25]
    assert [key.at for key in moved[PAN]] == [key.at for key in KEYS[PAN]]
    assert moved[TILT] == KEYS[TILT]

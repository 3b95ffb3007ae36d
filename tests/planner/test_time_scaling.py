"""Another pace, the same path, the same limits."""

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from teleop.core.axes import Axis, Limits
from teleop.core.setpoints import StateTarget
from teleop.planner.keyframes.findings import PlanError
from teleop.planner.keyframes.planner import Key, plan
from teleop.planner.live import Live
from teleop.planner.time_scaling import NoRunUp, at_most, change_rate, go_to, run_up, state_at, steady
from teleop.planner.trajectory import Move

PAN, TILT = Axis.PAN, Axis.TILT
LIMITS = {PAN: Limits(-170, 170, 60, 120, 600), TILT: Limits(-30, 40, 40, 90, 480)}
DT = 0.01


@pytest.fixture(scope="module")
def move() -> Move:
    """Planned with the headroom that override needs: V 0.9, A and J 0.8."""
    planned = {
        axis: Limits(s.minimum, s.maximum, 0.9 * s.velocity, 0.8 * s.acceleration, 0.8 * s.jerk)
        for axis, s in LIMITS.items()
    }
    return plan(
        {
            PAN: [Key(0, 0), Key(2, 40), Key(4, 80, hold=1), Key(8, -30), Key(11, 0)],
            TILT: [Key(1, 0), Key(2.5, 20), Key(6, -20), Key(10, 35)],
        },
        planned,
    )


def stream(move, pace, first, last):
    """What Live makes of the warped move, tick by tick, having started on it."""
    live = Live(LIMITS, DT)
    live.reset(state_at(move, pace, first))
    ticks = round((last - first) / DT)
    for tick in range(1, ticks + 1):
        wanted = state_at(move, pace, first + tick * DT)
        before = live.motion
        yield wanted, before, live.step({axis: StateTarget(*state) for axis, state in wanted.items()})


def assert_on_the_path_within_limits(move, pace, first, last):
    for wanted, before, after in stream(move, pace, first, last):
        for axis, limits in LIMITS.items():
            assert after[axis] == pytest.approx(wanted[axis], abs=1e-6)
            assert abs(after[axis].velocity) <= limits.velocity + 1e-6
            assert abs(after[axis].acceleration) <= limits.acceleration + 1e-6
            assert abs(after[axis].acceleration - before[axis].acceleration) / DT <= limits.jerk + 1e-6


def test_at_the_highest_steady_rate_limits_are_just_kept(move):
    most = at_most(move, LIMITS)
    assert 1 < most < 2
    assert_on_the_path_within_limits(move, steady(0.0, most, 0.0), 0.0, move.duration / most)
    peaks = move.peaks()
    used = [
        x
        for axis, limits in LIMITS.items()
        for x in (
            peaks[axis].velocity * most / limits.velocity,
            peaks[axis].acceleration * most**2 / limits.acceleration,
            peaks[axis].jerk * most**3 / limits.jerk,
        )
    ]
    assert max(used) == pytest.approx(0.97)


def test_more_is_refused_and_said_in_advance(move):
    most = at_most(move, LIMITS)
    with pytest.raises(PlanError, match=f"at most {100 * most:.0f} % of its speed, not 300 %"):
        change_rate(move, LIMITS, steady(0.0, 1.0, 0.0), 3.0, 1.0)


@settings(max_examples=25, deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(when=st.floats(0, 10.5), rate=st.sampled_from([0.0, 0.1, 0.5, 1.1, -0.5]))
def test_a_change_of_rate_anywhere_stays_on_the_path_within_limits(move, when, rate):
    before = steady(0.0, 1.0, 0.0)
    after = change_rate(move, LIMITS, before, rate, when)
    assert after.at(when) == pytest.approx(before.at(when))
    assert after.at(when + after.duration)[1] == pytest.approx(rate)
    assert_on_the_path_within_limits(move, after, when, when + after.duration + 0.5)


def test_pause_and_resume_lead_to_the_same_end(move):
    pause = change_rate(move, LIMITS, steady(0.0, 1.0, 0.0), 0.0, 2.0)
    stopped = 2.0 + pause.duration
    assert all(state[1:] == (0.0, 0.0) for state in state_at(move, pause, stopped + 1).values())
    assert state_at(move, pause, stopped + 1) == state_at(move, pause, stopped + 100)
    resume = change_rate(move, LIMITS, pause, 1.0, stopped + 100)
    assert state_at(move, resume, stopped + 200) == move.end


def test_a_change_of_mind_in_the_middle_of_a_change_is_smooth(move):
    pause = change_rate(move, LIMITS, steady(0.0, 1.0, 0.0), 0.0, 2.0)
    middle = 2.0 + pause.duration / 2
    again = change_rate(move, LIMITS, pause, 1.0, middle)
    assert again.at(middle) == pytest.approx(pause.at(middle))
    assert_on_the_path_within_limits(move, again, middle, middle + again.duration + 0.5)


@pytest.mark.parametrize("target", [2.0, 4.5, 10.0])
def test_stepping_to_a_key_follows_the_path_and_rests_there(move, target):
    pause = change_rate(move, LIMITS, steady(0.0, 1.0, 0.0), 0.0, 6.0)
    now = 10.0
    step = go_to(move, LIMITS, pause, target, now)
    assert_on_the_path_within_limits(move, step, now, now + step.duration + 0.2)
    at_rest = state_at(move, step, now + step.duration + 1)
    for axis, state in move.at(target).items():
        assert at_rest[axis].position == pytest.approx(state.position, abs=1e-9)
        assert at_rest[axis][1:] == (0.0, 0.0)


def test_stepping_while_running_is_refused(move):
    with pytest.raises(PlanError, match="pause it"):
        go_to(move, LIMITS, steady(0.0, 1.0, 0.0), 2.0, 5.0)


def test_a_pace_is_its_own_derivative(move):
    pace = change_rate(move, LIMITS, steady(0.0, 1.0, 0.0), 0.2, 2.0)
    clock = np.linspace(2.0, 2.0 + pace.duration, 50)
    step = 1e-6
    for now in clock[1:-1]:
        behind, here, ahead = (pace.at(now + k * step) for k in (-1, 0, 1))
        assert (ahead[0] - behind[0]) / (2 * step) == pytest.approx(here[1], abs=1e-6)
        assert (ahead[1] - behind[1]) / (2 * step) == pytest.approx(here[2], abs=1e-6)


@settings(max_examples=30, deadline=None)
@given(st.floats(0.0, 10.9), st.floats(0.3, 1.0))
def test_a_run_up_from_rest_is_on_the_path_and_at_speed_when_the_time_comes(move, time, rate):
    pace = run_up(move, LIMITS, time, rate)
    assert pace.at(0.0)[1:] == (0.0, 0.0) or pace.duration == 0.0
    assert pace.at(pace.duration) == pytest.approx((time, rate, 0.0), abs=1e-9)
    assert pace.duration * 100 == pytest.approx(round(pace.duration * 100), abs=1e-9)
    assert_on_the_path_within_limits(move, pace, 0.0, pace.duration + 0.3)


def test_a_move_at_rest_needs_no_run_up_and_one_at_its_limits_has_none(move):
    dwelling = plan({PAN: [Key(0, 0), Key(2, 20, hold=2), Key(6, 0)]}, LIMITS)
    assert run_up(dwelling, LIMITS, 3.0, 1.0) == steady(3.0, 1.0, 0.0)
    tight = {axis: Limits(s.minimum, s.maximum, s.velocity * 0.6, 9, 9) for axis, s in LIMITS.items()}
    with pytest.raises(NoRunUp, match="cannot start at 3 s"):
        run_up(move, tight, 3.0, 1.0)

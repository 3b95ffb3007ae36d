"""The stream of samples is the move, each a legal step; a reference out of reach is met without oscillation."""

import math
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from ruckig import InputParameter, Ruckig, Trajectory

from teleop.core.axes import Axis, Limits, State
from teleop.core.setpoints import PositionTarget, Setpoint, StateTarget, Stop, VelocityTarget
from teleop.planner.keyframes.planner import Key, plan
from teleop.planner.keyframes.ramp import Ramp
from teleop.planner.keyframes.repeat import Repeat, repeated
from teleop.planner.live import Live
from teleop.planner.tracking import step_is_legal

PAN, TILT, FOCUS = Axis.PAN, Axis.TILT, Axis.FOCUS
LIMITS = {PAN: Limits(-170, 170, 60, 120, 600), TILT: Limits(-30, 40, 40, 90, 480), FOCUS: Limits(0, 1, 0.8, 3, 20)}
DT = 0.01


@pytest.fixture(scope="module")
def move():
    """Three axes with segments close to their limits, an overshoot, a dwell and a day's slowness on focus."""
    return plan(
        {
            PAN: [Key(0, 0), Key(1.3, 40, overshoot=9), Key(2.6, 60, overshoot=9), Key(4.2, -10, hold=0.5), Key(8, 3)],
            TILT: [Key(0.4, -20), Key(2, 15), Key(4, 14.9), Key(7, -29.9)],
            FOCUS: [Key(0, 0.2), Key(5, 0.2001), Key(8, 1.0)],
        },
        LIMITS,
    )


def follow(move, time) -> dict[Axis, Setpoint]:
    return {axis: StateTarget(*state) for axis, state in move.at(time).items()}


@pytest.mark.parametrize("rate", [25, 50, 100, 333, 1000])
def test_the_stream_equals_the_plan(move, rate):
    live = Live(LIMITS, 1 / rate)
    live.reset(move.start)
    for tick in range(1, math.ceil(8.2 * rate)):
        motion = live.step(follow(move, tick / rate))
        for axis, state in move.at(tick / rate).items():
            assert motion[axis] == pytest.approx(state, abs=1e-6)


def shaped():
    """With ramps, even speed, a turn on a soft limit and a bounce."""
    ramp = Ramp(seconds=0.8)
    keys = {
        PAN: [Key(0, 0, leave=ramp), Key(1.5, 20, tension=0.8), Key(3, 40), Key(5, 60, arrive=ramp), Key(5.5, 60)],
        TILT: [Key(0, 5), Key(2, 40), Key(5.5, 5)],
        FOCUS: [Key(0, 0.2), Key(0.5, 0.21), Key(5.5, 0.9)],
    }
    return plan(repeated(keys, 2, Repeat.BOUNCE), LIMITS)


@pytest.mark.parametrize("dt", [0.04, DT, 0.001])
@pytest.mark.parametrize("shape", ["plain", "shaped"])
def test_ruckig_reaches_every_sample_in_one_step(move, shape, dt):
    """Asked for each sample by itself, where the closed form that the stream is checked by has no say.

    In tenths of a second: in seconds and at 1 ms Ruckig's rounding is as large as its absolute tolerances.
    """
    if shape == "shaped":
        move = shaped()
    units = 0.1 ** np.arange(4)
    ruckig, question, answer = Ruckig(1), InputParameter(1), Trajectory(1)
    for axis, limits in LIMITS.items():
        most = [limits.velocity, limits.acceleration, limits.jerk] * units[1:]
        question.max_velocity, question.max_acceleration, question.max_jerk = ([x] for x in most)
        question.minimum_duration = dt / units[1]
        for tick in range(0, math.ceil(move.duration / dt), max(1, round(0.003 / dt))):
            start, end = (move.at(t * dt)[axis] for t in (tick, tick + 1))
            if start == end:
                continue
            start, end = start * units[:3], end * units[:3]
            question.current_position, question.current_velocity, question.current_acceleration = ([x] for x in start)
            question.target_position, question.target_velocity, question.target_acceleration = ([x] for x in end)
            ruckig.calculate(question, answer)
            assert answer.duration * units[1] <= dt * (1 + 1e-6)
            reached = [x for (x,) in answer.at_time(dt / units[1])[:3]] / units[:3]
            assert reached == pytest.approx(end / units[:3], abs=1e-6)


def test_missed_ticks_lose_nothing_but_the_samples(move):
    live = Live(LIMITS, DT)
    live.reset(move.start)
    tick, motion = 0, live.motion
    for steps in [1, 1, 3, 1, 2, 1] * 60:
        tick += steps
        motion = live.step(follow(move, tick * DT), dt_steps=steps)
    for axis, state in move.at(tick * DT).items():
        assert motion[axis] == pytest.approx(state, abs=1e-6)


def test_a_move_interrupted_by_the_stick_is_joined_again(move):
    live = Live(LIMITS, DT)
    live.reset(move.start)
    off = []
    for tick in range(1, 840):
        demand: dict[Axis, Setpoint] = follow(move, tick * DT)
        if 100 < tick <= 180:
            demand[PAN] = VelocityTarget(-20.0)
        motion = live.step(demand)
        off.append(abs(motion[PAN].position - move.at(tick * DT)[PAN].position))
        assert motion[TILT] == pytest.approx(move.at(tick * DT)[TILT], abs=1e-6)
    assert max(off) > 20
    assert max(off[600:]) < 1e-6  # the move has slowed down to where it can be caught


@pytest.mark.parametrize("target", [-250.0, 250.0])
def test_a_reference_beyond_a_soft_limit_is_waited_for_at_the_limit(target):
    live = Live(LIMITS, DT)
    live.reset({PAN: State(0.0)})
    positions = [live.step({PAN: StateTarget(target, 0.0, 0.0)})[PAN].position for _ in range(800)]
    steps = [abs(b) - abs(a) for a, b in pairwise(positions)]
    assert min(steps) >= -1e-9  # never turns back: no oscillation
    assert abs(positions[-1]) == pytest.approx(170)
    assert live.at_rest


def test_a_reference_faster_than_the_axis_is_chased_at_its_limit():
    live = Live(LIMITS, DT)
    live.reset({PAN: State(-160.0)})
    references = [StateTarget(-160 + 90 * tick * DT, 90.0, 0.0) for tick in range(1, 300)]
    velocities = [live.step({PAN: reference})[PAN].velocity for reference in references]
    assert max(velocities) <= 60 + 1e-6
    assert min(velocities[100:250]) >= 60 - 1e-6


def test_a_jumping_reference_is_caught_without_ringing():
    live = Live(LIMITS, DT)
    live.reset({PAN: State(0.0)})
    positions = [live.step({PAN: StateTarget(30 + 10 * tick * DT, 10.0, 0.0)})[PAN].position for tick in range(1, 400)]
    error = [30 + 10 * (i + 1) * DT - p for i, p in enumerate(positions)]
    assert min(error) > -1e-6  # approaches from below and never passes
    assert error[-1] == pytest.approx(0, abs=1e-6)


def test_from_a_move_to_a_preset_and_back(move):
    live = Live(LIMITS, DT)
    live.reset(move.start)
    motion = live.motion
    for tick in range(1, 1000):
        demand = {axis: PositionTarget(0.5) for axis in LIMITS} if 50 < tick < 300 else follow(move, tick * DT)
        motion = live.step(demand)
    assert motion == move.end


jerks = st.floats(-600, 600)


@given(st.floats(-40, 40), st.floats(-80, 80), st.lists(jerks, min_size=3, max_size=3))
def test_three_spans_of_legal_jerk_are_a_legal_step(velocity, acceleration, spans):
    state = start = State(10.0, velocity, acceleration)
    h = DT / 3
    for jerk in spans:
        p, v, a = state
        state = State(p + h * (v + h * (a / 2 + h * jerk / 6)), v + h * (a + h * jerk / 2), a + h * jerk)
    largest = max(map(abs, spans))
    assert step_is_legal(start, state, DT, (60, 120, largest + 1e-3))
    assert not step_is_legal(start, state, DT, (60, 120, 0.99 * largest - 1e-3))


def turning_on_a_limit():
    """Three keys whose middle one lies exactly on the upper soft limit and is passed, not stopped at."""
    return plan({TILT: [Key(0, 5), Key(2, 40), Key(4, 5)]}, LIMITS)


def test_a_move_may_turn_exactly_on_a_soft_limit():
    move = turning_on_a_limit()
    assert move.at(2)[TILT].acceleration < -10
    live = Live(LIMITS, DT)
    live.reset(move.start)
    for tick in range(1, 420):
        motion = live.step(follow(move, tick * DT))
        assert motion[TILT] == pytest.approx(move.at(tick * DT)[TILT], abs=1e-6)


@pytest.mark.parametrize(
    "wish", [Stop(), VelocityTarget(40.0), VelocityTarget(-40.0), PositionTarget(40.0), StateTarget(41.0, 5.0, 0.0)]
)
@pytest.mark.parametrize("at", [170, 190, 195, 197, 198, 199, 200, 201, 205])
def test_whatever_interrupts_such_a_turn_stays_inside(wish, at):
    move = turning_on_a_limit()
    live = Live(LIMITS, DT)
    live.reset(move.start)
    before = live.motion[TILT]
    for tick in range(1, 500):
        state = live.step(follow(move, tick * DT) if tick <= at else {TILT: wish})[TILT]
        assert state.position <= 40 + 1e-6
        assert abs(state.velocity) <= 40 + 1e-6
        assert abs(state.acceleration) <= 90 + 1e-6
        assert abs(state.acceleration - before.acceleration) / DT <= 480 + 1e-6
        before = state
    assert before.acceleration == 0 or isinstance(wish, VelocityTarget)

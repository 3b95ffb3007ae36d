"""Ruckig's errors stop here, and what it is told in parts is what it would be told at once."""

import math

import pytest

from teleop.motion import State
from teleop.planner.solver import PositionSolver, VelocitySolver

LIMITS = [(120.0, 600.0)]


def test_what_ruckig_refuses_is_none():
    solver = VelocitySolver(1)
    assert solver.step([State(0.0)], [math.nan], LIMITS, 0.01) is None
    assert solver.step([State(0.0)], [1.0], [(120.0, -1.0)], 0.01) is None
    assert PositionSolver().solve([State(0.0)], [State(1.0)], [0.0], [120.0], [600.0]) is None


def test_after_a_refusal_it_goes_on():
    solver, fresh = VelocitySolver(1), VelocitySolver(1)
    states = solver.step([State(0.0)], [10.0], LIMITS, 0.01)
    assert states is not None
    assert solver.step(states, [math.nan], LIMITS, 0.01) is None
    again, expected = solver.step(states, [10.0], LIMITS, 0.01), fresh.step(states, [10.0], LIMITS, 0.01)
    assert again is not None
    assert expected is not None
    assert again[0] == pytest.approx(expected[0], abs=1e-12)


@pytest.mark.parametrize("steps", [[0.01] * 6, [0.01, 0.03, 0.02], [0.06]])
def test_a_state_carried_on_and_one_told_again_agree(steps):
    carried, told = VelocitySolver(1), VelocitySolver(1)
    states = again = [State(3.0, 1.0, 0.0)]
    for seconds in steps:
        states = carried.step(states, [20.0], LIMITS, seconds)
        again = told.step([State(*state) for state in again], [20.0], LIMITS, seconds)
        assert states is not None
        assert again is not None
    assert states[0] == pytest.approx(again[0], abs=1e-9)
    whole = VelocitySolver(1).step([State(3.0, 1.0, 0.0)], [20.0], LIMITS, sum(steps))
    assert whole is not None
    assert states[0] == pytest.approx(whole[0], abs=1e-9)


def test_downward_limits_may_differ():
    solver = PositionSolver()
    question = [State(0.0)], [State(-10.0)], [60.0], [120.0], [600.0]
    fast, slow = solver.solve(*question), solver.solve(*question, lowest_velocity=[-2.0])
    assert fast is not None
    assert slow is not None
    assert slow.duration > 5 > fast.duration

"""Ruckig's errors stop here, and what it is told in parts is what it would be told at once."""

import math

import pytest

from teleop.core.axes import State
from teleop.planner.ruckig_solver import PositionSolver, VelocitySolver

LIMITS = [(120.0, 600.0)]


def placed(*states):
    solver = VelocitySolver(len(states))
    solver.place(states)
    return solver


def stepped(solver, velocity, seconds=0.01):
    """The one axis' state after a step."""
    answer = solver.step([velocity], LIMITS, seconds)
    assert answer is not None
    return State(*(column[0] for column in answer))


def test_what_ruckig_refuses_is_none():
    solver = placed(State(0.0))
    assert solver.step([math.nan], LIMITS, 0.01) is None
    assert solver.step([1.0], [(120.0, -1.0)], 0.01) is None
    assert PositionSolver().solve([State(0.0)], [State(1.0)], [0.0], [120.0], [600.0]) is None


def test_after_a_refusal_it_goes_on_from_where_it_was():
    refused, spared = placed(State(0.0)), placed(State(0.0))
    assert stepped(refused, 10.0) == stepped(spared, 10.0)
    assert refused.step([math.nan], LIMITS, 0.01) is None
    assert stepped(refused, 10.0) == pytest.approx(stepped(spared, 10.0), abs=1e-12)


@pytest.mark.parametrize("steps", [[0.01] * 6, [0.01, 0.03, 0.02], [0.06]])
def test_a_state_carried_on_and_one_told_again_agree(steps):
    carried, told = placed(State(3.0, 1.0, 0.0)), placed(State(3.0, 1.0, 0.0))
    state = again = State(3.0, 1.0, 0.0)
    for seconds in steps:
        state = stepped(carried, 20.0, seconds)
        told.place([again])
        again = stepped(told, 20.0, seconds)
    assert state == pytest.approx(again, abs=1e-9)
    assert state == pytest.approx(stepped(placed(State(3.0, 1.0, 0.0)), 20.0, sum(steps)), abs=1e-9)


def test_downward_limits_may_differ():
    solver = PositionSolver()
    question = [State(0.0)], [State(-10.0)], [60.0], [120.0], [600.0]
    fast, slow = solver.solve(*question), solver.solve(*question, lowest_velocity=[-2.0])
    assert fast is not None
    assert slow is not None
    assert slow.duration > 5 > fast.duration

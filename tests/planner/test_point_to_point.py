"""Presets: to a position and rest, together where they have one arrival time."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from teleop.core.axes import Axis, Limits, State
from teleop.core.setpoints import PositionTarget
from teleop.planner.axis_planner import AxisPlanner
from teleop.planner.point_to_point import LONGEST, PointToPoint, QuinticTrajectory, plan_point_to_point

LIMITS = Limits(-100, 100, 60, 120, 600)


def at(axis: Axis, position: float, velocity: float = 0.0) -> AxisPlanner:
    return AxisPlanner(axis, LIMITS, State(position, velocity))


def end_of(move: PointToPoint) -> State:
    return move.step(move.trajectory.duration + 1)


@given(st.floats(-150, 150), st.floats(-100, 100))
def test_it_ends_at_rest_on_the_target_or_on_the_soft_limit(target: float, start: float) -> None:
    move = plan_point_to_point([(at(Axis.PAN, start), PositionTarget(target))])[Axis.PAN]
    assert end_of(move) == State(min(max(target, -100), 100))


def test_axes_of_one_arrival_time_take_one_trajectory_and_others_their_own() -> None:
    both = [(at(Axis.PAN, 0), PositionTarget(50, 4.0)), (at(Axis.TILT, 0), PositionTarget(1, 4.0))]
    moves = plan_point_to_point([*both, (at(Axis.ROLL, 0), PositionTarget(1))])
    assert moves[Axis.PAN].trajectory is moves[Axis.TILT].trajectory
    assert moves[Axis.PAN].trajectory.duration == pytest.approx(4.0)
    assert moves[Axis.ROLL].trajectory.duration < 1.0


def test_an_arrival_that_is_too_early_becomes_the_earliest() -> None:
    soon = plan_point_to_point([(at(Axis.PAN, 0), PositionTarget(50, 0.1))])[Axis.PAN]
    free = plan_point_to_point([(at(Axis.PAN, 0), PositionTarget(50))])[Axis.PAN]
    assert soon.trajectory.duration == pytest.approx(free.trajectory.duration)


def test_hours_need_no_solver_but_rest_at_the_start() -> None:
    wanted = PositionTarget(50, 2 * LONGEST)
    move = plan_point_to_point([(at(Axis.PAN, 0), wanted)])[Axis.PAN]
    assert isinstance(move.trajectory, QuinticTrajectory)
    assert move.step(LONGEST).position == pytest.approx(25)
    assert plan_point_to_point([(at(Axis.PAN, 0, 5.0), wanted)]) == {}


def test_the_same_target_goes_on_and_another_does_not() -> None:
    move = plan_point_to_point([(at(Axis.PAN, 0), PositionTarget(50, 4.0))])[Axis.PAN]
    move.step(1.0)
    assert move.continues(PositionTarget(50, 4.0), 0.01)
    assert move.continues(PositionTarget(50, 3.0), 0.01)
    assert not move.continues(PositionTarget(50, 2.0), 0.01)
    assert not move.continues(PositionTarget(51, 4.0), 0.01)
    assert not move.continues(PositionTarget(50), 0.01)


def test_a_quintic_rests_at_both_ends() -> None:
    trajectory = QuinticTrajectory([0.0], [10.0], 5.0)
    assert trajectory.at_time(0.0) == ([0.0], [0.0], [0.0])
    assert trajectory.at_time(5.0) == ([10.0], [0.0], [0.0])
    (position,), (velocity,), (acceleration,) = trajectory.at_time(2.5)
    assert (position, acceleration) == (5.0, 0.0)
    assert velocity == pytest.approx(15 / 8 * 10 / 5)

"""Where a recall goes, and when it is there."""

from __future__ import annotations

import math

import pytest
from hands import FakeInput
from hypothesis import given
from hypothesis import strategies as st

from teleop.core.axes import Axis, Limits, State
from teleop.core.setpoints import PositionTarget
from teleop.manual.interlock import Interlock
from teleop.manual.recall import Recall, at_rest, is_at, reachable

BOUNDED, TURNING = Limits(-60, 90, 120, 240, 1200), Limits(-math.inf, math.inf, 120, 240, 1200)


@given(st.floats(-500, 500), st.floats(-60, 90))
def test_a_target_is_cut_to_the_soft_limits(target: float, position: float) -> None:
    assert reachable(target, BOUNDED, position) == min(max(target, -60), 90)


@given(st.floats(-1000, 1000), st.floats(-1000, 1000))
def test_an_axis_that_turns_for_ever_takes_the_shorter_way(target: float, position: float) -> None:
    there = reachable(target, TURNING, position)
    assert abs(there - position) <= 180 + 1e-6
    assert (there - target) / 360 == pytest.approx(round((there - target) / 360))


@given(st.floats(-100, 100))
def test_a_stop_ends_at_rest_on_the_side_that_the_axis_moves_to(velocity: float) -> None:
    end = at_rest(State(0.0, velocity), BOUNDED)
    assert (end.velocity, end.acceleration) == (0, 0)
    assert end.position * velocity >= 0


def test_it_is_over_when_every_axis_rests_at_its_target() -> None:
    recall = Recall("preset 1", Interlock(FakeInput()), {Axis.PAN: 10.0, Axis.TILT: 0.0}, 5.0, 3.0)
    assert recall.setpoints() == {Axis.PAN: PositionTarget(10.0, 3.0), Axis.TILT: PositionTarget(0.0, 3.0)}
    assert recall.end == 8.0
    assert recall.is_over({Axis.PAN: State(10.0), Axis.TILT: State(0.0)})
    assert not recall.is_over({Axis.PAN: State(10.0), Axis.TILT: State(0.0, 1.0)})
    assert not is_at(State(9.9), 10.0)

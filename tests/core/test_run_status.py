"""What a view says of a latched STOP: stopping while an axis moves, then stopped."""

from __future__ import annotations

import pytest

from teleop.core.axes import Axis, State
from teleop.core.run_status import stop_state

REST = {Axis.PAN: State(10.0), Axis.TILT: State(-5.0)}


def test_without_a_stop_nothing_is_said_whatever_moves():
    assert stop_state(False, {Axis.PAN: State(0.0, 5.0)}) == ""


@pytest.mark.parametrize("moving", [State(0.0, -1e-3, 0.0), State(0.0, 0.0, 1e-3)])
def test_an_axis_with_velocity_or_acceleration_is_stopping(moving: State):
    assert stop_state(True, {**REST, Axis.ROLL: moving}) == "stopping"


def test_all_at_rest_is_stopped():
    assert stop_state(True, REST) == "stopped"
    assert stop_state(True, {}) == "stopped"


def test_a_stick_that_goes_to_its_center_is_no_axis_that_moves():
    assert stop_state(True, {**REST, Axis.STICK_YAW: State(0.4, -2.0)}) == "stopped"

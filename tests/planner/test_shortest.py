"""The least time for a way to targets."""

from __future__ import annotations

from teleop.config.profile import load_profile
from teleop.core.axes import Axis, State
from teleop.planner.shortest import shortest_seconds


def test_the_shortest_time_is_that_of_the_slowest_axis_and_no_legal_move_is_faster():
    limits = load_profile("sim").limits
    motion = {axis: State(0.0) for axis in limits}
    pan, both = ({Axis.PAN: 90.0}, {Axis.PAN: 90.0, Axis.FOCUS: 1.0})
    assert shortest_seconds(motion, both, limits) > shortest_seconds(motion, pan, limits) > 90 / 120
    assert shortest_seconds(motion, {Axis.PAN: 0.0}, limits) == 0

"""What a plan uses of a rig's limits."""

from __future__ import annotations

import pytest

from teleop.app.check import check
from teleop.app.planning import plan_content
from teleop.config.profile import load_profile


def test_shares_and_room_are_those_of_the_planned_motion():
    profile = load_profile("sim")
    plan = plan_content({"keyframes": [{"at": 0, "pan": 0}, {"at": 4, "pan": 170}]}, profile)
    found = check(plan)
    (axis,) = found.axes
    peaks = plan.sequence.move.peaks()[axis]
    assert found.axes[axis].velocity == pytest.approx(peaks.velocity / profile.limits[axis].velocity)
    assert found.axes[axis].room == pytest.approx(10, abs=1e-6)
    shares = (found.axes[axis].velocity, found.axes[axis].acceleration, found.axes[axis].jerk)
    assert all(0 < share <= 1 for share in shares)
    assert found.fastest >= 1


def test_a_drones_move_has_one_speed():
    flown = {"keyframes": [{"at": 0, "stick_yaw": 0}, {"at": 2, "stick_yaw": 0.1}, {"at": 9, "stick_yaw": 0}]}
    assert check(plan_content(flown, load_profile("m100"))).fastest == 1


def test_an_axis_that_turns_without_end_has_no_room_to_name(tmp_path):
    text = """
name: Turning
links: {gimbal: "sim:"}
axes: {pan: {min: null, max: null, velocity: 100, acceleration: 200, jerk: 1000}}
sinks: [{type: gimbal, link: gimbal, mode: position, rate: 50}]
"""
    (tmp_path / "rig.yaml").write_text(text)
    profile = load_profile(str(tmp_path / "rig.yaml"))
    plan = plan_content({"keyframes": [{"at": 0, "pan": 0}, {"at": 9, "pan": 400}]}, profile)
    assert [use.room for use in check(plan).axes.values()] == [None]

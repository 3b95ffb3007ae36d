"""Moves that are slower than the steps of a gimbal in position mode."""

from __future__ import annotations

from teleop.app.planning import plan_content
from teleop.app.slow_moves import slow_moves
from teleop.config.profile import load_profile

PROFILE = load_profile("sim")
SLOW = {"fps": 24, "keyframes": [{"at": 0, "pan": 0}, {"at": "239f", "pan": 3}]}


def test_three_degrees_over_240_frames_are_209_steps_of_nothing_and_30_of_a_tenth() -> None:
    (line,) = slow_moves(plan_content(SLOW, PROFILE))
    assert "pan moves 3 deg in 240 frames at 24 fps" in line
    assert "209 frames without a step, and 30 of 0.1 deg" in line
    assert "use `mode: speed` in the profile, or at most 7" in line
    assert "longer lens only shows it more" in line


def test_speed_mode_and_a_faster_move_are_well() -> None:
    sinks = [sink.model_copy(update={"mode": "speed"}) if sink.type == "gimbal" else sink for sink in PROFILE.sinks]
    assert list(slow_moves(plan_content(SLOW, PROFILE.model_copy(update={"sinks": sinks})))) == []
    fast = {"fps": 24, "keyframes": [{"at": 0, "pan": 0}, {"at": "72f", "pan": 9}]}
    assert list(slow_moves(plan_content(fast, PROFILE))) == []


def test_a_timelapse_is_counted_by_its_frames() -> None:
    shoot = {"frames": 240, "interval": "3s", "exposure": "1s"}
    plan = plan_content({**SLOW, "timelapse": shoot}, PROFILE)
    (line,) = slow_moves(plan)
    assert "209 frames without a step, and 30 of 0.1 deg; use at most 31 frames" in line

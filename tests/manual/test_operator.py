"""The operator's rules, each by what a planner makes of the demands: who may move what, when, and what stops it."""

from __future__ import annotations

import math
from pathlib import Path

import pytest
from fakes import cruising
from hands import LIMITS, Desk, FakeInput

from teleop.core.axes import Axis, Limits, Reading, State
from teleop.core.events import Action, DeviceCommand, DialInput
from teleop.core.operator_input import Command
from teleop.core.setpoints import PositionTarget, Stop, VelocityTarget
from teleop.manual.target_marks import TargetMarks
from teleop.planner.aim import Point

PAN, TILT, FOCUS = Axis.PAN, Axis.TILT, Axis.FOCUS


@pytest.fixture
def desk(tmp_path: Path) -> Desk:
    """One pad at the medium range, trusted."""
    desk = Desk(tmp_path / "presets.yaml", start_range=2)
    desk.tick()
    return desk


def at_preset_1(desk: Desk, **positions: float) -> Desk:
    desk.presets.store(1, {Axis(axis): position for axis, position in positions.items()})
    return desk


# --- who may move anything


def test_a_stick_moves_its_axis_at_its_share_of_the_range(desk: Desk) -> None:
    desk.pad.hold(pan=0.5)
    desk.run(2)
    assert desk.velocity(PAN) == pytest.approx(0.5 * 0.35 * 120)
    assert desk.velocity(TILT) == 0
    assert desk.status.deflections == {PAN: 0.5}
    assert list(desk.status.inputs[0].moves) == [PAN]


def test_a_stick_that_is_held_over_at_the_start_moves_nothing_until_it_was_centred(tmp_path: Path) -> None:
    desk = Desk(tmp_path / "presets.yaml")
    desk.pad.hold(pan=1.0)
    desk.run(1)
    assert desk.rests
    assert desk.messages == ["pad is locked: center its sticks"]
    assert desk.status.inputs[0].waits_for == "center its sticks"
    desk.pad.hold(pan=0.0)
    desk.tick()
    desk.pad.hold(pan=1.0)
    desk.run(1)
    assert desk.velocity(PAN) == pytest.approx(12)


def test_one_axis_held_over_holds_back_the_whole_input(tmp_path: Path) -> None:
    desk = Desk(tmp_path / "presets.yaml")
    desk.pad.hold(tilt=0.2)
    desk.tick()
    desk.pad.hold(tilt=0.2, pan=1.0)
    desk.run(1)
    assert desk.rests


def test_an_enable_button_must_be_pressed_after_the_stick_was_centred(tmp_path: Path) -> None:
    desk = Desk(tmp_path / "presets.yaml", FakeInput(enabled=True))
    desk.run(0.1)
    desk.pad.hold(pan=1.0)
    desk.run(0.5)
    assert desk.rests  # it has been held since before: it may be stuck
    assert "hold its enable button" in desk.messages[0]
    desk.pad.enabled = False
    desk.tick()
    desk.pad.enabled = True
    desk.run(0.5)
    assert desk.velocity(PAN) > 10


def test_letting_the_enable_button_go_stops_at_the_axis_s_own_limits(tmp_path: Path) -> None:
    desk = Desk(tmp_path / "presets.yaml", FakeInput(enabled=False), start_range=3, ramp=1.0)
    desk.tick()
    desk.pad.enabled = True
    desk.pad.hold(pan=1.0)
    desk.run(1.2)
    assert desk.velocity(PAN) == pytest.approx(120)
    desk.pad.enabled = False
    desk.run(0.72)  # 120 deg/s at 240 deg/s2 and 1200 deg/s3 take 0.7 s; the ramp would take 1 s
    assert desk.rests
    desk.pad.enabled = True
    desk.pad.hold(pan=-1.0)
    desk.run(1)
    assert desk.velocity(PAN) < 0


def test_the_first_trusted_input_that_deflects_an_axis_drives_it(tmp_path: Path) -> None:
    first, second = FakeInput("dial"), FakeInput("pad")
    desk = Desk(tmp_path / "presets.yaml", first, second, start_range=3)
    desk.tick()
    second.hold(pan=-0.5, tilt=0.5)
    first.hold(pan=0.1)
    desk.run(1)
    assert desk.velocity(PAN) == pytest.approx(12)
    assert desk.velocity(TILT) == pytest.approx(45)
    assert [list(hand.moves) for hand in desk.status.inputs] == [[PAN], [TILT]]
    first.hold()
    desk.run(1)
    assert desk.velocity(PAN) == pytest.approx(-60)


def test_hands_off_is_for_inputs_without_an_enable_button(tmp_path: Path) -> None:
    free, held = FakeInput("free"), FakeInput("held", enabled=False)
    desk = Desk(tmp_path / "presets.yaml", free, held)
    desk.tick()
    held.enabled = True
    free.hold(pan=1.0)
    held.hold(tilt=1.0)
    desk.run(1)
    free.press(Command.ENABLE)
    desk.run(1)
    assert desk.velocity(PAN) == 0
    assert desk.velocity(TILT) == pytest.approx(9)
    assert not desk.status.manual_control
    assert desk.status.inputs[0].waits_for == "center its sticks"
    free.hold()
    desk.tick(2)
    assert desk.status.inputs[0].waits_for == "manual control is off"
    free.press(Command.ENABLE)
    desk.tick(2)
    free.hold(pan=1.0)
    desk.run(1)
    assert desk.velocity(PAN) == pytest.approx(12)


def test_an_axis_that_the_rig_lacks_is_ignored_and_a_step_of_it_is_said(desk: Desk) -> None:
    desk.pad.hold(roll=1.0)
    desk.pad.turn(Axis.ROLL, 1.0)
    desk.run(0.1)
    assert desk.demand == {}
    assert desk.messages[0] == "roll is not an axis of this rig"


# --- trouble


def test_trouble_stops_what_the_input_moved_and_says_so(desk: Desk) -> None:
    desk.pad.hold(pan=1.0, tilt=-1.0)
    desk.run(0.5)
    desk.pad.trouble = "pad: unplugged"
    desk.tick()
    assert desk.demand == {PAN: VelocityTarget(0.0), TILT: VelocityTarget(0.0)}
    assert desk.messages[0] == "pad: unplugged: pan and tilt stopped"
    desk.run(0.5)
    assert desk.rests
    assert desk.status.inputs[0].trouble == "pad: unplugged"
    desk.pad.trouble = ""  # replugged, the stick still held over
    desk.run(0.5)
    assert desk.rests
    assert desk.messages[1] == "pad: center its sticks"
    desk.pad.hold()
    desk.tick()
    desk.pad.hold(pan=1.0)
    desk.run(0.5)
    assert desk.velocity(PAN) > 40


def test_an_input_that_fails_while_its_axis_still_runs_out_stops_it_at_once(tmp_path: Path) -> None:
    desk = Desk(tmp_path / "presets.yaml", start_range=3, low_pass=1.0)
    desk.tick()
    desk.pad.hold(pan=0.3)
    desk.run(1)
    desk.pad.hold()
    desk.tick(2)
    assert desk.demand[PAN] != VelocityTarget(0.0)  # the low-pass lets it go slowly
    desk.pad.trouble = "pad: unplugged"
    desk.tick()
    assert desk.demand == {PAN: VelocityTarget(0.0)}


def test_after_trouble_the_enable_button_must_be_pressed_anew(tmp_path: Path) -> None:
    desk = Desk(tmp_path / "presets.yaml", FakeInput(enabled=False))
    desk.tick()
    desk.pad.enabled = True
    desk.tick()
    desk.pad.trouble = "pad: silent"
    desk.tick()
    desk.pad.trouble = ""
    desk.tick()
    desk.pad.hold(pan=1.0)
    desk.run(0.5)
    assert desk.rests


def test_another_input_goes_on_where_one_has_failed(tmp_path: Path) -> None:
    first, second = FakeInput("first"), FakeInput("second")
    desk = Desk(tmp_path / "presets.yaml", first, second, start_range=3)
    desk.tick()
    first.hold(pan=1.0)
    second.hold(pan=0.5)
    desk.run(1)
    first.trouble = "first: unplugged"
    desk.run(1)
    assert desk.velocity(PAN) == pytest.approx(60)


@pytest.mark.parametrize("trouble", ["", "pad: silent"])
def test_a_stop_counts_from_any_input_in_any_state(tmp_path: Path, trouble: str) -> None:
    first, second = FakeInput("first"), FakeInput("second", enabled=False)
    desk = Desk(tmp_path / "presets.yaml", first, second, start_range=3)
    desk.tick()
    first.hold(pan=1.0)
    desk.run(1)
    second.trouble = trouble
    second.hold(tilt=1.0)
    second.press(Command.STOP)
    desk.tick()
    assert desk.demand == {axis: Stop() for axis in LIMITS}
    assert desk.messages[0] == "STOP by second. Press c to clear, then center all sticks."


# --- STOP


def test_a_stop_latches_until_it_is_cleared_and_then_wants_centred_sticks(desk: Desk) -> None:
    desk.pad.hold(pan=1.0)
    desk.run(1)
    desk.press(Command.STOP)
    desk.run(0.5)
    assert desk.rests
    desk.pad.hold()
    desk.run(0.1)
    desk.pad.hold(pan=1.0)
    desk.run(1)
    assert desk.rests
    assert desk.status.stopped
    desk.press(Command.CLEAR)
    desk.run(1)
    assert desk.rests  # held over all along
    desk.pad.hold()
    desk.tick()
    desk.pad.hold(pan=1.0)
    desk.run(1)
    assert desk.velocity(PAN) == pytest.approx(42)


def test_a_stop_and_a_clear_in_the_same_tick_is_a_stop(desk: Desk) -> None:
    desk.pad.press(Command.STOP)
    desk.pad.press(Command.CLEAR)
    desk.tick()
    assert desk.status.stopped


def test_a_stop_ends_a_recall_and_a_jog_for_good(desk: Desk) -> None:
    at_preset_1(desk, pan=50)
    desk.press(Command.RECALL, 1)
    desk.run(1)
    desk.press(Command.STOP)
    desk.run(1)
    desk.press(Command.RECALL, 1)
    assert desk.messages[0] == "preset 1 refused: STOP is not cleared"
    desk.pad.turn(FOCUS, 0.5)
    desk.press(Command.CLEAR)
    desk.run(1)
    assert desk.rests
    assert desk.status.recall == ""
    assert desk.motion[FOCUS].position == 0


def test_cleared_in_flight_it_still_comes_to_rest(desk: Desk) -> None:
    desk.pad.hold(pan=1.0)
    desk.run(1)
    desk.press(Command.STOP)
    desk.press(Command.CLEAR)
    assert desk.demand[PAN] == VelocityTarget(0.0)
    desk.run(0.5)
    assert desk.rests


# --- speed, ramp, low-pass


def test_the_ranges_step_and_go_round(desk: Desk) -> None:
    seen = []
    for command in (Command.FASTER, Command.FASTER, Command.RANGE, Command.RANGE, Command.SLOWER, Command.SLOWER):
        desk.press(command)
        seen.append(desk.status.range)
    assert seen == [2, 2, 0, 1, 0, 0]
    assert desk.messages[0] == "speed range 1: 10%"


def test_a_range_lowered_in_flight_slows_without_passing_it(desk: Desk) -> None:
    desk.press(Command.FASTER)
    desk.pad.hold(pan=1.0)
    desk.run(1)
    desk.press(Command.SLOWER)
    desk.press(Command.SLOWER)
    desk.history.clear()
    desk.run(1)
    assert desk.velocity(PAN) == pytest.approx(12)
    assert min(motion[PAN].velocity for motion in desk.history) > 11.9


@pytest.mark.parametrize("ramp", [0.3, 1.0])
def test_full_speed_takes_the_ramp_to_reach_and_to_leave(tmp_path: Path, ramp: float) -> None:
    desk = Desk(tmp_path / "presets.yaml", ramp=ramp, low_pass=0.0)
    desk.tick()
    desk.pad.hold(pan=1.0)
    desk.run(ramp - 0.02)
    assert 0 < desk.velocity(PAN) < 12
    desk.run(0.03)
    assert desk.velocity(PAN) == pytest.approx(12)
    desk.pad.hold()
    desk.run(ramp - 0.02)
    assert desk.velocity(PAN) > 0
    desk.run(0.03)
    assert desk.rests


def test_a_stick_let_go_right_after_the_range_was_lowered_stops_as_soon_as_ever(desk: Desk) -> None:
    desk.press(Command.FASTER)
    desk.pad.hold(pan=1.0)
    desk.run(1.5)
    desk.press(Command.SLOWER)
    desk.press(Command.SLOWER)
    desk.pad.hold()
    desk.run(1.2)
    assert desk.rests


def test_the_low_pass_takes_the_noise_out_of_a_stick(tmp_path: Path) -> None:
    def ripple(low_pass: float) -> float:
        desk = Desk(tmp_path / "presets.yaml", low_pass=low_pass, start_range=3)
        desk.tick()
        asked = []
        for number in range(200):
            desk.pad.hold(pan=0.5 + 0.03 * math.sin(number * 2.4))
            desk.tick()
            wish = desk.demand[PAN]
            assert isinstance(wish, VelocityTarget)
            asked.append(wish.velocity)
        return max(asked[100:]) - min(asked[100:])

    assert ripple(0.0) == pytest.approx(2 * 0.03 * 120, rel=0.02)
    assert ripple(0.05) < 0.2 * ripple(0.0)


def test_a_stick_into_the_soft_limit_rests_there_and_comes_back(desk: Desk) -> None:
    desk.press(Command.FASTER)
    desk.pad.hold(pan=1.0)
    desk.run(5)
    assert desk.motion[PAN].position == pytest.approx(180, abs=1e-5)
    desk.pad.hold(pan=-1.0)
    desk.run(0.5)
    assert desk.velocity(PAN) < -50


# --- presets, recentre


def test_a_recall_takes_its_time_and_all_axes_arrive_together(desk: Desk) -> None:
    at_preset_1(desk, pan=60, tilt=-10, focus=0.5)
    desk.press(Command.RECALL, 1)
    assert desk.messages[0] == "preset 1 in 3 s"
    desk.run(2.9)
    assert desk.status.recall == "preset 1"
    assert desk.status.recall_end == pytest.approx(desk.now + 0.1)
    assert all(desk.velocity(axis) != 0 for axis in (PAN, TILT, FOCUS))
    desk.run(0.12)
    assert desk.rests
    assert [desk.motion[axis].position for axis in (PAN, TILT, FOCUS)] == [60, -10, 0.5]
    assert (desk.status.recall, desk.messages[0]) == ("", "preset 1 reached")


def test_a_recall_that_its_axes_cannot_make_in_time_is_late_together_and_says_so(tmp_path: Path) -> None:
    limits = {PAN: Limits(-180, 180, 10, 20, 100), TILT: LIMITS[TILT]}
    slow = at_preset_1(Desk(tmp_path / "presets.yaml", limits=limits), pan=60, tilt=30)
    slow.tick()
    slow.press(Command.RECALL, 1)
    slow.run(6)
    assert slow.velocity(PAN) != 0
    assert slow.velocity(TILT) != 0
    slow.run(3)
    assert slow.messages[0] == "preset 1 reached in 6.7 s: its axes go no faster"


@pytest.mark.parametrize("how", ["stick", "step"])
def test_a_hand_on_any_axis_ends_the_whole_recall(desk: Desk, how: str) -> None:
    at_preset_1(desk, pan=60, focus=0.5)
    desk.press(Command.RECALL, 1)
    desk.run(1)
    if how == "stick":
        desk.pad.hold(tilt=0.1)
    else:
        desk.pad.turn(TILT, 1.0)
    desk.run(1)
    assert desk.velocity(PAN) == desk.velocity(FOCUS) == 0
    assert desk.motion[PAN].position < 59
    assert desk.messages[0] == "preset 1 ended: pad moved tilt"
    assert desk.motion[TILT].position > 0.5


def test_a_recall_stops_with_the_input_that_asked_for_it(tmp_path: Path) -> None:
    desk = at_preset_1(Desk(tmp_path / "presets.yaml", FakeInput(enabled=False)), pan=60)
    desk.tick()
    desk.pad.enabled = True
    desk.tick()
    desk.press(Command.RECALL, 1)
    desk.run(1)
    desk.pad.enabled = False
    desk.run(1)
    assert desk.rests
    assert desk.motion[PAN].position < 59
    assert desk.messages[0] == "preset 1 ended: pad: hold its enable button"


def test_an_input_that_may_move_nothing_may_recall_nothing(tmp_path: Path) -> None:
    desk = at_preset_1(Desk(tmp_path / "presets.yaml", FakeInput(enabled=False)), pan=60)
    desk.tick()
    desk.press(Command.RECALL, 1)
    desk.press(Command.RECENTER)
    desk.run(1)
    assert desk.rests
    assert desk.messages[:2] == [
        "recenter refused: hold its enable button",
        "preset 1 refused: hold its enable button",
    ]


def test_a_recall_waits_for_the_stick_to_be_let_go(desk: Desk) -> None:
    at_preset_1(desk, pan=60)
    desk.pad.hold(tilt=0.5)
    desk.run(0.5)
    desk.press(Command.RECALL, 1)
    assert desk.messages[0] == "preset 1 refused: release the stick first"
    assert PAN not in desk.demand


def test_store_keeps_the_commanded_position_in_flight_too(desk: Desk) -> None:
    desk.pad.hold(pan=1.0)
    desk.run(1)
    position = desk.motion[PAN].position
    desk.press(Command.STORE, 4)
    desk.presets.close()
    stored = desk.presets.get(4)
    assert stored is not None
    assert stored.positions == {PAN: round(position, 4), TILT: 0, FOCUS: 0}
    assert dict(desk.status.presets) == {4: ""}
    desk.press(Command.DELETE, 4)
    desk.press(Command.RECALL, 4)
    assert desk.messages[:2] == ["there is no preset 4 yet", "preset 4 deleted"]


def test_recentre_plans_the_way_to_zero_of_the_head_and_not_of_focus(desk: Desk) -> None:
    desk.pad.hold(pan=1.0, tilt=0.5, focus=1.0)
    desk.run(1)
    desk.pad.hold()
    desk.run(1)
    focus = desk.motion[FOCUS].position
    desk.press(Command.RECENTER)
    assert desk.demand == {PAN: PositionTarget(0.0, 3.0), TILT: PositionTarget(0.0, 3.0)}
    desk.run(3.1)
    assert (desk.motion[PAN], desk.motion[TILT], desk.motion[FOCUS].position) == (State(0), State(0), focus)


def test_a_continuous_axis_goes_to_the_nearest_turn(tmp_path: Path) -> None:
    desk = Desk(tmp_path / "presets.yaml", limits={PAN: Limits(-math.inf, math.inf, 120, 240, 1200)})
    desk.planner.reset({PAN: State(1000.0)})
    desk.tick(2)
    desk.press(Command.RECENTER)
    desk.run(3.2)
    assert desk.motion[PAN].position == 1080


# --- steps


def test_steps_one_after_the_other_add_up_and_are_reached_exactly(desk: Desk) -> None:
    for _ in range(3):
        desk.pad.turn(PAN, 1.0)
        desk.run(0.5)
    desk.pad.turn(FOCUS, 0.05)
    desk.run(1.5)
    assert desk.motion[PAN] == State(3.0)
    assert desk.motion[FOCUS] == State(0.05)
    assert desk.demand == {}


def test_steps_end_at_the_soft_limit_and_the_way_back_is_free_at_once(tmp_path: Path) -> None:
    desk = Desk(tmp_path / "presets.yaml", start_range=3)
    for _ in range(3):
        desk.pad.turn(FOCUS, 0.5)
        desk.run(0.8)
    assert desk.messages[0] == "focus is at its soft limit"
    desk.run(5)
    assert desk.motion[FOCUS] == State(1.0)
    desk.pad.turn(FOCUS, -0.1)
    desk.run(2)
    assert desk.motion[FOCUS] == State(0.9)


def test_a_stick_ends_the_steps_of_its_axis_alone(tmp_path: Path) -> None:
    desk = Desk(tmp_path / "presets.yaml", start_range=3)
    desk.pad.turn(PAN, 90.0)
    desk.pad.turn(FOCUS, 0.8)
    desk.run(0.3)
    desk.pad.hold(pan=-0.2)
    desk.run(0.3)
    desk.pad.hold()
    desk.run(4)
    assert desk.motion[PAN].position < 45
    assert desk.motion[FOCUS] == State(0.8)


def test_steps_stop_with_the_input_they_came_from(desk: Desk) -> None:
    desk.pad.turn(PAN, 90.0)
    desk.run(0.3)
    desk.pad.trouble = "dial: unplugged"
    desk.run(2)
    assert desk.rests
    assert desk.motion[PAN].position < 60


def test_steps_of_an_untrusted_input_are_lost_not_kept(tmp_path: Path) -> None:
    desk = Desk(tmp_path / "presets.yaml", FakeInput(enabled=False))
    desk.pad.turn(PAN, 5.0)
    desk.run(0.5)
    desk.pad.enabled = True
    desk.run(1)
    assert desk.motion[PAN] == State(0)
    assert desk.messages == ["pad is locked: hold its enable button"]


def test_a_slider_takes_its_axis_only_once_it_is_moved(desk: Desk) -> None:
    desk.pad.positions = {FOCUS: 0.8}
    desk.run(0.5)
    assert desk.demand == {}
    desk.pad.positions = {FOCUS: 0.801}
    desk.run(0.5)
    assert desk.demand == {}
    for share in (0.7, 0.6, 0.5):
        desk.pad.positions = {FOCUS: share}
        desk.tick(3)
    desk.run(3)
    assert desk.motion[FOCUS] == State(0.5)


def test_a_slider_moved_while_it_was_not_trusted_is_not_caught_up_with(desk: Desk) -> None:
    desk.pad.positions = {FOCUS: 0.8}
    desk.tick()
    desk.press(Command.STOP)
    desk.pad.positions = {FOCUS: 0.2}
    desk.tick(2)
    desk.press(Command.CLEAR)
    desk.run(1)
    assert desk.motion[FOCUS] == State(0.0)
    desk.pad.trouble, desk.pad.positions = "pad: unplugged", {}
    desk.tick()
    desk.pad.trouble, desk.pad.positions = "", {FOCUS: 0.9}
    desk.run(1)
    assert desk.motion[FOCUS] == State(0.0)


def test_what_an_input_notes_is_said_once(desk: Desk) -> None:
    desk.pad.notes = ["pad: it has no Hat 1"]
    desk.tick(3)
    assert list(desk.messages) == ["pad: it has no Hat 1"]


# --- camera, commands, dial


def test_record_and_shutter_and_what_quitting_does_to_a_recording(desk: Desk) -> None:
    desk.press(Command.RECORD)
    assert not desk.status.recording, "the camera has not answered"
    desk.operator.camera_answered(Action.RECORD, True)
    desk.tick()
    assert desk.status.recording
    desk.press(Command.SHUTTER)
    desk.press(Command.RECORD)
    desk.press(Command.RECORD)
    desk.press(Command.QUIT)
    assert desk.actions == [Action.RECORD, Action.SHUTTER, Action.STOP, Action.RECORD, Action.STOP]


def test_a_camera_that_does_not_record_is_asked_to_again_and_one_that_does_not_stop_too(desk: Desk) -> None:
    desk.press(Command.RECORD)
    desk.operator.camera_answered(Action.RECORD, False)
    desk.press(Command.RECORD)
    desk.operator.camera_answered(Action.RECORD, True)
    desk.press(Command.RECORD)
    desk.operator.camera_answered(Action.STOP, False)
    desk.tick()
    assert desk.status.recording
    desk.press(Command.RECORD)
    desk.operator.camera_answered(Action.STOP, True)
    desk.tick()
    assert not desk.status.recording
    assert desk.actions == [Action.RECORD, Action.RECORD, Action.STOP, Action.STOP]


def test_quitting_stops_every_axis_and_ends_the_run(desk: Desk) -> None:
    desk.pad.hold(pan=1.0)
    desk.run(1)
    assert desk.operator.next_change(desk.now) == desk.now
    desk.press(Command.QUIT)
    assert desk.demand == {axis: Stop() for axis in LIMITS}
    assert math.isinf(desk.operator.next_change(desk.now))
    desk.run(0.6)
    assert desk.rests


def test_a_device_s_own_command_is_refused_while_anything_moves(desk: Desk) -> None:
    desk.pad.hold(pan=1.0)
    desk.run(0.2)
    desk.press(Command.TELL, device_command=DeviceCommand("gimbal", "follow lock"))
    assert (desk.actions, desk.messages[0]) == ([], "gimbal follow lock refused: an axis is moving")
    desk.pad.hold()
    desk.run(1)
    desk.press(Command.TELL, device_command=DeviceCommand("gimbal", "follow lock"))
    assert desk.actions == [DeviceCommand("gimbal", "follow lock")]


def test_the_dial_is_passed_on_while_it_turns_and_once_as_it_rests(desk: Desk) -> None:
    desk.pad.dial = 0.5
    desk.tick(2)
    desk.pad.dial = 0.0
    desk.tick(3)
    assert desk.actions == [DialInput(0.5), DialInput(0.5), DialInput(0.0)]


@pytest.mark.parametrize("how", ["stop", "trouble", "quit"])
def test_the_dial_rests_when_the_hand_no_longer_counts(desk: Desk, how: str) -> None:
    desk.pad.dial = 0.5
    desk.tick()
    if how == "trouble":
        desk.pad.trouble = "pad: unplugged"
    else:
        desk.pad.press(Command(how))
    desk.tick(2)
    assert desk.actions == [DialInput(0.5), DialInput(0.0)]


# --- what lies beneath


def test_a_hand_takes_an_axis_from_what_is_recorded_and_gives_it_back(tmp_path: Path) -> None:
    desk = Desk(tmp_path / "presets.yaml", beneath=cruising(PAN, 5.0, 6.0), start_range=3)
    desk.run(1)
    assert desk.velocity(PAN) == pytest.approx(5)
    desk.pad.hold(pan=-0.5, tilt=0.5)
    desk.run(1)
    assert desk.velocity(PAN) == pytest.approx(-60)
    desk.pad.trouble = "pad: unplugged"
    desk.tick()
    assert desk.demand[PAN] == VelocityTarget(0.0)  # first to rest, not straight into the recording
    desk.run(1)
    assert desk.velocity(PAN) == pytest.approx(5)
    assert not math.isinf(desk.operator.next_change(desk.now))
    desk.run(3)
    assert math.isinf(desk.operator.next_change(desk.now))


def test_after_an_e_stop_a_recording_that_moves_does_not_move_on(tmp_path: Path) -> None:
    desk = Desk(tmp_path / "presets.yaml", beneath=cruising(PAN, 5.0, 6.0))
    desk.run(1)
    desk.press(Command.STOP)
    desk.run(1)
    desk.press(Command.CLEAR)
    desk.run(1)
    assert desk.rests


def test_a_mark_needs_a_file_and_a_rig_that_measures(desk: Desk) -> None:
    desk.press(Command.TELL, device_command=DeviceCommand("target", "door,4"))
    assert desk.messages[0] == "mark target: start teleop live with --targets FILE"


def test_a_mark_takes_what_is_measured_and_only_at_rest(tmp_path: Path) -> None:
    found: dict[str, Point] = {}
    desk = Desk(tmp_path / "presets.yaml", marks=TargetMarks(0.0, found.__setitem__))
    desk.tick()
    desk.press(Command.TELL, device_command=DeviceCommand("target", "door,4"))
    assert desk.messages[0] == "mark target: needs a rig that measures pan and tilt"
    desk.readings = {PAN: Reading(90.0, desk.now), TILT: Reading(0.0, desk.now)}
    desk.pad.hold(pan=1.0)
    desk.run(0.5)
    desk.press(Command.TELL, device_command=DeviceCommand("target", "door,4"))
    assert desk.messages[0] == "mark target refused: an axis is moving"
    desk.pad.hold(pan=0.0)
    desk.run(1)
    desk.press(Command.TELL, device_command=DeviceCommand("target", "door,4"))
    assert found == {"door": (4, 0, 0)}

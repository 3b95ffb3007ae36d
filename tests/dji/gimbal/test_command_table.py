"""Everything an operator can name leads to a message that may be sent, and help says what each field must be."""

from __future__ import annotations

import pytest

from teleop.dji.command_parser import FieldHelp, help_of
from teleop.dji.drone import messages as drone
from teleop.dji.drone.command_table import DRONE
from teleop.dji.gimbal import camera, focus
from teleop.dji.gimbal import messages as gimbal
from teleop.dji.gimbal.camera import CameraCommand
from teleop.dji.gimbal.command_table import COMMANDS, PLAIN, find
from teleop.dji.gimbal.focus import CalibrationAction
from teleop.dji.gimbal.r_sdk import R_SDK
from teleop.dji.message import FieldError, Message


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ("recenter", gimbal.Mode(action=gimbal.CenterAction.RECENTER)),
        ("gimbal recenter", gimbal.Mode(action=gimbal.CenterAction.RECENTER)),
        ("selfie", gimbal.Mode(action=gimbal.CenterAction.SELFIE)),
        ("angles", gimbal.Angles()),
        ("angles joint", gimbal.Angles(gimbal.AngleKind.JOINT)),
        ("limits", gimbal.Limits()),
        ("stiffness", gimbal.Stiffness()),
        ("version", gimbal.Version()),
        ("follow lock", gimbal.Mode(gimbal.FollowMode.LOCK)),
        ("follow yaw", gimbal.Mode(gimbal.FollowMode.YAW)),
        ("follow sport", gimbal.Mode(gimbal.FollowMode.SPORT)),
        ("orientation portrait", gimbal.Orient(gimbal.Orientation.PORTRAIT)),
        ("orientation portrait-flipped", gimbal.Orient(gimbal.Orientation.PORTRAIT_FLIPPED)),
        ("calibrate", gimbal.Calibrate()),
        ("track", gimbal.ActiveTrack()),
        ("record", camera.Command(CameraCommand.RECORD)),
        ("stop", camera.Command(CameraCommand.STOP)),
        ("shutter", camera.Command(CameraCommand.SHUTTER)),
        ("camera stop_shutter", camera.Command(CameraCommand.STOP_SHUTTER)),
        ("focus calibrate", focus.Calibrate(CalibrationAction.AUTO)),
        ("focus calibrate minimum", focus.Calibrate(CalibrationAction.MINIMUM)),
        ("focus calibrate action=stop", focus.Calibrate(CalibrationAction.STOP)),
        ("focus set position=4095", focus.Set(4095)),
        ("gimbal position yaw=10 roll=0 pitch=-5.5", gimbal.Position(10, 0, -5.5)),
        ("gimbal position yaw=10", gimbal.Position(10, 0, 0, roll_ignored=True, pitch_ignored=True)),
        ("gimbal position pitch=3 absolute=false", gimbal.Position(0, 0, 3, False, True, True)),
        ("gimbal speed pitch=5", gimbal.Speed(0, 0, 5)),
        ("joystick yaw=15000", gimbal.Joystick(0, 0, 15000)),
        ("follow pan", gimbal.Mode(gimbal.FollowMode.YAW)),
        (
            "set_limits pitch_max=1 pitch_min=2 yaw_max=3 yaw_min=4 roll_max=5 roll_min=6",
            gimbal.SetLimits(1, 2, 3, 4, 5, 6),
        ),
        ("set parameters parameters=motor:01", gimbal.SetParameters((gimbal.Parameter(0x23, b"\1"),))),
        ("parameters ids=motor,0x14", gimbal.Parameters((0x23, 0x14))),
    ],
)
def test_words_find_their_message(words: str, message: Message) -> None:
    assert find(words.split()) == message
    message.check()


@pytest.mark.parametrize("name", PLAIN)
def test_every_plain_word_is_found_and_may_be_sent(name: str) -> None:
    assert find(name.split()) == PLAIN[name]
    PLAIN[name].check()


def test_every_command_of_the_document_can_be_sent() -> None:
    sendable = {cls.set_and_id for cls in COMMANDS.values()}
    pushed_by_the_gimbal = {gimbal.Push.set_and_id, gimbal.Calibration.set_and_id}
    assert sendable == {cls.set_and_id for cls in R_SDK.messages} - pushed_by_the_gimbal
    assert sendable | pushed_by_the_gimbal == {bytes((0x0E, number)) for number in range(0x13)} | {b"\x0d\0", b"\x0d\1"}


@pytest.mark.parametrize(
    ("words", "error"),
    [
        ("recentre", "unknown command recentre; did you mean recenter?"),
        ("xyzzy", "unknown command xyzzy"),
        ("gimbal recenter speed=1", "gimbal recenter takes no fields"),
        ("gimbal position", "gimbal.position: yaw, roll, pitch missing"),
        ("gimbal position time_for_action=1", "gimbal.position: yaw, roll, pitch missing"),
        ("gimbal set_stiffness yaw=1", "gimbal.set_stiffness: pitch, roll missing"),
        ("gimbal position yaw=1 yaw=2 roll=0 pitch=0", "duplicate field"),
        ("focus set position=near", "focus.set: position must be 0..4095, not 'near'"),
    ],
)
def test_words_that_lead_nowhere(words: str, error: str) -> None:
    with pytest.raises(FieldError) as raised:
        find(words.split())
    assert str(raised.value) == error


def test_of_the_drone_s_gimbal_an_axis_that_is_not_named_is_ignored_or_gets_0() -> None:
    ignored = drone.GimbalAngle(0, 0, -90, yaw_ignored=True, roll_ignored=True, duration=1)
    assert DRONE.find(["drone", "gimbal", "angle", "pitch=-90", "duration=1"]) == ignored
    assert ignored.encode()[6] == 0b0111  # absolute, yaw and roll ignored
    assert DRONE.find(["drone", "gimbal", "speed", "yaw=4"]) == drone.GimbalSpeed(4, 0, 0)


def test_help_has_requirement_unit_and_default() -> None:
    position = help_of(gimbal.Position)
    assert position[0] == FieldHelp("yaw", "-180..180 deg", None)
    assert position[3] == FieldHelp("absolute", "true or false", "true")
    assert position[-1] == FieldHelp("time_for_action", "0.1..25.5 s", "2.0")
    assert help_of(gimbal.Angles) == [FieldHelp("kind", "one of none, attitude, joint", "attitude")]


@pytest.mark.parametrize("name", COMMANDS)
def test_every_field_has_help(name: str) -> None:
    assert all(field.requirement for field in help_of(COMMANDS[name]))

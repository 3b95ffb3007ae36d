"""Every message of the gimbal against bytes written by hand from the tables of the document."""

from __future__ import annotations

import pytest

from teleop.dji.frame import Frame
from teleop.dji.gimbal import messages as gimbal
from teleop.dji.gimbal.messages import (
    AngleKind,
    CalibrationState,
    CenterAction,
    FollowMode,
    Mode,
    Orient,
    Orientation,
    Parameter,
    ParameterId,
    Switch,
)
from teleop.dji.gimbal.r_sdk import R_SDK
from teleop.dji.message import FieldError, Message, ReturnCode
from teleop.dji.registry import messages_of

PUSH = gimbal.Push(True, False, True, 1.0, 2.0, -0.1, 4.0, 5.0, 6.0, 145, 55, 179, 178, 30, 29, 46, 65, 54)
COMMANDS = [
    (gimbal.Position(3.2, 4.8, 6.4), "0e00 2000 3000 4000 01 14"),
    (gimbal.Position(-180, 30, 146, absolute=False, time_for_action=25.5), "0e00 f8f8 2c01 b405 00 ff"),
    (gimbal.Position(0, 0, 0, yaw_ignored=True, time_for_action=0.1), "0e00 0000 0000 0000 03 01"),
    (gimbal.Position(0, 0, 0, roll_ignored=True), "0e00 0000 0000 0000 05 14"),
    (gimbal.Position(0, 0, 0, pitch_ignored=True), "0e00 0000 0000 0000 09 14"),
    (gimbal.Speed(360, -360, 0.1), "0e01 100e f0f1 0100 80"),
    (gimbal.Speed(0, 0, 0, take_over=True, ignore_focal_length=True), "0e01 0000 0000 0000 88"),
    (gimbal.Speed(0, 0, 0, take_over=False), "0e01 0000 0000 0000 00"),
    (gimbal.Angles(), "0e02 01"),
    (gimbal.Angles(AngleKind.JOINT), "0e02 02"),
    (gimbal.SetLimits(145, 55, 179, 178, 30, 29), "0e03 01 91 37 b3 b2 1e 1d"),
    (gimbal.Limits(), "0e04 01"),
    (gimbal.SetStiffness(pitch=46, roll=54, yaw=65), "0e05 01 2e 36 41"),
    (gimbal.Stiffness(), "0e06 01"),
    (gimbal.PushSettings(Switch.ON), "0e07 01"),
    (gimbal.PushSettings(Switch.OFF), "0e07 02"),
    (PUSH, "0e08 05 0a00 1400 ffff 2800 3200 3c00 91 37 b3 b2 1e 1d 2e 41 36"),
    (gimbal.Version(), "0e09 01000000"),
    (gimbal.VersionPush("01.02.03.20"), "0e09 01000000 14030201"),
    (gimbal.Joystick(pitch=15000, roll=-15000, yaw=1), "0e0a 01 983a 68c5 0100"),
    (gimbal.Dial(-2048), "0e0a 02 00f8"),
    (gimbal.Parameters((ParameterId.TABLE, ParameterId.MOTOR, 0x77)), "0e0b 00 23 77"),
    (gimbal.SetParameters((Parameter(ParameterId.MOTOR, b"\1"), Parameter(0x77, b"\1\2"))), "0e0c 23 01 01 77 02 0102"),
    (Orient(Orientation.PORTRAIT_FLIPPED), "0e0d fe 04"),
    (Orient(Orientation.DEFAULT), "0e0d fe ff"),
    (Mode(action=CenterAction.RECENTER), "0e0e fe 01"),
    (Mode(action=CenterAction.SELFIE), "0e0e fe 02"),
    (Mode(FollowMode.LOCK), "0e0e 00 00"),
    (Mode(FollowMode.YAW), "0e0e 02 00"),
    (Mode(FollowMode.SPORT), "0e0e 03 00"),
    (gimbal.Calibrate(), "0e0f 00 01 03"),
    (gimbal.Calibrate(type=0), "0e0f 00 01 01"),
    (gimbal.Calibrate(start=False, type=0), "0e0f 00 01 00"),
    (gimbal.Calibration(CalibrationState.RUNNING, 40), "0e10 00 06 01 28 00000000"),
    (gimbal.ActiveTrack(), "0e11 03"),
]
REPLIES = [
    (gimbal.AnglesReply(ReturnCode.OK, AngleKind.JOINT, 1.0, -2.0, 0.3), "0e02 00 02 0a00 ecff 0300", 26),
    (gimbal.LimitsReply(ReturnCode.OK, 155, 55, 179, 178, 30, 29), "0e04 00 9b 37 b3 b2 1e 1d", 25),
    (gimbal.StiffnessReply(ReturnCode.OK, pitch=46, yaw=65, roll=54), "0e06 00 2e 41 36", 22),
    (PUSH, "0e08 05 0a00 1400 ffff 2800 3200 3c00 91 37 b3 b2 1e 1d 2e 41 36", 40),
    (gimbal.VersionReply(ReturnCode.OK, 1, "02.02.00.07"), "0e09 00 01000000 07000202", 27),
    (
        gimbal.ParametersReply(
            ReturnCode.OK, (Parameter(0x00, b"\1"), Parameter(0x22, b"\x10"), Parameter(0x23, b"\0"))
        ),
        "0e0b 00 00 01 01 22 01 10 23 01 00",
        28,
    ),
    (
        gimbal.SetParametersReply(ReturnCode.FAILED, (Parameter(0x23, b"\0"),)),
        "0e0c 02 23 01 00",
        22,
    ),
    (gimbal.Calibration(CalibrationState.ERROR, 99, 0x01020304), "0e10 00 06 03 63 04030201", 26),
]


@pytest.mark.parametrize(("message", "data"), COMMANDS, ids=lambda value: str(value)[:60])
def test_commands_are_the_documents_bytes(message: Message, data: str) -> None:
    assert message.data() == bytes.fromhex(data)
    assert R_SDK.decode(Frame(bytes.fromhex(data), message.cmd_type)).message == message
    message.check()


@pytest.mark.parametrize(("message", "data", "size"), REPLIES, ids=lambda value: str(value)[:60])
def test_replies_are_the_documents_bytes_and_have_the_observed_lengths(message: Message, data: str, size: int) -> None:
    assert message.data() == bytes.fromhex(data)
    frame = Frame(bytes.fromhex(data), 0x20)
    assert R_SDK.decode(frame).message == message
    assert len(frame.encode()) == size


@pytest.mark.parametrize("reserved", [1, 4, 0x70])
def test_reserved_bits_that_peers_set_are_kept(reserved: int) -> None:
    value = bytes(6) + bytes((0x80 | reserved,))
    received = gimbal.Speed.decode(value)
    assert received == gimbal.Speed(0, 0, 0, reserved=reserved)
    assert received.encode() == value


def test_streams_ask_for_no_reply() -> None:
    silent = {gimbal.Push, gimbal.ShortPush, gimbal.VersionPush, gimbal.Joystick, gimbal.Dial, gimbal.Calibration}
    for cls in messages_of(gimbal):
        assert cls.cmd_type == (0x00 if cls in silent else 0x20 if cls.reply else 0x03), cls


@pytest.mark.parametrize("mode", [Mode(), Mode(FollowMode.LOCK, CenterAction.RECENTER)])
def test_a_mode_is_either_followed_or_an_action_done(mode: Mode) -> None:
    with pytest.raises(FieldError, match="give either a mode"):
        mode.check()


def test_angles_that_no_bytes_could_hold_exactly_are_rounded_to_a_tenth_of_a_degree() -> None:
    assert gimbal.Position.decode(gimbal.Position(12.34, -12.36, 0.05, time_for_action=0.96).encode()) == (
        gimbal.Position(12.3, -12.4, 0.0, time_for_action=1.0)
    )

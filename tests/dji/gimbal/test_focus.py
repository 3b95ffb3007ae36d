"""Every focus message against bytes written by hand from the tables of the document."""

from __future__ import annotations

import pytest

from teleop.dji.frame import Frame
from teleop.dji.gimbal import focus
from teleop.dji.gimbal.focus import CalibrationAction, EndpointState, Execution
from teleop.dji.gimbal.r_sdk import R_SDK
from teleop.dji.message import FieldError, Message, Opaque, Result, ReturnCode

COMMANDS = [
    (focus.Set(0x0FFF), "0e12 01 00 02 ff0f"),
    (focus.Calibrate(CalibrationAction.AUTO), "0e12 02 00 01"),
    (focus.Calibrate(CalibrationAction.MANUAL), "0e12 02 00 02"),
    (focus.Calibrate(CalibrationAction.MINIMUM), "0e12 02 00 04"),
    (focus.Calibrate(CalibrationAction.MAXIMUM), "0e12 02 00 05"),
    (focus.Calibrate(CalibrationAction.STOP), "0e12 02 00 06"),
    (focus.Get(), "0e12 15 00"),
]
REPLIES = [
    (focus.CalibrateReply(ReturnCode.OK, 0, Execution.FAILED), "0e12 00 02 00 01"),
    (focus.GetReply(ReturnCode.OK, 0, EndpointState.CALIBRATED, 4095), "0e12 00 15 00 03 ff0f0000"),
    (Result(ReturnCode.PARSE_ERROR), "0e12 01"),
]


@pytest.mark.parametrize(("message", "data"), COMMANDS)
def test_commands_are_the_documents_bytes(message: Message, data: str) -> None:
    assert message.data() == bytes.fromhex(data)
    assert R_SDK.decode(Frame(bytes.fromhex(data), message.cmd_type)).message == message
    message.check()


@pytest.mark.parametrize(("message", "data"), REPLIES)
def test_replies_are_the_documents_bytes(message: Message, data: str) -> None:
    assert b"\x0e\x12" + message.encode() == bytes.fromhex(data)
    assert R_SDK.decode(Frame(bytes.fromhex(data), 0x20)).message == message


def test_a_position_beyond_the_scale_is_received_but_not_sent() -> None:
    received = R_SDK.decode(Frame(bytes.fromhex("0e12 01 00 02 0010"))).message
    assert received == focus.Set(4096)
    with pytest.raises(FieldError, match=r"focus.set: position must be 0..4095, not 4096"):
        received.check()


def test_an_unknown_sub_id_is_kept() -> None:
    assert R_SDK.decode(Frame(bytes.fromhex("0e12 07 01"))).message == Opaque(b"\x0e\x12", b"\x07\x01")


def test_only_positions_are_a_stream() -> None:
    assert (focus.Set.cmd_type, focus.Calibrate.cmd_type, focus.Get.cmd_type) == (0x00, 0x03, 0x03)

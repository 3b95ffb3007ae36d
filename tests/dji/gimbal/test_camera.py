"""Every camera message against bytes written by hand from the tables of the document."""

from __future__ import annotations

import pytest

from teleop.dji.frame import Frame
from teleop.dji.gimbal.camera import CameraCommand, CameraState, Command, ShortCommand, Status, StatusReply
from teleop.dji.gimbal.r_sdk import R_SDK
from teleop.dji.message import FieldError, Message, Result, ReturnCode

COMMANDS = [
    (Command(CameraCommand.SHUTTER), "0d00 0100"),
    (Command(CameraCommand.STOP_SHUTTER), "0d00 0200"),
    (Command(CameraCommand.RECORD), "0d00 0300"),
    (Command(CameraCommand.STOP), "0d00 0400"),
    (Command(CameraCommand.CENTER_FOCUS), "0d00 0500"),
    (Command(CameraCommand.END_CENTER_FOCUS), "0d00 0b00"),
    (ShortCommand(CameraCommand.RECORD), "0d00 03"),
    (Status(), "0d01 01"),
]


@pytest.mark.parametrize(("message", "data"), COMMANDS)
def test_commands_are_the_documents_bytes(message: Message, data: str) -> None:
    assert message.data() == bytes.fromhex(data)
    assert R_SDK.decode(Frame(bytes.fromhex(data), message.cmd_type)).message == message
    message.check()


def test_replies() -> None:
    status = Frame(bytes.fromhex("0d01 00 02"), 0x20)
    assert R_SDK.decode(status).message == StatusReply(ReturnCode.OK, CameraState.RECORDING)
    assert len(status.encode()) == 20
    assert R_SDK.decode(Frame(bytes.fromhex("0d00 02"), 0x20)).message == Result(ReturnCode.FAILED)


def test_an_unknown_command_is_received_but_not_sent() -> None:
    received = R_SDK.decode(Frame(bytes.fromhex("0d00 0701"))).message
    assert received == Command(0x0107)
    with pytest.raises(FieldError, match=r"camera\.command: command must be one of shutter, stop_shutter, record"):
        received.check()

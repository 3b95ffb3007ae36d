"""Which message a frame is, by set, id, direction, length and constants; and that names lead back to the bytes."""

from __future__ import annotations

import json

import pytest
from hypothesis import given
from hypothesis import strategies as st

from teleop.dji.frame import Frame
from teleop.dji.gimbal import camera
from teleop.dji.gimbal import messages as gimbal
from teleop.dji.gimbal.r_sdk import R_SDK
from teleop.dji.message import FieldError, Message, Opaque, Result, ReturnCode
from teleop.dji.registry import Decoded

COMMAND, REPLY, AES = 0x03, 0x20, 0x20


def decode(text: str, cmd_type: int = COMMAND, request: str = "", encryption: int = 0) -> Decoded:
    return R_SDK.decode(Frame(bytes.fromhex(text), cmd_type, encryption=encryption), bytes.fromhex(request))


@pytest.mark.parametrize(
    ("text", "cmd_type", "message", "name"),
    [
        ("0e09 01000000", COMMAND, gimbal.Version(), "gimbal.version"),
        ("0e09 01000000 14000401", COMMAND, gimbal.VersionPush("01.04.00.20"), "gimbal.version_push"),
        ("0e0a 01 000000000000", COMMAND, gimbal.Joystick(0, 0, 0), "gimbal.joystick"),
        ("0e0a 02 0000", COMMAND, gimbal.Dial(0), "gimbal.dial"),
        ("0e0a 03 0000", COMMAND, Opaque(b"\x0e\x0a", b"\3\0\0"), "gimbal.0x0a"),
        ("0e04", COMMAND, gimbal.Limits(None), "gimbal.limits"),
        ("0e06", COMMAND, gimbal.Stiffness(None), "gimbal.stiffness"),
        ("0e0b", COMMAND, gimbal.Parameters(()), "gimbal.parameters"),
        ("0e08 01 0a00 1400 1e00", COMMAND, gimbal.ShortPush(True, False, False, 1.0, 2.0, 3.0), "gimbal.short_push"),
        ("0e08 01 0a00 1400 1e00", REPLY, gimbal.ShortPush(True, False, False, 1.0, 2.0, 3.0), "gimbal.short_push"),
        ("0e08 01 0a", REPLY, Opaque(b"\x0e\x08", b"\1\x0a"), "gimbal.push"),
        ("0e10 00", REPLY, Opaque(b"\x0e\x10", b"\0"), "gimbal.calibration"),
        ("0e00 0102", COMMAND, Opaque(b"\x0e\0", b"\1\2"), "gimbal.position"),
        ("0e55 0102", COMMAND, Opaque(b"\x0e\x55", b"\1\2"), "gimbal.0x55"),
        ("7701 02", COMMAND, Opaque(b"\x77\1", b"\2"), "0x77.0x01"),
        ("7701 02", REPLY, Opaque(b"", b"\x77\1\2"), "raw"),
        ("0e", COMMAND, Opaque(b"", b"\x0e"), "raw"),
        ("", COMMAND, Opaque(b"", b""), "raw"),
        ("0d00 03", COMMAND, camera.ShortCommand(3), "camera.short_command"),
        ("0d00 00", REPLY, Result(ReturnCode.OK), "camera.command"),
        ("0e00 00", REPLY, Result(ReturnCode.OK), "gimbal.position"),
        ("0e0e 02", REPLY, Result(ReturnCode.FAILED), "gimbal.mode"),
        ("0e02 01", REPLY, Result(ReturnCode.PARSE_ERROR), "gimbal.angles"),
        ("0e55 00 01", REPLY, Result(ReturnCode.OK, extra=b"\1"), "gimbal.0x55"),
        ("0e04", REPLY, Opaque(b"\x0e\4", b""), "gimbal.limits"),
    ],
)
def test_what_a_frame_is(text: str, cmd_type: int, message: Message, name: str) -> None:
    decoded = decode(text, cmd_type)
    assert decoded.message == message
    assert not decoded.bare
    assert R_SDK.name(decoded) == name


@pytest.mark.parametrize("cmd_type", [0x00, COMMAND, REPLY])
def test_a_push_is_known_with_and_without_the_reply_bit(cmd_type: int) -> None:
    assert isinstance(decode("0e08 01" + "00" * 21, cmd_type).message, gimbal.Push)
    assert isinstance(decode("0e10 00 06" + "00" * 6, cmd_type).message, gimbal.Calibration)


@pytest.mark.parametrize(
    ("text", "request_id", "message", "size"),
    [
        ("00 01 0a00 1400 1e00", "0e02", gimbal.AnglesReply(0, 1, 1.0, 2.0, 3.0), 24),
        ("00 0a00 1400 1e00", "0e02", gimbal.LegacyAnglesReply(0, 1.0, 2.0, 3.0), 23),
        ("00", "0e00", Result(ReturnCode.OK), 17),
        ("ff", "0d00", Result(ReturnCode.UNDEFINED), 17),
        ("02", "0e02", Result(ReturnCode.FAILED), 17),
    ],
)
def test_replies_of_old_firmware_are_read_by_their_request(
    text: str, request_id: str, message: Message, size: int
) -> None:
    assert decode(text, REPLY, request_id) == Decoded(message, bytes.fromhex(request_id), bare=True)
    assert decode(text, REPLY) == Decoded(Opaque(b"", bytes.fromhex(text)), b"")
    assert len(Frame(bytes.fromhex(text), REPLY).encode()) == size


def test_a_reply_with_set_and_id_is_what_it_says_whatever_was_asked() -> None:
    assert decode("0e00 00", REPLY, "0e02") == Decoded(Result(), b"\x0e\0")


def test_encrypted_data_is_opaque() -> None:
    assert decode("0e02 01", encryption=AES) == Decoded(Opaque(b"", b"\x0e\2\1"), b"")


@given(st.binary(max_size=40) | st.binary(max_size=30).map(b"\x0e\x12".__add__), st.booleans(), st.binary(max_size=2))
def test_name_and_fields_lead_back_to_the_bytes(data: bytes, reply: bool, request_id: bytes) -> None:
    decoded = R_SDK.decode(Frame(data, REPLY if reply else COMMAND), request_id if len(request_id) == 2 else b"")
    name = R_SDK.name(decoded)
    again = R_SDK.message(name, reply, json.loads(json.dumps(decoded.message.fields())))
    assert again == decoded.message
    assert R_SDK.command(name) == decoded.set_and_id
    assert (b"" if decoded.bare else R_SDK.command(name)) + again.encode() == data


@pytest.mark.parametrize(
    ("name", "reply", "error"),
    [
        ("gimbal.positoin", False, "no message is called 'gimbal.positoin', did you mean 'gimbal.position'?"),
        ("gimbal.0x100", False, "no message is called 'gimbal.0x100'"),
        ("0x-1.0x00", False, "no message is called '0x-1.0x00'"),
        ("gimbal.position", True, "gimbal.position: no such reply; bytes can be given as value"),
        ("gimbal.0x55", False, "gimbal.0x55: no such command; bytes can be given as value"),
    ],
)
def test_names_that_lead_nowhere(name: str, reply: bool, error: str) -> None:
    with pytest.raises(FieldError) as raised:
        R_SDK.message(name, reply, {"yaw": 1})
    assert str(raised.value).startswith(error)

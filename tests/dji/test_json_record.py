"""A frame written down and read back is the same frame, whatever is in it; what is no frame is refused."""

from __future__ import annotations

import json
from contextlib import suppress
from typing import Any

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from teleop.core.errors import TeleopError
from teleop.dji.drone import messages as drone
from teleop.dji.drone.encryption import Cipher, CipherError
from teleop.dji.drone.enums import ControlOrder
from teleop.dji.drone.onboard_sdk import M100
from teleop.dji.frame import Damage, Frame
from teleop.dji.gimbal.r_sdk import R_SDK
from teleop.dji.json_record import RecordError, Transcriber, restore

SAMPLE = Frame(bytes.fromhex("0e00 2000 3000 4000 01 14"), 0x03, 0x1122)
WRITTEN = {
    "message": "gimbal.position",
    "reply": False,
    "cmd_type": 3,
    "sequence": 4386,
    "fields": {
        "yaw": 3.2,
        "roll": 4.8,
        "pitch": 6.4,
        "absolute": True,
        "yaw_ignored": False,
        "roll_ignored": False,
        "pitch_ignored": False,
        "time_for_action": 2.0,
    },
}

prefixes = st.sampled_from([cls.set_and_id for cls in (*R_SDK.messages, *M100.messages)]) | st.binary(max_size=2)
frames = st.builds(
    Frame,
    data=st.builds(bytes.__add__, prefixes, st.binary(max_size=40)),
    cmd_type=st.integers(0, 255),
    sequence=st.integers(0, 3),  # few, so that replies meet requests
    encryption=st.sampled_from([0, 0, 0x05, 0x2D]),
    reserved=st.sampled_from([bytes(3), bytes(3), b"\1\2\3"]),
    version=st.sampled_from([0, 0, 63]),
)


def test_the_documents_sample() -> None:
    assert list(Transcriber(R_SDK).record(SAMPLE).items()) == list(WRITTEN.items())
    assert restore(R_SDK, WRITTEN) == SAMPLE.encode()


@given(st.lists(frames, max_size=12))
def test_restoring_gives_the_same_bytes(bus: list[Frame]) -> None:
    transcriber = Transcriber(R_SDK)
    for frame in bus:
        assert restore(R_SDK, json.loads(json.dumps(transcriber.record(frame)))) == frame.encode()


def test_what_is_unusual_in_a_header_is_written_down() -> None:
    record = Transcriber(R_SDK).record(Frame(b"\x01\x02", 0x20, 7, 0x2D, b"\1\2\3", 5))
    assert record == {
        "message": "raw",
        "reply": True,
        "cmd_type": 32,
        "sequence": 7,
        "version": 5,
        "reserved": "010203",
        "encryption": 0x2D,
        "fields": {"value": "0102"},
    }


def test_replies_of_old_firmware_are_named_by_the_request_before_them() -> None:
    transcriber = Transcriber(R_SDK)
    transcriber.record(Frame(b"\x0e\x02\x01", 0x03, 9))
    transcriber.record(Frame(b"\x0e\x08" + bytes(22), 0x00, 9))  # a push is no request
    reply = Frame(bytes.fromhex("00 01 0a00 1400 1e00"), 0x20, 9)
    record = transcriber.record(reply)
    assert (record["message"], record["bare"]) == ("gimbal.angles", True)
    assert record["fields"] == {"return_code": "ok", "kind": "attitude", "yaw": 1.0, "roll": 2.0, "pitch": 3.0}
    assert restore(R_SDK, record) == reply.encode()
    assert Transcriber(R_SDK).record(reply)["message"] == "raw"


KEY = Cipher(bytes(range(32)))


def key() -> Cipher:
    return KEY


def asked(session: int, sequence: int) -> Frame:
    return Frame(drone.Control(ControlOrder.OBTAIN).data(), session, sequence)


def acknowledged(session: int, sequence: int) -> Frame:
    return Frame(b"\2\0", 0x20 | session, sequence)


@given(st.lists(frames, max_size=12), st.booleans())
@example(bus=[Frame(b"\0", 2, 0), Frame(b"\x0e\0", 0x22, 0)], with_key=False)
def test_restoring_the_drones_frames_gives_the_same_bytes(bus: list[Frame], with_key: bool) -> None:
    cipher = key if with_key else None
    transcriber = Transcriber(M100, cipher)
    for frame in bus:
        record = json.loads(json.dumps(transcriber.record(frame), allow_nan=False))
        assert restore(M100, record, cipher) == frame.encode()


def test_an_acknowledgement_is_named_by_its_command_in_the_same_session_with_the_same_number() -> None:
    transcriber = Transcriber(M100)
    for frame in (asked(2, 5), asked(1, 7), asked(0, 9)):
        transcriber.record(frame)
    named = [
        transcriber.record(acknowledged(session, sequence))
        for session, sequence in ((2, 5), (1, 7), (2, 7), (3, 5), (0, 9))
    ]
    assert [record["message"] for record in named] == ["drone.control", "drone.control", "raw", "raw", "raw"]
    assert named[0] == {
        "message": "drone.control",
        "reply": True,
        "cmd_type": 0x22,
        "sequence": 5,
        "fields": {"code": "obtained"},
    }
    assert named[2]["fields"] == {"value": "0200"}
    assert restore(M100, named[0]) == acknowledged(2, 5).encode()


def test_what_was_encrypted_is_decoded_with_the_key_and_encrypted_again() -> None:
    data, encryption = KEY.encrypt(asked(2, 5).data, b"any 13 bytes.")
    frame = Frame(data, 2, 5, encryption)
    transcriber = Transcriber(M100, key)
    record = transcriber.record(frame)
    assert record == {
        "message": "drone.control",
        "reply": False,
        "cmd_type": 2,
        "sequence": 5,
        "encryption": 0x2D,
        "filling": b"any 13 bytes.".hex(),
        "fields": {"order": "obtain"},
    }
    assert transcriber.record(acknowledged(2, 5))["message"] == "drone.control"
    assert restore(M100, record, key) == frame.encode()
    with pytest.raises(RecordError, match="'filling' says that it was encrypted: give the key"):
        restore(M100, record)
    with pytest.raises(RecordError, match="'encryption' is 64, and 45 with this 'filling'"):
        restore(M100, record | {"encryption": 64}, key)
    with pytest.raises(CipherError, match="1 bytes do not fill 3 up to blocks of 16"):
        restore(M100, record | {"filling": "00"}, key)


def test_the_key_is_not_asked_for_until_something_is_encrypted() -> None:
    def missing() -> Cipher:
        raise CipherError("no library")

    transcriber = Transcriber(M100, missing)
    assert transcriber.record(asked(2, 5))["message"] == "drone.control"
    with pytest.raises(CipherError):
        transcriber.record(Frame(bytes(16), 0, 0, 0x2D))


def test_damage_keeps_its_bytes() -> None:
    record = Transcriber(R_SDK).record(Damage("no start byte", b"\x01\x02"))
    assert record == {"damage": "no start byte", "bytes": "0102"}
    assert restore(R_SDK, record) == b"\x01\x02"


@pytest.mark.parametrize(
    ("change", "error"),
    [
        ({"message": None}, "'message' must be of type str, not None"),
        ({"sequence": True}, "'sequence' must be of type int, not True"),
        ({"sequence": 70000}, "frame fields do not fit"),
        ({"fields": []}, "'fields' must be of type dict, not []"),
        ({"colour": 1}, "unknown 'colour'; there are message, reply"),
        ({"reply": True}, "'reply' is True, which 'cmd_type' 3 contradicts"),
        ({"reserved": "xy"}, "frame: reserved must be hexadecimal, not 'xy'"),
        ({"reserved": "00"}, "frame fields do not fit"),
        ({"message": "gimbal.nothing"}, "no message is called 'gimbal.nothing'"),
        ({"fields": {"yaw": 1}}, "gimbal.position: roll, pitch missing"),
        ({"fields": WRITTEN["fields"] | {"yaw": 1e300}}, "gimbal.position: yaw 1e+300 does not fit its 16 bits"),
        ({"fields": {"value": "00" * 1006}}, "a frame of 1024 bytes is too long"),
        ({"damage": "x", "bytes": 3}, "damage: bytes must be hexadecimal, not 3"),
    ],
)
def test_what_is_no_frame_is_refused(change: dict[str, Any], error: str) -> None:
    with pytest.raises(TeleopError) as raised:
        restore(R_SDK, WRITTEN | change)
    assert str(raised.value).startswith(error)


@pytest.mark.parametrize("key", ["message", "reply", "cmd_type", "sequence", "fields"])
def test_what_is_missing_is_named(key: str) -> None:
    with pytest.raises(RecordError, match=f"'{key}' is missing"):
        restore(R_SDK, {name: value for name, value in WRITTEN.items() if name != key})


@pytest.mark.parametrize("record", [None, 3, [], "text"])
def test_only_objects_are_records(record: object) -> None:
    with pytest.raises(RecordError, match="not a JSON object"):
        restore(R_SDK, record)


json_values = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=5),
    lambda inner: (
        st.lists(inner, max_size=3) | st.dictionaries(st.sampled_from(list(WRITTEN["fields"])), inner, max_size=3)
    ),
    max_leaves=6,
)


@given(st.sampled_from([cls.name for cls in R_SDK.messages]), st.booleans(), st.data())
def test_anything_else_raises_nothing_but_our_errors(name: str, reply: bool, data: st.DataObject) -> None:
    names = {field.name for cls in R_SDK.messages if cls.name == name for field in cls.layout.fields}
    fields = data.draw(st.dictionaries(st.sampled_from(sorted(names | {"extra", "value"})), json_values, max_size=6))
    record = {"message": name, "reply": reply, "cmd_type": 0x20 if reply else 0x03, "sequence": 0, "fields": fields}
    with suppress(TeleopError):
        restore(R_SDK, record)


def test_a_client_that_never_counts_up_is_understood() -> None:
    """It asks for a reply to what has none, under the same number as its question; the reply is bare."""
    transcriber = Transcriber(R_SDK)
    for data in ("0e02 01", "0e0a 01 000000000000", "0e12 01 00 02 ff00"):
        transcriber.record(Frame(bytes.fromhex(data), 0x03, 0x1122))
    record = transcriber.record(Frame(bytes.fromhex("00 01 0a00 1400 1e00"), 0x20, 0x1122))
    assert (record["message"], record["fields"]["yaw"], record["bare"]) == ("gimbal.angles", 1.0, True)


@pytest.mark.parametrize("data", ["0e04", "0e06", "0e0b"])
def test_questions_without_data_are_written_down_and_read_back(data: str) -> None:
    frame = Frame(bytes.fromhex(data), 0x03, 7)
    record = Transcriber(R_SDK).record(frame)
    assert "value" not in record["fields"]
    assert restore(R_SDK, record) == frame.encode()

"""What holds for every message class, and the errors; each class's own bytes are in the tests of its module."""

from __future__ import annotations

import dataclasses
import json
import math
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from teleop.dji.drone import broadcast
from teleop.dji.drone.onboard_sdk import A3, M100
from teleop.dji.drone.virtual_rc import Sticks, VirtualRc
from teleop.dji.fields import Flag, Number, Reserved
from teleop.dji.float_fields import Text
from teleop.dji.gimbal.messages import (
    AngleKind,
    Angles,
    Calibrate,
    Parameter,
    Parameters,
    Position,
    SetParameters,
    Speed,
)
from teleop.dji.gimbal.r_sdk import R_SDK
from teleop.dji.gimbal.tlv import OptionalByte
from teleop.dji.message import FieldError, Message, Opaque, Result, ReturnCode

PARTS = [part.cls for part in broadcast.PARTS.values() if isinstance(part, broadcast.Several)]
CLASSES = [*R_SDK.messages, Result, *dict.fromkeys((*M100.messages, *A3.messages)), *PARTS]
NOTHING_BEHIND = {Parameters, VirtualRc, Sticks}  # any byte more is one more id, or another message
every_class = pytest.mark.parametrize("cls", CLASSES, ids=lambda cls: f"{cls.__module__}.{cls.__name__}")
POSITION = Position(1.5, -2.0, 3.1, time_for_action=0.4)


def least(wire: Any) -> Any:
    """Something that may be sent."""
    if not isinstance(wire, Number):
        return None if isinstance(wire, OptionalByte) else ()
    if isinstance(wire, Text):
        return ""
    return next(iter(wire.words)) if wire.words else wire.from_wire(0) if wire.low is None else wire.low


def allowed(cls: type[Message]) -> st.SearchStrategy[dict[str, Any]]:
    """Fields that the document allows, on the wire's own grid."""

    def one(wire: Any) -> st.SearchStrategy[Any]:
        if isinstance(wire, Flag):
            return st.booleans()
        if isinstance(wire, Reserved):
            return st.just(0)
        if isinstance(wire, OptionalByte):
            return st.sampled_from(list(wire.words))  # absent, with something behind it, is not absent
        if not isinstance(wire, Number):
            return st.just(())
        if isinstance(wire, Text):
            return st.text(st.characters(min_codepoint=1, max_codepoint=255), max_size=wire.size)
        if wire.words:
            return st.sampled_from(list(wire.words))
        if wire.low is None or wire.high is None:
            return st.integers(0, 255).map(wire.from_wire)
        return st.integers(round(wire.low * wire.scale), round(wire.high * wire.scale)).map(wire.from_wire)

    return st.fixed_dictionaries({field.name: one(field.wire) for field in cls.layout.fields})


@every_class
@settings(max_examples=40)  # for each of some 40 classes
@given(value=st.binary(max_size=40), data=st.data())
def test_encoding_what_was_decoded_gives_the_same_bytes(cls: type[Message], value: bytes, data: st.DataObject) -> None:
    fitting = cls(**data.draw(allowed(cls))).encode()
    for candidate in (value, fitting + value, fitting[: len(value)]):
        assert cls.decode(candidate).encode() == candidate


@every_class
@settings(max_examples=40)  # for each of some 40 classes
@given(data=st.data())
def test_what_the_document_allows_survives_wire_and_json(cls: type[Message], data: st.DataObject) -> None:
    tails = [b""] if cls in NOTHING_BEHIND else [b"", b"\xff"]
    sent = cls(**data.draw(allowed(cls)), extra=data.draw(st.sampled_from(tails)))
    assert cls.decode(sent.encode()) == sent
    assert cls.from_fields(json.loads(json.dumps(sent.fields()))) == sent


@every_class
@settings(max_examples=40)  # for each of some 40 classes
@given(value=st.binary(min_size=1, max_size=40))
def test_json_carries_whatever_was_decoded(cls: type[Message], value: bytes) -> None:
    received = cls.decode(value)
    if not isinstance(received, Opaque):
        assert cls.from_fields(json.loads(json.dumps(received.fields()))) == received


@given(st.integers(0, 7))
def test_a_value_that_is_too_short_is_opaque_and_shows_no_field(length: int) -> None:
    value = POSITION.encode()[:length]
    received = Position.decode(value)
    assert received == Opaque(b"\x0e\x00", value)
    assert received.fields() == {"value": value.hex()}


def test_messages_are_frozen() -> None:
    with pytest.raises(dataclasses.FrozenInstanceError):
        setattr(POSITION, "yaw", 3)  # noqa: B010, as pyright refuses the plain assignment


@pytest.mark.parametrize(
    ("sent", "error"),
    [
        (Position(200, 0, 0), "gimbal.position: yaw must be -180..180 deg, not 200"),
        (Position(math.nan, 0, 0), "gimbal.position: yaw must be -180..180 deg, not nan"),
        (Position(0, 0, -56.1), "gimbal.position: pitch must be -56..146 deg, not -56.1"),
        (Position(0, 0, 0, time_for_action=25.6), "gimbal.position: time_for_action must be 0.1..25.5 s, not 25.6"),
        (Position(0, 0, 0, time_for_action=0.04), "gimbal.position: time_for_action must be 0.1..25.5 s, not 0.04"),
        (Position(0, 0, 0, reserved=0x10), "gimbal.position: reserved must be 0, not 16"),
        (Speed(0, -360.1, 0), "gimbal.speed: roll must be -360..360 deg/s, not -360.1"),
        (Angles(7), "gimbal.angles: kind must be one of none, attitude, joint, not 7"),
    ],
)
def test_what_the_document_does_not_allow_is_not_sent(sent: Message, error: str) -> None:
    with pytest.raises(FieldError) as raised:
        sent.check()
    assert str(raised.value) == error


@pytest.mark.parametrize(
    ("cls", "field", "wire"),
    [
        (cls, field.name, field.wire)
        for cls in CLASSES
        for field in cls.layout.fields
        if isinstance(field.wire, Number) and field.wire.low is not None
    ],
)
def test_both_ends_of_every_range_may_be_sent_and_one_step_beyond_may_not(
    cls: type[Message], field: str, wire: Number
) -> None:
    assert wire.low is not None
    assert wire.high is not None
    assert wire.accepts(wire.low)
    assert wire.accepts(wire.high)
    usual: dict[str, Any] = {other.name: least(other.wire) for other in cls.layout.fields}
    for beyond in (wire.low - 1 / wire.scale, wire.high + 1 / wire.scale):
        with pytest.raises(FieldError, match=field):
            cls(**{**usual, field: beyond}).check()


@pytest.mark.parametrize(
    ("sent", "error"),
    [
        (Position(3276.8, 0, 0), "gimbal.position: yaw 3276.8 does not fit its 16 bits"),
        (Position(0, math.nan, 0), "gimbal.position: roll nan does not fit its 16 bits"),
        (Position(0, 0, math.inf), "gimbal.position: pitch inf does not fit its 16 bits"),
        (Position(0, 0, 0, time_for_action=25.6), "gimbal.position: time_for_action 25.6 does not fit its 8 bits"),
        (Calibrate(type=128), "gimbal.calibrate: type 128 does not fit its 7 bits"),
        (SetParameters((Parameter(1, bytes(256)),)), "gimbal.set_parameters: parameters (Parameter(id=1, value="),
        (Speed(0, 0, 0, reserved=0x80), "gimbal.speed: reserved must leave the other fields' bits alone"),
    ],
)
def test_what_does_not_fit_its_bytes_is_not_encoded(sent: Message, error: str) -> None:
    with pytest.raises(FieldError) as raised:
        sent.encode()
    assert str(raised.value).startswith(error)


@pytest.mark.parametrize(
    ("fields", "error"),
    [
        ({"yaw": 1, "roll": 2}, "gimbal.position: pitch missing"),
        ({"yaww": 1}, "gimbal.position: no field 'yaww', did you mean 'yaw'?"),
        ({"yaw": "a"}, "gimbal.position: yaw must be -180..180 deg, not 'a'"),
        ({"yaw": True}, "gimbal.position: yaw must be -180..180 deg, not True"),
        ({"yaw": None}, "gimbal.position: yaw must be -180..180 deg, not None"),
        ({"absolute": 1}, "gimbal.position: absolute must be true or false, not 1"),
        ({"extra": "0"}, "gimbal.position: extra must be hexadecimal, not '0'"),
    ],
)
def test_fields_that_cannot_be_read_are_named(fields: dict[str, Any], error: str) -> None:
    with pytest.raises(FieldError) as raised:
        Position.from_fields(fields)
    assert str(raised.value) == error


def test_fields_as_an_operator_types_them() -> None:
    typed = {"yaw": "1.5", "roll": "-2", "pitch": "3.1", "absolute": "no", "time_for_action": ".4"}
    assert Position.from_fields(typed) == dataclasses.replace(POSITION, absolute=False)
    assert Angles.from_fields({"kind": "Joint"}) == Angles.from_fields({"kind": "0x02"}) == Angles(AngleKind.JOINT)


def test_words_stand_for_numbers_and_unknown_numbers_stay() -> None:
    assert Result.decode(b"\x02") == Result(ReturnCode.FAILED)
    assert Result.decode(b"\x02").fields() == {"return_code": "failed"}
    assert Result.decode(b"\x30\x01").fields() == {"return_code": 0x30, "extra": "01"}

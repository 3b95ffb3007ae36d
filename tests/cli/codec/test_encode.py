"""JSON lines to bytes: blank lines are passed over, a line that cannot be encoded is named and ends it."""

from __future__ import annotations

import pytest

from teleop.cli.codec.decode import decode_hex
from teleop.cli.codec.encode import encode_lines
from teleop.dji.frame import pieces
from teleop.dji.gimbal import messages as gimbal
from teleop.dji.gimbal.r_sdk import R_SDK
from teleop.dji.gimbal.session import Session
from teleop.dji.json_record import RecordError

FRAME = Session().command(gimbal.Speed(1.0, 2.0, 3.0, take_over=True, ignore_focal_length=True))
(LINE,) = decode_hex([FRAME.hex()], R_SDK)


def test_a_line_becomes_the_bytes_it_came_from():
    assert list(encode_lines([LINE, "", "  \n", LINE], R_SDK)) == [FRAME.hex()] * 2


def test_for_a_can_bus_there_is_a_line_for_each_piece():
    lines = list(encode_lines([LINE], R_SDK, can=True))
    assert lines == [piece.hex() for piece in pieces(FRAME)]
    assert len(lines) > 1
    assert all(len(line) <= 16 for line in lines)


def test_damage_becomes_its_bytes():
    (damage,) = decode_hex(["aa01"], R_SDK)
    assert "damage" in damage
    assert list(encode_lines([damage], R_SDK)) == ["aa01"]


@pytest.mark.parametrize(
    ("line", "error"),
    [
        ('{"message": ', r"line 3: not JSON: .* at column 13"),
        (LINE.replace("gimbal.speed", "gimbal.sped"), r"line 3: .*gimbal\.sped"),
        (LINE.replace('"yaw": 1.0', '"yaw": 9999'), r"line 3: .*yaw"),
    ],
)
def test_the_first_line_that_cannot_be_encoded_is_named_by_its_number(line: str, error: str):
    lines = encode_lines([LINE, "", line, LINE], R_SDK)
    assert next(lines) == FRAME.hex()
    with pytest.raises(RecordError, match=error):
        next(lines)

"""Floats and texts: every bit survives wire and JSON, and JSON stays JSON."""

from __future__ import annotations

import json
import math
import struct
from typing import Any

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from teleop.dji.float_fields import F32, F64, Float, Nan, Text

WORD = Text("4s")
TILT = F32(unit="deg", low=-30, high=30)


def strict_json(value: Any) -> Any:
    return json.loads(json.dumps(value, allow_nan=False))


@given(st.integers(0, 0xFFFFFFFF))
@example(0x7FC00000)
@example(0x7F800001)  # signalling
@example(0xFFC00001)
@example(0x7F800000)
@example(0x80000000)
def test_every_float_of_32_bits_survives(bits: int) -> None:
    value = F32().from_wire(bits)
    assert F32().to_wire(value) == bits
    assert F32().to_wire(F32().from_json(strict_json(F32().to_json(value)))) == bits


@given(st.integers(0, 0xFFFFFFFFFFFFFFFF))
@example(0x7FF0000000000001)
@example(0xFFF8000000000000)
def test_every_float_of_64_bits_survives(bits: int) -> None:
    value = F64().from_wire(bits)
    assert F64().to_wire(value) == bits
    assert F64().to_wire(F64().from_json(strict_json(F64().to_json(value)))) == bits


@pytest.mark.parametrize(
    ("bits", "written"),
    [(0x3FC00000, 1.5), (0x7FC00000, "nan"), (0x7FC00001, "nan:0x7fc00001"), (0xFF800000, "-inf")],
)
def test_what_json_says(bits: int, written: Any) -> None:
    assert F32().to_json(F32().from_wire(bits)) == written


def test_nans_are_equal_by_their_bits() -> None:
    assert Nan(1) == Nan(1) != Nan(2)
    assert len({Nan(1), Nan(1)}) == 1
    assert math.isnan(Nan(1))


@pytest.mark.parametrize("written", ["ten", "", True, None, [1], "nan:zz", "nan:0x0", "inf:0x1"])
def test_what_is_no_float(written: Any) -> None:
    with pytest.raises((ValueError, TypeError)):
        F32().from_json(written)


@pytest.mark.parametrize(
    ("wire", "value", "accepted"),
    [
        (TILT, 30, True),
        (TILT, 30.0000001, True),  # which is 30 on the wire
        (TILT, 30.01, False),
        (TILT, math.nan, False),
        (F32(), math.inf, False),
        (F32(), 1e39, False),
        (F32(low=0), 1e38, True),
        (F32(low=0), -0.1, False),
        (F64(), 1e300, True),
        (F32(), "1", False),
    ],
)
def test_what_may_be_sent(wire: Float, value: Any, accepted: bool) -> None:
    assert wire.accepts(value) is accepted


def test_what_a_float_must_be() -> None:
    requirements = [wire.requirement() for wire in (TILT, F32(unit="m", low=0), F32(unit="m"), F32())]
    assert requirements == ["-30..30 deg", "a number of at least 0, m", "a number, m", "a number"]


@given(st.binary(min_size=4, max_size=4))
def test_every_text_survives(data: bytes) -> None:
    (raw,) = struct.unpack("4s", data)
    text = WORD.from_wire(raw)
    assert struct.pack("4s", WORD.to_wire(WORD.from_json(strict_json(text)))) == data


@pytest.mark.parametrize("value", ["fives", "a\0", "\u0100", 3, None])
def test_what_is_no_text_for_its_bytes(value: Any) -> None:
    assert not WORD.holds(value)
    assert not WORD.accepts(value)

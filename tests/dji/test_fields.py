"""Single fields: what JSON and operators may write for them, and how each says what it must be."""

from __future__ import annotations

import math
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from teleop.dji.fields import I16, U8, Bits, DottedVersion, Flag, Number, Reserved
from teleop.dji.gimbal.enums import AngleKind

DECIDEGREES = I16(scale=10, unit="deg", low=-180, high=180)
COUNT = U8(low=0, high=100, unit="%")
KIND = U8(words=AngleKind)


@pytest.mark.parametrize(
    ("wire", "written", "value"),
    [
        (DECIDEGREES, 12, 12),
        (DECIDEGREES, "-1.5e1", -15.0),
        (COUNT, 7.0, 7),
        (COUNT, " 0x10 ", 16),
        (KIND, "joint", AngleKind.JOINT),
        (KIND, "ATTITUDE", AngleKind.ATTITUDE),
        (KIND, 2, AngleKind.JOINT),
        (KIND, 77, 77),
        (Flag(), "on", True),
        (Flag(), "No", False),
        (Flag(), True, True),
        (DottedVersion(), "1.4.0.20", "1.4.0.20"),
    ],
)
def test_what_may_be_written(wire: Number, written: Any, value: Any) -> None:
    assert wire.from_json(written) == value
    assert type(wire.from_json(written)) is type(value)


@pytest.mark.parametrize(
    ("wire", "written"),
    [
        (DECIDEGREES, "ten"),
        (DECIDEGREES, True),
        (DECIDEGREES, None),
        (DECIDEGREES, [1]),
        (COUNT, 7.5),
        (COUNT, "7.5"),
        (COUNT, math.nan),
        (KIND, "both"),
        (Flag(), 1),
        (Flag(), "maybe"),
        (DottedVersion(), "1.4.0"),
        (DottedVersion(), "1.4.0.256"),
        (DottedVersion(), 14),
    ],
)
def test_what_may_not_be_written(wire: Number, written: Any) -> None:
    with pytest.raises(ValueError):
        wire.from_json(written)


@pytest.mark.parametrize(
    ("wire", "requirement"),
    [
        (DECIDEGREES, "-180..180 deg"),
        (I16(scale=10, unit="deg"), "a number, deg"),
        (COUNT, "0..100 %"),
        (U8(), "a whole number"),
        (U8(low=254, high=254), "254"),
        (KIND, "one of none, attitude, joint"),
        (Flag(), "true or false"),
        (Reserved(), "0"),
        (DottedVersion(), "a version such as 01.04.00.20"),
    ],
)
def test_what_a_value_must_be(wire: Number, requirement: str) -> None:
    assert wire.requirement() == requirement


@given(st.integers(0, 0xFFFFFFFF))
def test_a_version_is_its_four_bytes(number: int) -> None:
    text = DottedVersion().from_wire(number)
    assert DottedVersion().to_wire(text) == number
    assert [int(part) for part in text.split(".")] == list(number.to_bytes(4, "big"))


def test_a_range_is_judged_as_rounded_for_the_wire() -> None:
    assert DECIDEGREES.accepts(180.0000001)
    assert DECIDEGREES.accepts(-180.04)
    assert not DECIDEGREES.accepts(180.06)
    assert not any(map(DECIDEGREES.accepts, (math.nan, math.inf, -math.inf)))


@pytest.mark.parametrize(
    ("wire", "fits", "beyond"),
    [(DECIDEGREES, 3276.7, 3276.8), (DECIDEGREES, -3276.8, math.inf), (U8(), 255, 256), (Bits(width=7), 127, 128)],
)
def test_what_fits_the_bytes(wire: Number, fits: float, beyond: float) -> None:
    assert wire.holds(fits)
    assert not wire.holds(beyond)

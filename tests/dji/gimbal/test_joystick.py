"""The document's formula at its corners, and both of its mappings."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from teleop.dji.gimbal.joystick import X_TO_ROLL, X_TO_YAW, deflection, push
from teleop.dji.gimbal.messages import Joystick
from teleop.dji.message import FieldError


@pytest.mark.parametrize(
    ("adc", "middle", "adc_range", "value"),
    [
        (2048, 2048, 2048, 0),
        (4096, 2048, 2048, 15000),
        (0, 2048, 2048, -15000),
        (3072, 2048, 2048, 7500),
        (2049, 2048, 2048, 7),  # 7.32
        (2050, 2048, 2048, 15),  # 14.65
        (2047, 2048, 2048, -7),
        (5000, 2048, 2048, 15000),
        (-900, 2048, 2048, -15000),
        (0.5, 0, 1, 7500),
    ],
)
def test_deflection(adc: float, middle: float, adc_range: float, value: int) -> None:
    assert deflection(adc, middle, adc_range) == value


@given(st.integers(-(10**6), 10**6), st.integers(-(10**6), 10**6), st.integers(1, 10**6))
def test_deflection_is_odd_and_never_beyond_full(distance: int, middle: int, adc_range: int) -> None:
    value = deflection(middle + distance, middle, adc_range)
    assert -15000 <= value <= 15000
    assert deflection(middle - distance, middle, adc_range) == -value


@pytest.mark.parametrize("adc_range", [0, -1, float("nan")])
def test_a_range_that_is_not_positive_is_refused(adc_range: float) -> None:
    with pytest.raises(FieldError, match="adc_range must be positive"):
        deflection(1, 0, adc_range)


def test_mappings_of_the_document() -> None:
    sticks = {"x": 100, "y": -200}
    assert push(sticks) == push(sticks, X_TO_YAW) == Joystick(pitch=-200, roll=0, yaw=100)
    assert push(sticks, X_TO_ROLL) == Joystick(pitch=-200, roll=100, yaw=0)
    assert push({"z": 5}, {"yaw": "z"}) == Joystick(pitch=0, roll=0, yaw=5)


@pytest.mark.parametrize(("mapping", "axis"), [({"yaw": "z"}, "z"), ({"pan": "x"}, "pan")])
def test_axes_that_are_not_there_are_named(mapping: dict[str, str], axis: str) -> None:
    with pytest.raises(FieldError, match=f"no axis {axis}"):
        push({"x": 1}, mapping)

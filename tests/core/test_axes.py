"""Axes: what each is measured in, and which of them are limited."""

from __future__ import annotations

import math

import pytest

from teleop.core.axes import STICKS, Axis, Limits


@pytest.mark.parametrize("axis", Axis)
def test_an_axis_is_an_angle_in_degrees_or_a_share_without_a_unit(axis: Axis):
    assert axis.is_angle == (axis.value in ("pan", "tilt", "roll"))
    assert axis.unit == ("deg" if axis.is_angle else "")
    assert axis.is_stick == axis.value.startswith("stick_")
    assert not (axis.is_angle and axis.is_stick)


def test_sticks_are_in_the_order_of_the_channels():
    assert [axis.value for axis in STICKS] == ["stick_roll", "stick_pitch", "stick_throttle", "stick_yaw"]


def test_a_gentler_axis_keeps_its_soft_limits():
    assert Limits(-30, 60, 40, 80, 400).scaled(0.5) == Limits(-30, 60, 20, 40, 200)


@pytest.mark.parametrize(
    ("low", "high", "continuous"), [(-math.inf, math.inf, True), (-180, 180, False), (-math.inf, 9, False)]
)
def test_only_an_axis_without_both_soft_limits_is_continuous(low: float, high: float, continuous: bool):
    assert Limits(low, high, 1, 1, 1).continuous is continuous

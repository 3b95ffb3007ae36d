"""Colors, units and key names that pages and pictures share."""

from __future__ import annotations

import pytest

from teleop.core.axes import Axis
from teleop.plots.style import COLORS, UNIT_SIGNS, mark


def test_every_axis_has_a_color_of_its_own_and_a_unit_sign() -> None:
    assert set(COLORS) == set(Axis)
    assert len(set(COLORS.values())) == len(Axis)
    assert {axis.unit for axis in Axis} == set(UNIT_SIGNS)


@pytest.mark.parametrize(
    ("where", "name"), [("key 3", "3"), ("include 1, key 2", "1.2"), ("shot 12", "12"), ("include 2, shot 4", "2.4")]
)
def test_a_diamond_has_the_number_of_its_key(where: str, name: str) -> None:
    assert mark(where) == name

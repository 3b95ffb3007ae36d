"""A hat: its rest, and the direction that a press of it means."""

from __future__ import annotations

import pytest

from teleop.inputs.hid.descriptor.report import Control
from teleop.inputs.hid.hat import Hat


def at(value: int, low: int = 0, high: int = 7, null: bool = False) -> Control:
    return Control(0, 1, 0x39, "Hat switch", value, low, high, False, null)


def test_the_first_direction_counts_until_the_hat_is_back_at_rest() -> None:
    hat = Hat()
    firsts = []
    for value in (8, 0, 1, 2, 8, 2, 1, 0, 8):
        hat.angle(at(value, null=value == 8))
        firsts.append(hat.first)
    assert firsts == ["", "up", "up", "up", "", "right", "right", "right", ""]


def test_a_diagonal_straight_from_rest_means_neither_direction() -> None:
    hat = Hat()
    assert (hat.angle(at(1)), hat.first) == (45, "")
    assert (hat.angle(at(2)), hat.first) == (90, "right")


@pytest.mark.parametrize(
    ("low", "high", "rest", "up", "left"),
    [
        (0, 7, 8, 0, 6),
        (1, 8, 0, 1, 7),
        (0, 8, 8, 0, 6),
        (0, 8, 0, 1, 7),
        (0, 15, 15, 0, 6),
        (0, 3, 4, 0, 3),
        (0, 4, 4, 0, 3),
    ],
)
def test_its_rest_is_what_it_reports_first_where_the_descriptor_leaves_it_open(
    low: int, high: int, rest: int, up: int, left: int
) -> None:
    hat = Hat()
    assert [hat.angle(at(value, low, high)) for value in (rest, up, left, rest)] == [None, 0, 270, None]


def test_one_that_is_held_while_it_is_plugged_in_points_nowhere_until_its_rest_is_seen() -> None:
    hat = Hat()
    assert [hat.angle(at(value, 0, 8)) for value in (2, 3, 8, 2)] == [None, None, None, 90]

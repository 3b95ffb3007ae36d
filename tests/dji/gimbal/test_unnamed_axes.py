"""The axes that a command leaves out: ignored where it gives angles, at rest where it gives speeds."""

from __future__ import annotations

import pytest

from teleop.dji.gimbal.unnamed_axes import ignoring, resting, unnamed


@pytest.mark.parametrize(
    ("fields", "left_out"),
    [
        ({"yaw": 10}, ["roll", "pitch"]),
        ({"pitch": 0, "roll": 0}, ["yaw"]),
        ({"yaw": 1, "roll": 2, "pitch": 3}, []),
        ({"absolute": False}, []),  # no axis at all: that they are missing is an error for others to find
    ],
)
def test_only_a_command_that_names_an_axis_leaves_others_out(fields: dict[str, float], left_out: list[str]) -> None:
    assert list(unnamed(fields)) == left_out


def test_an_axis_without_an_angle_is_ignored() -> None:
    assert ignoring({"roll": 5, "absolute": True}) == {
        "roll": 5,
        "absolute": True,
        "yaw": 0.0,
        "yaw_ignored": True,
        "pitch": 0.0,
        "pitch_ignored": True,
    }


def test_what_an_operator_gives_comes_before_what_is_filled_in() -> None:
    assert ignoring({"yaw": 5, "roll_ignored": False})["roll_ignored"] is False


def test_an_axis_without_a_speed_rests() -> None:
    assert resting({"pitch": -3}) == {"pitch": -3, "yaw": 0, "roll": 0}
    assert resting({}) == {}

"""A frame's record as people read it: direction, units, and values in words."""

from __future__ import annotations

from typing import Any

import pytest

from teleop.cli.codec.format_message import in_units, line
from teleop.dji.drone.movement import COMBINATIONS, Combination, Move, ReferenceFrame, Vertical

SPEED = {"yaw": 1.0, "roll": 0.0, "pitch": -2.5, "take_over": True}


def record(message: str = "gimbal.speed", fields: dict[str, Any] = SPEED, reply: bool = False) -> dict[str, Any]:
    return {"time": 1.5, "direction": "to gimbal", "message": message, "reply": reply, "fields": fields}


def test_a_line_has_the_time_the_direction_the_message_and_its_fields_with_units():
    shown = "    1.500 -> gimbal.speed, yaw 1 deg/s, roll 0 deg/s, pitch -2.5 deg/s, take_over true"
    assert line(record()) == shown
    assert line({**record(), "direction": "from gimbal", "reply": True}).startswith("    1.500 <- gimbal.speed reply")


def test_damage_is_told_with_its_bytes():
    damage = {"time": 0.0, "direction": "from drone", "damage": "bad CRC", "bytes": "aa01"}
    assert line(damage) == "    0.000 <- damage: bad CRC: aa01"


@pytest.mark.parametrize(
    ("value", "shown"),
    [
        (None, "absent"),
        (False, "false"),
        (0.1, "0.1"),
        ([1, 2.5], "1,2.5"),
        ([], "none"),
        ([{"id": 3, "value": "0a"}], "3:0a"),
        ("follow", "follow"),
    ],
)
def test_values_are_shown_as_they_are_typed(value: object, shown: str):
    assert in_units(record("unknown", {"x": value})) == {"x": shown}


def test_the_fields_of_a_part_are_named_by_it():
    assert in_units(record("drone.broadcast", {"rc": {"roll": 12, "pitch": -1}})).keys() == {"rc.roll", "rc.pitch"}


@pytest.mark.parametrize("combination", COMBINATIONS)
def test_the_four_numbers_of_a_movement_have_the_units_of_its_mode(combination: Combination):
    height = 10 if combination.vertical == Vertical.THRUST else 0
    move = Move(
        False, ReferenceFrame.GROUND, combination.yaw, combination.vertical, combination.horizontal, 0, 0, height, 0
    )
    shown = in_units(record(Move.name, move.fields()))
    units = {name: shown[name].partition(" ")[2] for name in ("x", "y", "z", "yaw")}
    assert units == {name: wire.unit for name, wire in combination.ranges.items()}

"""What must hold between the values of a sequence file: each rule with its place and its text."""

from __future__ import annotations

import pytest

from teleop.config.frame_rates import exact_rate
from teleop.core.axes import Axis, Limits
from teleop.planner.keyframes.keys import Key, waypoints
from teleop.sequence.rules import file_rules, rig_rules

LIMITS = {Axis.PAN: Limits(-60, 60, 120, 240, 1200)}
GOOD = {"keyframes": [{"at": 0, "pan": 0, "hold": 1}, {"at": 5, "pan": 10}]}


def with_key(index: int, **changes: object) -> dict:
    keys: list[dict[str, object]] = [dict(key) for key in GOOD["keyframes"]]
    keys[index].update(changes)
    return {"keyframes": keys}


def test_a_good_file_breaks_no_rule() -> None:
    assert list(file_rules(GOOD)) == []
    assert list(rig_rules(GOOD, LIMITS, "the rig", ["gimbal"])) == []


@pytest.mark.parametrize(
    ("data", "location", "text"),
    [
        ({}, ("keyframes",), "is missing"),
        ({"keyframes": [{"at": 0}]}, ("keyframes", 0), "has no axis (pan, tilt, roll, focus)"),
        (with_key(1, at=0), ("keyframes", 1, "at"), "must be after key 1 (0 s)"),
        (with_key(1, at=0.5), ("keyframes", 1, "at"), "must be after key 1 has held pan (until 1 s)"),
        (with_key(0, stick_yaw=0.5), ("keyframes", 0, "stick_yaw"), "must be 0 in its first key"),
        (
            {**GOOD, "include": [{"move": "x", "at": 0, "speed": "2000%"}]},
            ("include", 0, "speed"),
            "must be 1% to 1000%",
        ),
        ({**GOOD, "cues": [{"at": 0}]}, ("cues", 0), "must have one of camera, follow, recenter, send, wait"),
    ],
)
def test_each_rule_of_a_file_names_its_place(data: dict, location: tuple, text: str) -> None:
    assert [(where, said) for where, said in file_rules(data) if where == location and said.startswith(text)]


@pytest.mark.parametrize(
    ("data", "location", "text"),
    [
        (with_key(1, pan=61), ("keyframes", 1, "pan"), "must be within -60..60 (the rig), not 61"),
        (with_key(1, tilt=0), ("keyframes", 1, "tilt"), ": the rig has no tilt; it has pan"),
        (
            {**GOOD, "cues": [{"at": 0, "camera": "record"}]},
            ("cues", 0, "camera"),
            ": the rig has no camera; its sinks are gimbal",
        ),
    ],
)
def test_each_rule_of_a_rig_names_its_place(data: dict, location: tuple, text: str) -> None:
    assert list(rig_rules(data, LIMITS, "the rig", ["gimbal"])) == [(location, text)]


@pytest.mark.parametrize("data", [None, 3, [], {"keyframes": 3}, {"keyframes": [3, None]}, {"cues": {"at": 0}}])
def test_what_has_the_wrong_shape_is_left_to_the_model(data: object) -> None:
    list(file_rules(data))
    list(rig_rules(data, LIMITS, "the rig", []))


WHOLE_FRAMES = [(at, hold) for at in range(1, 97) for hold in range(1, 44)]  # 4128; rounding refused an eighth


def _held_then_key(fps: float, at: int, hold: int) -> dict:
    held = {"at": f"{at}f", "pan": 10, "hold": f"{hold}f"}
    return {"fps": fps, "keyframes": [held, {"at": f"{at + hold}f", "pan": 10}]}


def test_a_hold_may_end_exactly_on_the_next_key() -> None:
    assert [whole for whole in WHOLE_FRAMES if list(file_rules(_held_then_key(24, *whole)))] == []


@pytest.mark.parametrize("fps", [23.976, 24, 25, 29.97, 30, 59.94])
def test_a_key_where_a_hold_ends_continues_it(fps: float) -> None:
    exact, refused = exact_rate(fps), []
    for at, hold in WHOLE_FRAMES:
        held = Key(at / exact, 10, hold=hold / exact)
        points = waypoints(Axis.PAN, [Key(0, 0), held, Key((at + hold) / exact, 10), Key(500 / exact, 0)])
        if [point.rest for point in points] != [True] * 4:
            refused.append((at, hold))
    assert refused == []


def test_a_key_at_another_position_must_be_after_the_hold() -> None:
    data = _held_then_key(20, 20, 2)
    data["keyframes"][1]["pan"] = 11
    assert list(file_rules(data)) == [(("keyframes", 1, "at"), "must be after key 1 has held pan (until 1.1 s)")]

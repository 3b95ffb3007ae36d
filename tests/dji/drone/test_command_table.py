"""What a shell may send to a drone, what of it is dangerous, and what is never sent."""

from __future__ import annotations

import pytest

from teleop.dji.drone import messages as drone
from teleop.dji.drone.command_table import COMMANDS, DRONE, PLAIN, hazard, never
from teleop.dji.drone.enums import ArmOrder, ControlOrder, TaskKind
from teleop.dji.drone.movement import Horizontal, Move, ReferenceFrame, Vertical, Yaw
from teleop.dji.drone.virtual_rc import Sticks, VirtualRc
from teleop.dji.message import Message

HOVER = Move(True, ReferenceFrame.BODY, Yaw.RATE, Vertical.VELOCITY, Horizontal.VELOCITY, 0, 0, 0, 0)


@pytest.mark.parametrize(
    ("words", "data"),  # bytes as docs/protocol-facts.md has them
    [
        ("arm", "0105 01"),
        ("drone disarm", "0105 00"),
        ("take-off", "0101 00 04"),
        ("land", "0101 00 06"),
        ("return home", "0101 00 01"),
        ("obtain control", "0100 01"),
        ("release control", "0100 00"),
        ("virtual rc off", "0500 02"),
        ("photo", "0120 00"),
    ],
)
def test_plain_words_are_the_bytes_of_the_document(words: str, data: str) -> None:
    assert DRONE.find(words.split()).data() == bytes.fromhex(data)


def test_neither_what_the_drone_pushes_nor_the_message_with_the_secret_can_be_typed() -> None:
    assert {drone.Pushed, drone.Activate}.isdisjoint(COMMANDS.values())
    assert {drone.Version, drone.Frequency, drone.GimbalAngle, Move} <= set(COMMANDS.values())


@pytest.mark.parametrize("message", [VirtualRc(on=True), VirtualRc(on=True, back_to_rc=False), Sticks()])
def test_what_is_safe_only_with_a_stream_behind_it_is_never_sent(message: Message) -> None:
    assert never(message)


def test_ending_virtual_rc_and_one_movement_command_may_be_sent() -> None:
    assert never(VirtualRc(on=False)) == never(HOVER) == ""


@pytest.mark.parametrize(
    "message",
    [
        drone.Arm(ArmOrder.ARM),
        drone.Arm(ArmOrder.DISARM),
        *map(drone.Task, TaskKind),
        HOVER,
        drone.Control(ControlOrder.OBTAIN),
        VirtualRc(on=False),
    ],
    ids=str,
)
def test_whatever_moves_a_drone_or_takes_it_from_its_pilot_is_a_hazard(message: Message) -> None:
    assert hazard(message)


def test_a_hazard_says_whether_the_motors_start_or_stop() -> None:
    assert "starts" in hazard(PLAIN["drone arm"])
    assert "stops" in hazard(PLAIN["drone disarm"])


@pytest.mark.parametrize(
    "message", [drone.Version(), drone.Control(ControlOrder.RELEASE), drone.Photo(), drone.GimbalSpeed(1, 1, 1)]
)
def test_what_cannot_make_it_fly_is_none(message: Message) -> None:
    assert hazard(message) == ""

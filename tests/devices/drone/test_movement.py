"""Movement commands as a way to hold a drone: docs/protocol-facts.md, 01 00, 01 01, 01 03 and 01 05."""

from __future__ import annotations

import math

import pytest
from fake_drone_link import FakeConnection, FakeTelemetry

from teleop.core.axes import STICKS
from teleop.devices.drone.movement import MovementControl
from teleop.devices.drone.preflight import Site
from teleop.dji.drone import messages as drone
from teleop.dji.drone.broadcast_parts import Position, Quaternion
from teleop.dji.drone.enums import ArmCode, FlightStatus
from teleop.dji.drone.movement import Combination, Horizontal, Move, ReferenceFrame, Vertical, Yaw

CENTERED = dict.fromkeys(STICKS, 0.0)
FORWARD = CENTERED | {STICKS[1]: 0.5}
VELOCITY = Combination(Horizontal.VELOCITY, Vertical.VELOCITY, Yaw.RATE)
PLACE = Combination(Horizontal.VELOCITY, Vertical.POSITION, Yaw.ANGLE)
HALF = math.sqrt(0.5)


class Bench:
    """A drone that reports standby, 12 m high with its nose to the east."""

    def __init__(self, combination: Combination = VELOCITY) -> None:
        self.link, self.now = FakeConnection(), 10.0
        self.seen = FakeTelemetry(
            status=FlightStatus.STANDBY,
            quaternion=Quaternion(HALF, 0, 0, HALF),
            position=Position(0.0, 0.0, 40.0, 12.0, 5),
        )
        self.seen.since = self.now
        full = {"horizontal": 6.0, "vertical": 2.0, "yaw": 60.0}
        self.control = MovementControl(self.link.real, combination, ReferenceFrame.BODY, full, Site())
        self.messages: list[str] = []
        self.control.notify = self.messages.append

    def obtain(self) -> None:
        self.control.take(self.seen.real, self.now)
        self.link.answer(drone.ControlAck(2))

    def drive(self, sticks: dict) -> list[tuple[float, float, float, float]]:
        """The numbers that are streamed for these sticks: one movement, or nothing."""
        self.link.streamed.clear()
        self.control.drive(sticks, self.seen.real, self.now)
        moves = [message for message in self.link.streamed if isinstance(message, Move)]
        assert len(moves) == len(self.link.streamed)
        return [(move.x, move.y, move.z, move.yaw) for move in moves]

    def command(self, word: str) -> str:
        return self.control.tell(word, self.seen.real, self.now)


def test_nothing_is_streamed_before_control_is_confirmed() -> None:
    bench = Bench()
    bench.control.take(bench.seen.real, bench.now)
    assert bench.link.requests == [drone.Control(1)]
    assert bench.drive(FORWARD) == []
    bench.link.answer(drone.ControlAck(2))
    assert bench.drive(FORWARD) == [(3.0, 0.0, 0.0, 0.0)]


def test_centered_sticks_are_the_height_and_the_heading_it_was_taken_at() -> None:
    bench = Bench(PLACE)
    bench.obtain()
    bench.seen.parts |= {"quaternion": Quaternion(1, 0, 0, 0), "position": Position(0.0, 0.0, 40.0, 9.0, 5)}
    assert bench.drive(CENTERED) == [pytest.approx((0, 0, 12, 90))]
    bench.link.streamed.clear()
    bench.control.neutral(bench.seen.real, bench.now)
    [neutral] = bench.link.streamed
    assert isinstance(neutral, Move)
    assert (neutral.z, neutral.yaw) == (9, 0), "neutral is where it is now"


@pytest.mark.parametrize(("missing", "reason"), [("quaternion", "where it looks"), ("position", "how high it is")])
def test_it_is_not_taken_without_the_place_it_counts_from(missing: str, reason: str) -> None:
    bench = Bench(PLACE)
    assert list(bench.control.refusals(bench.seen.real, bench.now)) == []
    del bench.seen.parts[missing]
    assert any(reason in refusal for refusal in bench.control.refusals(bench.seen.real, bench.now))


def test_no_movement_breaks_a_task_off_until_a_stick_is_moved_anew() -> None:
    bench = Bench()
    bench.obtain()
    bench.drive(FORWARD)
    assert bench.command("take-off").startswith("take-off: asked for")
    assert bench.link.requests[-1] == drone.Task(4)
    assert bench.drive(FORWARD) == [], "held since before the order"
    bench.link.answer(drone.TaskAck(2))
    assert bench.drive(CENTERED) == []
    assert bench.command("take-off") == "take-off: it is under way"
    assert bench.drive(FORWARD) == [(3.0, 0.0, 0.0, 0.0)]


def test_after_a_refused_task_a_held_stick_counts_only_once_it_was_centered() -> None:
    bench = Bench()
    bench.obtain()
    bench.command("land")
    bench.link.answer(drone.TaskAck(1))
    assert bench.drive(FORWARD) == [(0.0, 0.0, 0.0, 0.0)]
    bench.drive(CENTERED)
    assert bench.drive(FORWARD) == [(3.0, 0.0, 0.0, 0.0)]


def test_tasks_are_numbered_and_a_late_answer_to_an_older_one_is_none() -> None:
    bench = Bench()
    bench.obtain()
    bench.command("land")
    bench.command("home")
    assert bench.link.requests[-2:] == [drone.Task(6, number=0), drone.Task(1, number=1)]
    bench.link.answer(drone.TaskAck(1), sequence=-2)
    assert bench.messages == []
    bench.link.answer(drone.TaskAck(2))
    assert bench.messages == ["home: started"]


def test_motors_that_this_program_started_are_stopped_before_a_take_off() -> None:
    bench = Bench()
    bench.obtain()
    assert bench.command("arm") == "arm: asked for"
    bench.link.answer(drone.ArmAck(0))
    assert bench.command("take-off") == "take-off refused: the motors run: drone disarm first"
    bench.command("disarm")
    bench.link.answer(drone.ArmAck(0))
    assert bench.command("take-off").startswith("take-off: asked for")


def test_in_the_air_motors_are_not_touched() -> None:
    bench = Bench()
    bench.obtain()
    bench.seen.parts["status"] = FlightStatus.IN_AIR
    asked = len(bench.link.requests)
    assert bench.command("disarm") == "disarm refused: the drone reports in air"
    assert len(bench.link.requests) == asked


@pytest.mark.parametrize(
    ("reply", "message"),
    [(None, "motors: no answer"), (drone.ArmAck(ArmCode.NEED_CONTROL), "motors: refused, need control")],
)
def test_a_refusal_of_arming_is_told(reply: drone.ArmAck | None, message: str) -> None:
    bench = Bench()
    bench.command("arm")
    bench.link.answer(reply)
    assert bench.messages == [message]


def test_giving_back_releases_control_and_says_that_a_task_goes_on() -> None:
    bench = Bench()
    bench.obtain()
    bench.command("land")
    bench.link.answer(drone.TaskAck(2))
    bench.control.withdraw()
    bench.control.give_back(bench.now)
    assert bench.link.requests[-1] == drone.Control(0)
    assert bench.messages[-1] == "land goes on by itself: take it over with the RC"
    assert bench.link.withdrawn == {drone.Control, drone.Task, drone.Arm}

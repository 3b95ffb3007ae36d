"""A task from its order to its end: OPENProtocol 01 01, and the flight status."""

from __future__ import annotations

from typing import Any, cast

import pytest

from teleop.core.axes import STICKS
from teleop.devices.drone.control_mode import Deflections
from teleop.devices.drone.tasks import TaskWatch, take_off_refusal
from teleop.devices.drone.telemetry import Telemetry
from teleop.dji.drone.broadcast_parts import Velocity
from teleop.dji.drone.enums import FlightStatus, TaskCode, TaskKind

CENTERED: Deflections = dict.fromkeys(STICKS, 0.0)
PUSHED: Deflections = {**CENTERED, STICKS[0]: 0.5}


class Bench:
    """A task that is ordered at 0 s, the status that the drone broadcasts, and what the operator reads."""

    def __init__(self, kind: TaskKind, answer: object = TaskCode.STARTED) -> None:
        self.messages: list[str] = []
        self.task = TaskWatch(self.messages.append)
        self.parts: dict[str, Any] = {}
        self.now = 0.0
        self.task.begin(kind, 0.0)
        self.task.answered(answer)

    def get(self, part: str, _now: float, _within: float = 1.0) -> Any:
        return self.parts.get(part)

    def run(self, seconds: float, status: FlightStatus, climb: float | None = None) -> None:
        self.parts = {"status": status, "velocity": None if climb is None else Velocity(0.0, 0.0, climb)}
        for _ in range(round(seconds * 10)):
            self.now += 0.1
            self.task.watch(cast(Telemetry, self), self.now)


@pytest.mark.parametrize(
    ("answer", "runs", "message"),
    [
        (TaskCode.STARTED, True, "land: started"),
        (TaskCode.FAILED, False, "land: refused, failed"),
        (0, False, "land: refused, 0"),  # any other answer is no success
        (None, True, "land: no answer; its status will show whether it started"),
    ],
)
def test_only_answer_2_says_that_it_has_started(answer: object, runs: bool, message: str) -> None:
    bench = Bench(TaskKind.LAND, answer)
    assert (bench.task.runs, bench.messages) == (runs, [message])


def test_a_take_off_ends_in_the_air_once_it_no_longer_climbs() -> None:
    bench = Bench(TaskKind.TAKE_OFF)
    bench.run(1.0, FlightStatus.TAKE_OFF)
    bench.run(10.0, FlightStatus.IN_AIR, climb=0.5)
    assert bench.task.runs
    bench.run(1.3, FlightStatus.IN_AIR, climb=0.0)
    assert bench.messages[-1] == "take-off: finished: the drone is in the air"


@pytest.mark.parametrize("kind", [TaskKind.LAND, TaskKind.RETURN_HOME])
def test_landing_and_returning_end_in_standby(kind: TaskKind) -> None:
    bench = Bench(kind)
    bench.run(5.0 if kind is TaskKind.RETURN_HOME else 1.0, FlightStatus.IN_AIR)
    bench.run(5.0, FlightStatus.LANDING)
    bench.run(2.0, FlightStatus.FINISH_LANDING)
    assert bench.task.runs
    bench.run(0.1, FlightStatus.STANDBY)
    assert bench.messages[-1].endswith(": finished: the drone is on the ground")


def test_a_landing_that_is_broken_off_is_interrupted() -> None:
    bench = Bench(TaskKind.LAND)
    bench.run(1.0, FlightStatus.LANDING)
    bench.run(0.1, FlightStatus.IN_AIR)
    assert bench.messages[-1] == "land: interrupted: the drone no longer lands"


def test_without_an_answer_the_status_shows_whether_it_started() -> None:
    bench = Bench(TaskKind.TAKE_OFF, None)
    bench.run(3.9, FlightStatus.STANDBY)
    assert bench.task.runs
    bench.run(0.3, FlightStatus.STANDBY)
    assert bench.messages[-1] == "take-off: not started: the drone reports standby"


def test_a_stick_ends_it_only_after_it_was_centered() -> None:
    bench = Bench(TaskKind.LAND)
    assert not bench.task.moved(PUSHED), "it was held when the task was ordered"
    assert bench.task.locks_sticks
    assert not bench.task.moved(CENTERED)
    assert not bench.task.locks_sticks
    assert bench.task.moved(PUSHED)
    assert not bench.task.runs
    assert not bench.task.moved(PUSHED), "once"


@pytest.mark.parametrize(("answer", "verb"), [(TaskCode.STARTED, "goes on"), (None, "may go on")])
def test_released_during_a_task_the_operator_reads_that_it_goes_on(answer: object, verb: str) -> None:
    assert Bench(TaskKind.LAND, answer).task.goes_on() == f"land {verb} by itself: take it over with the RC"


@pytest.mark.parametrize(
    ("status", "armed", "refusal"),
    [
        (FlightStatus.STANDBY, False, ""),
        (FlightStatus.STANDBY, True, "the motors run: drone disarm first"),
        (FlightStatus.IN_AIR, False, "the drone reports in air: its motors run"),
        (None, False, "the drone does not report its flight status"),
    ],
)
def test_a_take_off_is_ordered_only_with_the_motors_off(status: object, armed: bool, refusal: str) -> None:
    bench = Bench(TaskKind.TAKE_OFF)
    bench.parts = {"status": status}
    assert take_off_refusal(cast(Telemetry, bench), 0.0, armed) == refusal

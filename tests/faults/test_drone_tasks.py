"""Take off, land and return home on the wire: what is streamed while they run, how they end, what is said of them.

Answer 2 is a start and nothing else is (OPENProtocol.md 3.1.9, 01 01); the end is in the flight status.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path

import pytest
from drone_fault_bench import FLIGHT, READY, DroneFaultBench, drone_fault_bench

from teleop.core.operator_input import Command
from teleop.core.run_state import Result
from teleop.devices.drone.engagement import Stage
from teleop.dji.drone import messages as drone
from teleop.dji.drone.enums import ControlOrder, TaskKind
from teleop.dji.drone.movement import Move
from teleop.dji.message import Opaque
from teleop.sim.drone.controls import Pilot, Status

ORDERED = READY + 1  # s


def moves(bench: DroneFaultBench, begin: float, end: float) -> list[Move]:
    return [message for time, message in bench.of(Move) if begin < time < end]


def said_at(bench: DroneFaultBench, text: str) -> float:
    """When it was said, in s after the start."""
    [time] = [time for time, said in bench.times if said == text]
    return time


def test_nothing_is_streamed_until_a_take_off_has_ended(tmp_path: Path) -> None:
    with drone_fault_bench(tmp_path, FLIGHT) as bench:
        bench.engage_at(READY)
        bench.tell_at(ORDERED, "take-off")
        bench.quit_at(ORDERED + 12)
        bench.run()
    assert bench.said[1:4] == [
        "drone: take-off: asked for; no sticks until it ends or one is moved",
        "drone: take-off: started",
        "drone: take-off: finished: the drone is in the air",
    ]
    end = said_at(bench, bench.said[3])
    assert moves(bench, ORDERED + 0.02, end - 0.001) == []
    assert len(moves(bench, end, end + 1)) == pytest.approx(50, abs=2), "then it is held"
    pose = bench.drone.autopilot.pose
    assert pose.height == pytest.approx(1.2, abs=0.15), "it has reached its height, not hovered half-way"
    assert end - ORDERED > 3


@pytest.mark.parametrize(("word", "kind", "seconds"), [("land", TaskKind.LAND, 20), ("home", TaskKind.RETURN_HOME, 40)])
def test_it_lands_by_itself_and_is_not_flown_until_it_stands(
    word: str, kind: TaskKind, seconds: float, tmp_path: Path
) -> None:
    with drone_fault_bench(tmp_path, FLIGHT) as bench:
        bench.airborne(6.0)
        bench.engage_at(READY)
        bench.hold_at(READY + 0.5, stick_pitch=0.5)
        bench.tell_at(ORDERED + 1, word)
        bench.quit_at(ORDERED + seconds)
        bench.run()
    assert [(message.task, message.number) for _, message in bench.of(drone.Task)] == [(kind, 0)]
    assert f"drone: {word}: started" in bench.said
    end = said_at(bench, f"drone: {word}: finished: the drone is on the ground")
    assert moves(bench, ORDERED + 1.02, end - 0.001) == [], "the stick that is still held does not break it off"
    after = moves(bench, end, end + 1)
    assert after, "and when it has ended"
    assert {(m.x, m.y, m.z) for m in after} == {(0, 0, 0)}, "it has to be centered first"
    assert bench.drone.autopilot.status is Status.STANDBY
    assert not bench.drone.autopilot.flight.motors
    assert bench.ended.result is Result.DONE


@pytest.mark.parametrize(
    ("value", "said"),
    [
        (b"\1\0", "refused, failed"),
        (b"\2\xff", "refused, no rights"),
        (b"\0\0", "refused, 0"),
        (b"\5\0", "refused, 5"),
        (b"\7", "refused, unknown"),
    ],
)
def test_any_answer_but_2_is_a_refusal_and_the_sticks_go_on(value: bytes, said: str, tmp_path: Path) -> None:
    with drone_fault_bench(tmp_path, FLIGHT) as bench:
        bench.airborne()
        bench.drone._handlers[drone.Task] = lambda _message: Opaque(b"", value)
        bench.engage_at(READY)
        bench.tell_at(ORDERED, "land")
        bench.quit_at(ORDERED + 3)
        bench.run()
    assert f"drone: land: {said}" in bench.said
    assert not any("started" in text for text in bench.said)
    assert len(moves(bench, ORDERED + 0.2, ORDERED + 1.2)) == pytest.approx(50, abs=2)


@pytest.mark.parametrize(
    ("before", "said"),
    [
        (lambda bench: bench.airborne(), "the drone reports in air: its motors run"),
        (lambda bench: bench.tell_at(READY + 0.5, "arm"), "the motors run: drone disarm first"),
    ],
)
def test_a_take_off_is_not_ordered_while_the_motors_run(
    before: Callable[[DroneFaultBench], None], said: str, tmp_path: Path
) -> None:
    with drone_fault_bench(tmp_path, FLIGHT) as bench:
        before(bench)
        bench.engage_at(READY)
        bench.tell_at(ORDERED, "take-off")
        bench.quit_at(ORDERED + 2)
        bench.run()
    assert f"drone: take-off refused: {said}" in bench.said, bench.said
    assert bench.of(drone.Task) == []


def test_a_task_whose_answer_is_lost_is_seen_by_its_status(tmp_path: Path) -> None:
    with drone_fault_bench(tmp_path, FLIGHT) as bench:
        bench.engage_at(READY)
        bench.at(ORDERED - 0.1, lambda: setattr(bench.drone, "acknowledges", False))
        bench.at(ORDERED + 1, lambda: setattr(bench.drone, "acknowledges", True))
        bench.tell_at(ORDERED, "take-off")
        bench.quit_at(ORDERED + 12)
        bench.run()
    assert "drone: take-off: no answer; its status will show whether it started" in bench.said
    assert not any(text.endswith(": started") for text in bench.said), "no answer is no success"
    end = said_at(bench, "drone: take-off: finished: the drone is in the air")
    assert moves(bench, ORDERED + 0.02, end - 0.001) == []
    assert bench.drone.autopilot.pose.height > 1


def test_a_task_that_never_reached_the_drone_is_given_up_and_the_sticks_go_on(tmp_path: Path) -> None:
    with drone_fault_bench(tmp_path, FLIGHT) as bench:
        bench.engage_at(READY)
        bench.at(ORDERED - 0.01, lambda: setattr(bench.cable, "deaf", True))
        bench.at(ORDERED + 0.5, lambda: setattr(bench.cable, "deaf", False))
        bench.tell_at(ORDERED, "take-off")
        bench.quit_at(ORDERED + 8)
        bench.run()
    assert "drone: take-off: not started: the drone reports standby" in bench.said
    assert moves(bench, ORDERED + 0.02, ORDERED + 3.9) == []
    assert moves(bench, ORDERED + 5, ORDERED + 6)
    assert bench.drone.autopilot.status is Status.STANDBY


@pytest.mark.parametrize(
    ("act", "said"),
    [
        (lambda bench: bench.keys.press(Command.STOP), "STOP"),
        (lambda bench: bench.keys.press(Command.DISENGAGE), "disengaged by the operator"),
        (lambda bench: setattr(bench.pad, "trouble", "gone"), "no stick input for 1 s"),
        (lambda bench: bench.keys.press(Command.QUIT), ""),
    ],
)
@pytest.mark.parametrize(("word", "height"), [("take-off", 0.0), ("land", 8.0), ("home", 8.0)])
def test_stop_sends_no_movement_into_a_task_and_says_what_goes_on(
    word: str, height: float, act: Callable[[DroneFaultBench], None], said: str, tmp_path: Path
) -> None:
    with drone_fault_bench(tmp_path, FLIGHT) as bench:
        if height:
            bench.airborne(height)
        bench.engage_at(READY)
        bench.tell_at(ORDERED, word)
        bench.at(ORDERED + 0.5, lambda: act(bench))
        bench.quit_at(ORDERED + 6)
        bench.run(after=20.0)
    assert any(said in text for text in bench.said)
    assert f"drone: {word} goes on by itself: take it over with the RC" in bench.said, bench.said
    assert [time for time, _ in bench.of(Move) if time > ORDERED + 0.02] == []
    assert [m for _, m in bench.of(drone.Control) if m.order == ControlOrder.RELEASE]
    assert bench.drone.autopilot.pilot is Pilot.RC
    assert bench.drone.autopilot.status is (Status.IN_AIR if word == "take-off" else Status.STANDBY)
    assert not bench.drone.autopilot.flight.crashed


def test_a_stick_that_is_moved_for_it_takes_the_drone_out_of_a_task(tmp_path: Path) -> None:
    with drone_fault_bench(tmp_path, FLIGHT) as bench:
        bench.airborne(20.0)
        bench.engage_at(READY)
        bench.tell_at(ORDERED, "land")
        bench.hold_at(ORDERED + 3, stick_pitch=0.5)
        bench.hold_at(ORDERED + 5)
        bench.quit_at(ORDERED + 8)
        bench.run()
    assert "drone: land: a stick was moved: the sticks fly it again" in bench.said
    assert moves(bench, ORDERED + 0.02, ORDERED + 3) == []
    assert max(m.x for m in moves(bench, ORDERED + 3, ORDERED + 5)) == pytest.approx(2.5)
    assert bench.drone.autopilot.status is Status.IN_AIR


def test_a_landing_may_be_ordered_while_it_takes_off_and_the_newest_counts(tmp_path: Path) -> None:
    with drone_fault_bench(tmp_path, FLIGHT) as bench:
        bench.engage_at(READY)
        bench.tell_at(ORDERED, "take-off")
        bench.tell_at(ORDERED + 0.5, "take-off")
        bench.tell_at(ORDERED + 3, "land")
        bench.quit_at(ORDERED + 14)
        bench.run()
    assert "drone: take-off: it is under way" in bench.said
    assert [(m.task, m.number) for _, m in bench.of(drone.Task)] == [(TaskKind.TAKE_OFF, 0), (TaskKind.LAND, 1)]
    assert "drone: land: finished: the drone is on the ground" in bench.said


def test_heights_count_from_where_a_take_off_has_left_it(tmp_path: Path) -> None:
    with drone_fault_bench(tmp_path, FLIGHT.replace("mode", "vertical: height, yaw: angle, mode")) as bench:
        bench.drone.autopilot.flight.yaw = math.radians(80)
        bench.engage_at(READY)
        bench.tell_at(ORDERED, "take-off")
        bench.quit_at(ORDERED + 12)
        bench._fresh = lambda _seconds: True  # type: ignore[method-assign]  # a height is no zero
        bench.run()
    last = bench.of(Move)[-1][1]
    assert last.z == pytest.approx(1.15, abs=0.1), "not the ground that it was taken on"
    assert last.yaw == pytest.approx(80, abs=1)
    assert bench.drone.autopilot.pose.height > 1


def test_tilts_are_roll_and_pitch_on_the_wire_and_forward_flies_forward(tmp_path: Path) -> None:
    tilt = FLIGHT.replace("velocity-body", "tilt").replace("horizontal: 5", "horizontal: 10")
    with drone_fault_bench(tmp_path, tilt) as bench:
        bench.airborne()
        bench.engage_at(READY)
        bench.hold_at(READY + 1, stick_pitch=1.0)
        bench.at(READY + 4, lambda: bench.keys.press(Command.DISENGAGE))
        bench.quit_at(READY + 7)
        bench.run()
    flying = moves(bench, READY + 2, READY + 4)
    assert {(m.x, m.y, m.z, m.yaw) for m in flying} == {(0, -10, 0, 0)}
    pose = bench.drone.autopilot.pose
    assert pose.north > 5, "the nose is to the north"
    assert abs(pose.east) < 0.01


@pytest.mark.parametrize("throttle", [0.25, -0.25])
def test_a_climb_is_positive_in_the_state_that_views_and_takes_show(throttle: float, tmp_path: Path) -> None:
    climbs: list[float] = []

    def look(bench: DroneFaultBench) -> None:
        velocity = bench.sink.state(bench.clock.now()).velocity
        assert velocity is not None
        climbs.append(velocity[2])

    with drone_fault_bench(tmp_path, FLIGHT) as bench:
        bench.airborne()
        bench.engage_at(READY)
        bench.hold_at(READY + 1, stick_throttle=throttle)
        bench.at(READY + 6, lambda: look(bench))
        bench.quit_at(READY + 7)
        bench.run()
    assert climbs == [pytest.approx(2 * throttle, abs=0.02)]
    assert bench.sink.state(bench.clock.now()).stage == Stage.IDLE.value

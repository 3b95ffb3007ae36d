"""The same table for a drone that is flown by movement commands, with control obtained instead of virtual RC."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path

import pytest
from drone_fault_bench import FLIGHT, READY, DroneFaultBench, drone_fault_bench

from teleop.core.events import DeviceCommand
from teleop.core.operator_input import Command
from teleop.core.run_state import Result
from teleop.dji.drone import messages as drone
from teleop.dji.drone.enums import ControlCode, ControlOrder, TaskKind
from teleop.dji.drone.movement import Horizontal, Move, ReferenceFrame, Vertical, Yaw
from teleop.sim.drone.controls import Pilot, Status, Switch

BREAKS = 6.0


def orders(bench: DroneFaultBench, order: ControlOrder) -> list[float]:
    return [time for time, message in bench.of(drone.Control) if message.order == order]


def obtained_once(bench: DroneFaultBench) -> bool:
    """Control is asked for at the engagement only: twice, since the first answer is that it is in progress."""
    return all(time < READY + 0.5 for time in orders(bench, ControlOrder.OBTAIN))


def fly(bench: DroneFaultBench) -> None:
    bench.airborne()
    bench.engage_at(READY)
    bench.hold_at(READY + 1, stick_pitch=0.5, stick_yaw=-0.5)


def test_it_is_flown_by_velocities_and_given_back(tmp_path: Path) -> None:
    with drone_fault_bench(tmp_path, FLIGHT) as bench:
        fly(bench)
        bench.at(BREAKS, lambda: bench.keys.press(Command.DISENGAGE))
        bench.quit_at(BREAKS + 3)
        bench.run()
    assert bench.ended.result is Result.DONE
    moves = bench.of(Move)
    flying = [message for time, message in moves if READY + 2 < time < BREAKS]
    assert {(m.x, m.y, m.z, m.yaw) for m in flying} == {(2.5, 0, 0, -30)}
    assert {(m.horizontal, m.vertical, m.yaw_control, m.frame, m.stable) for m in flying} == {
        (Horizontal.VELOCITY, Vertical.VELOCITY, Yaw.RATE, ReferenceFrame.BODY, True)
    }
    assert len(flying) == pytest.approx(50 * (BREAKS - READY - 2), abs=2)
    assert len(orders(bench, ControlOrder.OBTAIN)) == len(orders(bench, ControlOrder.RELEASE)) == 2, "each twice"
    assert bench.pilot(BREAKS - 0.1) is Pilot.ONBOARD
    assert bench.pilot(BREAKS + 1) is Pilot.RC


@pytest.mark.parametrize(
    ("breaks", "said", "result"),
    [
        (lambda bench: setattr(bench.pad, "trouble", "gone"), "no stick input for 1 s", Result.DONE),
        (lambda bench: bench.keys.press(Command.STOP), "STOP", Result.DONE),
        (lambda bench: bench.drone.turn_switch(bench.clock.now(), Switch.P), "control was lost", Result.DONE),
        (lambda bench: bench.drone.lose_control(bench.clock.now()), "control was lost", Result.DONE),
        (lambda bench: bench.drone.set_battery(bench.clock.now(), 10), "the battery is at 10 %", Result.DONE),
        (lambda bench: bench.drone.hide("status"), "no longer reports its flight status", Result.DONE),
        (lambda bench: setattr(bench.cable, "unplugged", True), "its pilot has to take it", Result.FAILED),
        (lambda bench: bench.clock.stall(1.5), "the computer stalled", Result.FAILED),
    ],
)
def test_whatever_breaks_it_hovers_with_its_pilot(
    breaks: Callable[[DroneFaultBench], None], said: str, result: Result, tmp_path: Path
) -> None:
    with drone_fault_bench(tmp_path, FLIGHT) as bench:
        fly(bench)
        bench.at(BREAKS, lambda: breaks(bench))
        bench.quit_at(BREAKS + 4)
        bench.run()
    assert bench.ended.result is result, bench.ended.reasons
    assert any(said in text for text in (*bench.said, *bench.ended.reasons)), (bench.said, bench.ended.reasons)
    assert obtained_once(bench), "never again by itself"
    assert bench.cable.unplugged or orders(bench, ControlOrder.RELEASE)
    if not bench.cable.unplugged:
        assert bench.pilot(BREAKS + 3) is Pilot.RC
    pose = bench.drone.autopilot.pose
    assert math.hypot(pose.velocity_north, pose.velocity_east) < 0.1
    assert not bench.drone.autopilot.flight.crashed


@pytest.mark.parametrize(
    ("sink", "health", "said"),
    [
        (FLIGHT, 2, "GPS health is 2 of 5: horizontal velocities need 3, or Guidance declared in the profile"),
        (FLIGHT.replace("velocity-body", "offset-body"), 2, "GPS health is 2 of 5: horizontal positions need 3"),
        (FLIGHT.replace("velocity-body", "tilt"), 0, ""),
        (FLIGHT.replace("mode", "guidance: true, mode"), 0, ""),
    ],
)
def test_the_conditions_of_a_mode_are_checked_and_said(sink: str, health: int, said: str, tmp_path: Path) -> None:
    with drone_fault_bench(tmp_path, sink) as bench:
        bench.drone._telemetry.health = health
        bench.airborne()
        bench.engage_at(READY)
        bench.quit_at(READY + 2)
        bench.run()
    assert bool(orders(bench, ControlOrder.OBTAIN)) is not bool(said)
    if said:
        assert bench.said == [f"drone: not engaged: {said}"]


def test_a_height_near_the_ground_is_warned_of(tmp_path: Path) -> None:
    with drone_fault_bench(tmp_path, FLIGHT.replace("mode", "vertical: height, mode")) as bench:
        bench.airborne(2.0)
        bench.engage_at(READY + 3)
        bench.hold_at(READY + 4, stick_throttle=1.0)
        bench.quit_at(READY + 14)
        bench.run()
    assert "drone: below 3 m a height that is a little wrong is the ground" in bench.said
    assert max(message.z for _, message in bench.of(Move)) == pytest.approx(4.0, abs=0.1), "counted from where it was"


def test_a_heading_counts_from_where_it_looked_and_neutral_is_where_it_looks(tmp_path: Path) -> None:
    with drone_fault_bench(tmp_path, FLIGHT.replace("mode", "yaw: angle, mode")) as bench:
        bench.airborne()
        bench.drone.autopilot.flight.yaw = math.radians(170)
        bench.engage_at(READY)
        bench.hold_at(READY + 1, stick_yaw=0.5)
        bench.at(BREAKS, lambda: bench.keys.press(Command.STOP))
        bench.quit_at(BREAKS + 3)
        bench._fresh = lambda _seconds: True  # type: ignore[method-assign]  # a heading is no zero
        bench.run()
    headings = [message.yaw for time, message in bench.of(Move) if time < BREAKS]
    assert headings[0] == pytest.approx(170, abs=1)
    assert headings[-1] == pytest.approx(-160, abs=1)
    assert bench.of(Move)[-1][1].yaw == pytest.approx(-160, abs=3), "it does not turn back"
    assert math.degrees(bench.drone.autopilot.pose.yaw) == pytest.approx(-160, abs=3)


def test_what_it_does_by_itself_is_not_contradicted_until_a_stick_is_moved(tmp_path: Path) -> None:
    with drone_fault_bench(tmp_path, FLIGHT) as bench:
        bench.airborne(5.0)
        bench.engage_at(READY)
        bench.tell_at(READY + 1, "land")
        statuses: list[Status] = []
        bench.at(READY + 3, lambda: statuses.append(bench.drone.autopilot.status))
        bench.hold_at(READY + 3.5, stick_throttle=0.5)
        bench.quit_at(READY + 5)
        bench.run()
    assert [message.task for _, message in bench.of(drone.Task)] == [TaskKind.LAND]
    assert statuses == [Status.LANDING]
    silent = [time for time, _ in bench.of(Move) if READY + 1.1 < time < READY + 3.4]
    assert silent == []
    assert any(time > READY + 3.5 for time, _ in bench.of(Move))
    assert bench.drone.autopilot.status is Status.IN_AIR


def test_control_that_is_refused_is_said_and_not_asked_for_again(tmp_path: Path) -> None:
    with drone_fault_bench(tmp_path, FLIGHT) as bench:
        bench.airborne()
        refusal = drone.ControlAck(ControlCode.NOT_IN_F_MODE)
        bench.drone._handlers[drone.Control] = lambda message: refusal if message.order else None
        bench.engage_at(READY)
        bench.quit_at(READY + 5)
        bench.run()
    assert bench.said[0] == "drone: the drone refuses control: not in f mode"
    assert any("the drone does not confirm control" in text for text in bench.said)
    assert len(orders(bench, ControlOrder.OBTAIN)) == 1
    assert bench.of(Move) == []


def lost_on_the_way(bench: DroneFaultBench, seconds: float) -> None:
    """Whatever is sent now does not arrive; what is sent 40 ms later does."""
    bench.at(seconds - 0.02, lambda: setattr(bench.cable, "deaf", True))
    bench.at(seconds + 0.04, lambda: setattr(bench.cable, "deaf", False))


def test_control_that_was_released_is_not_obtained_by_an_older_request(tmp_path: Path) -> None:
    with drone_fault_bench(tmp_path, FLIGHT) as bench:
        bench.airborne()
        lost_on_the_way(bench, READY)
        bench.engage_at(READY)
        bench.at(READY + 0.1, lambda: bench.keys.press(Command.DISENGAGE))
        bench.quit_at(READY + 4)
        bench.run()
    assert len(orders(bench, ControlOrder.OBTAIN)) == len(orders(bench, ControlOrder.RELEASE)) == 1
    assert bench.drone.autopilot.pilot is Pilot.RC
    assert not bench.drone.autopilot.obtained


@pytest.mark.parametrize(
    ("then", "tasks"),
    [
        (
            lambda bench: bench.keys.press(Command.TELL, device_command=DeviceCommand("drone", "land")),
            [TaskKind.TAKE_OFF, TaskKind.LAND],
        ),
        (lambda bench: bench.keys.press(Command.STOP), [TaskKind.TAKE_OFF]),
        (lambda bench: bench.keys.press(Command.QUIT), [TaskKind.TAKE_OFF]),
        (lambda bench: setattr(bench.pad, "trouble", "gone"), [TaskKind.TAKE_OFF]),
    ],
)
def test_it_does_not_take_off_by_an_order_that_is_no_longer_in_force(
    then: Callable[[DroneFaultBench], None], tasks: list[TaskKind], tmp_path: Path
) -> None:
    with drone_fault_bench(tmp_path, FLIGHT) as bench:
        bench.engage_at(READY)
        lost_on_the_way(bench, READY + 1)
        bench.tell_at(READY + 1, "take-off")
        bench.at(READY + 1.05, lambda: then(bench))
        bench.quit_at(READY + 4)
        bench.run()
    assert [message.task for _, message in bench.of(drone.Task)] == tasks
    assert bench.drone.autopilot.status is Status.STANDBY

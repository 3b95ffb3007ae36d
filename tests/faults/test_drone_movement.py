"""The same table for a drone that is flown by movement commands, with control obtained instead of virtual RC."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path

import pytest
from sky import FLIGHT, READY, Sky, sky

from teleop.core.events import DeviceCommand
from teleop.core.operator_input import Command
from teleop.core.run_state import Result
from teleop.dji.drone import messages as drone
from teleop.dji.drone.enums import ControlCode, ControlOrder, TaskKind
from teleop.dji.drone.movement import Frame, Horizontal, Move, Vertical, Yaw
from teleop.sim.drone.controls import Pilot, Status, Switch

BREAKS = 6.0


def orders(scene: Sky, order: ControlOrder) -> list[float]:
    return [time for time, message in scene.of(drone.Control) if message.order == order]


def obtained_once(scene: Sky) -> bool:
    """Control is asked for at the engagement only: twice, since the first answer is that it is in progress."""
    return all(time < READY + 0.5 for time in orders(scene, ControlOrder.OBTAIN))


def fly(scene: Sky) -> None:
    scene.airborne()
    scene.engage_at(READY)
    scene.hold_at(READY + 1, stick_pitch=0.5, stick_yaw=-0.5)


def test_it_is_flown_by_velocities_and_given_back(tmp_path: Path) -> None:
    with sky(tmp_path, FLIGHT) as scene:
        fly(scene)
        scene.at(BREAKS, lambda: scene.keys.press(Command.DISENGAGE))
        scene.quit_at(BREAKS + 3)
        scene.run()
    assert scene.ended.result is Result.DONE
    moves = scene.of(Move)
    flying = [message for time, message in moves if READY + 2 < time < BREAKS]
    assert {(m.x, m.y, m.z, m.yaw) for m in flying} == {(2.5, 0, 0, -30)}
    assert {(m.horizontal, m.vertical, m.yaw_control, m.frame, m.stable) for m in flying} == {
        (Horizontal.VELOCITY, Vertical.VELOCITY, Yaw.RATE, Frame.BODY, True)
    }
    assert len(flying) == pytest.approx(50 * (BREAKS - READY - 2), abs=2)
    assert len(orders(scene, ControlOrder.OBTAIN)) == len(orders(scene, ControlOrder.RELEASE)) == 2, "each twice"
    assert scene.pilot(BREAKS - 0.1) is Pilot.ONBOARD
    assert scene.pilot(BREAKS + 1) is Pilot.RC


@pytest.mark.parametrize(
    ("breaks", "said", "result"),
    [
        (lambda scene: setattr(scene.pad, "trouble", "gone"), "no hand on the sticks for 1 s", Result.DONE),
        (lambda scene: scene.keys.press(Command.STOP), "everything is to stop", Result.DONE),
        (lambda scene: scene.drone.turn_switch(scene.clock.now(), Switch.P), "control was lost", Result.DONE),
        (lambda scene: scene.drone.lose_control(scene.clock.now()), "control was lost", Result.DONE),
        (lambda scene: scene.drone.set_battery(scene.clock.now(), 10), "the battery is at 10 %", Result.DONE),
        (lambda scene: scene.drone.hide("status"), "no longer says its flight status", Result.DONE),
        (lambda scene: setattr(scene.cable, "unplugged", True), "its pilot has to take it", Result.FAILED),
        (lambda scene: scene.clock.stall(1.5), "the computer stalled", Result.FAILED),
    ],
)
def test_whatever_breaks_it_hovers_with_its_pilot(
    breaks: Callable[[Sky], None], said: str, result: Result, tmp_path: Path
) -> None:
    with sky(tmp_path, FLIGHT) as scene:
        fly(scene)
        scene.at(BREAKS, lambda: breaks(scene))
        scene.quit_at(BREAKS + 4)
        scene.run()
    assert scene.ended.result is result, scene.ended.reasons
    assert any(said in text for text in (*scene.said, *scene.ended.reasons)), (scene.said, scene.ended.reasons)
    assert obtained_once(scene), "never again by itself"
    assert scene.cable.unplugged or orders(scene, ControlOrder.RELEASE)
    if not scene.cable.unplugged:
        assert scene.pilot(BREAKS + 3) is Pilot.RC
    pose = scene.drone.cockpit.pose
    assert math.hypot(pose.velocity_north, pose.velocity_east) < 0.1
    assert not scene.drone.cockpit.flight.crashed


@pytest.mark.parametrize(
    ("sink", "health", "said"),
    [
        (FLIGHT, 2, "GPS health is 2 of 5: horizontal velocities want 3, or Guidance declared in the profile"),
        (FLIGHT.replace("velocity-body", "offset-body"), 2, "GPS health is 2 of 5: horizontal positions want 3"),
        (FLIGHT.replace("velocity-body", "tilt"), 0, ""),
        (FLIGHT.replace("mode", "guidance: true, mode"), 0, ""),
    ],
)
def test_the_conditions_of_a_mode_are_checked_and_said(sink: str, health: int, said: str, tmp_path: Path) -> None:
    with sky(tmp_path, sink) as scene:
        scene.drone._beacon.health = health
        scene.airborne()
        scene.engage_at(READY)
        scene.quit_at(READY + 2)
        scene.run()
    assert bool(orders(scene, ControlOrder.OBTAIN)) is not bool(said)
    if said:
        assert scene.said == [f"drone: not engaged: {said}"]


def test_a_height_near_the_ground_is_warned_of(tmp_path: Path) -> None:
    with sky(tmp_path, FLIGHT.replace("mode", "vertical: height, mode")) as scene:
        scene.airborne(2.0)
        scene.engage_at(READY + 3)
        scene.hold_at(READY + 4, stick_throttle=1.0)
        scene.quit_at(READY + 14)
        scene.run()
    assert "drone: below 3 m a height that is a little wrong is the ground" in scene.said
    assert max(message.z for _, message in scene.of(Move)) == pytest.approx(4.0, abs=0.1), "counted from where it was"


def test_a_heading_counts_from_where_it_looked_and_neutral_is_where_it_looks(tmp_path: Path) -> None:
    with sky(tmp_path, FLIGHT.replace("mode", "yaw: angle, mode")) as scene:
        scene.airborne()
        scene.drone.cockpit.flight.yaw = math.radians(170)
        scene.engage_at(READY)
        scene.hold_at(READY + 1, stick_yaw=0.5)
        scene.at(BREAKS, lambda: scene.keys.press(Command.STOP))
        scene.quit_at(BREAKS + 3)
        scene._fresh = lambda _seconds: True  # type: ignore[method-assign]  # a heading is no zero
        scene.run()
    headings = [message.yaw for time, message in scene.of(Move) if time < BREAKS]
    assert headings[0] == pytest.approx(170, abs=1)
    assert headings[-1] == pytest.approx(-160, abs=1)
    assert scene.of(Move)[-1][1].yaw == pytest.approx(-160, abs=3), "it does not turn back"
    assert math.degrees(scene.drone.cockpit.pose.yaw) == pytest.approx(-160, abs=3)


def test_what_it_does_by_itself_is_not_contradicted_until_a_stick_is_moved(tmp_path: Path) -> None:
    with sky(tmp_path, FLIGHT) as scene:
        scene.airborne(5.0)
        scene.engage_at(READY)
        scene.tell_at(READY + 1, "land")
        statuses: list[Status] = []
        scene.at(READY + 3, lambda: statuses.append(scene.drone.cockpit.status))
        scene.hold_at(READY + 3.5, stick_throttle=0.5)
        scene.quit_at(READY + 5)
        scene.run()
    assert [message.task for _, message in scene.of(drone.Task)] == [TaskKind.LAND]
    assert statuses == [Status.LANDING]
    silent = [time for time, _ in scene.of(Move) if READY + 1.1 < time < READY + 3.4]
    assert silent == []
    assert any(time > READY + 3.5 for time, _ in scene.of(Move))
    assert scene.drone.cockpit.status is Status.IN_AIR


def test_control_that_is_refused_is_said_and_not_asked_for_again(tmp_path: Path) -> None:
    with sky(tmp_path, FLIGHT) as scene:
        scene.airborne()
        refusal = drone.ControlAck(ControlCode.NOT_IN_F_MODE)
        scene.drone._handlers[drone.Control] = lambda message: refusal if message.order else None
        scene.engage_at(READY)
        scene.quit_at(READY + 5)
        scene.run()
    assert scene.said[0] == "drone: the drone refuses control: not in f mode"
    assert any("the drone does not confirm control" in text for text in scene.said)
    assert len(orders(scene, ControlOrder.OBTAIN)) == 1
    assert scene.of(Move) == []


def lost_on_the_way(scene: Sky, seconds: float) -> None:
    """Whatever is sent now does not arrive; what is sent 40 ms later does."""
    scene.at(seconds - 0.02, lambda: setattr(scene.cable, "deaf", True))
    scene.at(seconds + 0.04, lambda: setattr(scene.cable, "deaf", False))


def test_control_that_was_released_is_not_obtained_by_an_older_request(tmp_path: Path) -> None:
    with sky(tmp_path, FLIGHT) as scene:
        scene.airborne()
        lost_on_the_way(scene, READY)
        scene.engage_at(READY)
        scene.at(READY + 0.1, lambda: scene.keys.press(Command.DISENGAGE))
        scene.quit_at(READY + 4)
        scene.run()
    assert len(orders(scene, ControlOrder.OBTAIN)) == len(orders(scene, ControlOrder.RELEASE)) == 1
    assert scene.drone.cockpit.pilot is Pilot.RC
    assert not scene.drone.cockpit.obtained


@pytest.mark.parametrize(
    ("then", "tasks"),
    [
        (
            lambda scene: scene.keys.press(Command.TELL, device_command=DeviceCommand("drone", "land")),
            [TaskKind.TAKE_OFF, TaskKind.LAND],
        ),
        (lambda scene: scene.keys.press(Command.STOP), [TaskKind.TAKE_OFF]),
        (lambda scene: scene.keys.press(Command.QUIT), [TaskKind.TAKE_OFF]),
        (lambda scene: setattr(scene.pad, "trouble", "gone"), [TaskKind.TAKE_OFF]),
    ],
)
def test_it_does_not_take_off_by_an_order_that_is_no_longer_in_force(
    then: Callable[[Sky], None], tasks: list[TaskKind], tmp_path: Path
) -> None:
    with sky(tmp_path, FLIGHT) as scene:
        scene.engage_at(READY)
        lost_on_the_way(scene, READY + 1)
        scene.tell_at(READY + 1, "take-off")
        scene.at(READY + 1.05, lambda: then(scene))
        scene.quit_at(READY + 4)
        scene.run()
    assert [message.task for _, message in scene.of(drone.Task)] == tasks
    assert scene.drone.cockpit.status is Status.STANDBY

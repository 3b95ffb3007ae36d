"""Take off, land and return home on the wire: what is streamed while they run, how they end, what is said of them.

Answer 2 is a start and nothing else is (OPENProtocol.md 3.1.9, 01 01); the end is in the flight status.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path

import pytest
from sky import FLIGHT, READY, Sky, sky

from teleop.core.operator_input import Command
from teleop.core.run_state import Result
from teleop.devices.drone.engagement import Stage
from teleop.dji.drone import messages as drone
from teleop.dji.drone.enums import ControlOrder, TaskKind
from teleop.dji.drone.movement import Move
from teleop.dji.message import Opaque
from teleop.sim.drone.controls import Pilot, Status

ORDERED = READY + 1  # s


def moves(scene: Sky, begin: float, end: float) -> list[Move]:
    return [message for time, message in scene.of(Move) if begin < time < end]


def said_at(scene: Sky, text: str) -> float:
    """When it was said, in s after the start."""
    [time] = [time for time, said in scene.times if said == text]
    return time


def test_nothing_is_streamed_until_a_take_off_has_ended(tmp_path: Path) -> None:
    with sky(tmp_path, FLIGHT) as scene:
        scene.engage_at(READY)
        scene.tell_at(ORDERED, "take-off")
        scene.quit_at(ORDERED + 12)
        scene.run()
    assert scene.said[1:4] == [
        "drone: take-off: asked for; no sticks until it ends or one is moved",
        "drone: take-off: started",
        "drone: take-off: finished: the drone is in the air",
    ]
    end = said_at(scene, scene.said[3])
    assert moves(scene, ORDERED + 0.02, end - 0.001) == []
    assert len(moves(scene, end, end + 1)) == pytest.approx(50, abs=2), "then it is held"
    pose = scene.drone.cockpit.pose
    assert pose.height == pytest.approx(1.2, abs=0.15), "it has reached its height, not hovered half-way"
    assert end - ORDERED > 3


@pytest.mark.parametrize(("word", "kind", "seconds"), [("land", TaskKind.LAND, 20), ("home", TaskKind.RETURN_HOME, 40)])
def test_it_lands_by_itself_and_is_not_flown_until_it_stands(
    word: str, kind: TaskKind, seconds: float, tmp_path: Path
) -> None:
    with sky(tmp_path, FLIGHT) as scene:
        scene.airborne(6.0)
        scene.engage_at(READY)
        scene.hold_at(READY + 0.5, stick_pitch=0.5)
        scene.tell_at(ORDERED + 1, word)
        scene.quit_at(ORDERED + seconds)
        scene.run()
    assert [(message.task, message.number) for _, message in scene.of(drone.Task)] == [(kind, 0)]
    assert f"drone: {word}: started" in scene.said
    end = said_at(scene, f"drone: {word}: finished: the drone is on the ground")
    assert moves(scene, ORDERED + 1.02, end - 0.001) == [], "the stick that is still held does not break it off"
    after = moves(scene, end, end + 1)
    assert after, "and when it has ended"
    assert {(m.x, m.y, m.z) for m in after} == {(0, 0, 0)}, "it has to be centered first"
    assert scene.drone.cockpit.status is Status.STANDBY
    assert not scene.drone.cockpit.flight.motors
    assert scene.ended.result is Result.DONE


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
    with sky(tmp_path, FLIGHT) as scene:
        scene.airborne()
        scene.drone._handlers[drone.Task] = lambda _message: Opaque(b"", value)
        scene.engage_at(READY)
        scene.tell_at(ORDERED, "land")
        scene.quit_at(ORDERED + 3)
        scene.run()
    assert f"drone: land: {said}" in scene.said
    assert not any("started" in text for text in scene.said)
    assert len(moves(scene, ORDERED + 0.2, ORDERED + 1.2)) == pytest.approx(50, abs=2)


@pytest.mark.parametrize(
    ("before", "said"),
    [
        (lambda scene: scene.airborne(), "the drone says in air: its motors run"),
        (lambda scene: scene.tell_at(READY + 0.5, "arm"), "the motors run: drone disarm first"),
    ],
)
def test_a_take_off_is_not_ordered_while_the_motors_run(
    before: Callable[[Sky], None], said: str, tmp_path: Path
) -> None:
    with sky(tmp_path, FLIGHT) as scene:
        before(scene)
        scene.engage_at(READY)
        scene.tell_at(ORDERED, "take-off")
        scene.quit_at(ORDERED + 2)
        scene.run()
    assert f"drone: take-off refused: {said}" in scene.said, scene.said
    assert scene.of(drone.Task) == []


def test_a_task_whose_answer_is_lost_is_seen_by_its_status(tmp_path: Path) -> None:
    with sky(tmp_path, FLIGHT) as scene:
        scene.engage_at(READY)
        scene.at(ORDERED - 0.1, lambda: setattr(scene.drone, "acknowledges", False))
        scene.at(ORDERED + 1, lambda: setattr(scene.drone, "acknowledges", True))
        scene.tell_at(ORDERED, "take-off")
        scene.quit_at(ORDERED + 12)
        scene.run()
    assert "drone: take-off: no answer; its status will show whether it started" in scene.said
    assert not any(text.endswith(": started") for text in scene.said), "no answer is no success"
    end = said_at(scene, "drone: take-off: finished: the drone is in the air")
    assert moves(scene, ORDERED + 0.02, end - 0.001) == []
    assert scene.drone.cockpit.pose.height > 1


def test_a_task_that_never_reached_the_drone_is_given_up_and_the_sticks_go_on(tmp_path: Path) -> None:
    with sky(tmp_path, FLIGHT) as scene:
        scene.engage_at(READY)
        scene.at(ORDERED - 0.01, lambda: setattr(scene.cable, "deaf", True))
        scene.at(ORDERED + 0.5, lambda: setattr(scene.cable, "deaf", False))
        scene.tell_at(ORDERED, "take-off")
        scene.quit_at(ORDERED + 8)
        scene.run()
    assert "drone: take-off: not started: the drone says standby" in scene.said
    assert moves(scene, ORDERED + 0.02, ORDERED + 3.9) == []
    assert moves(scene, ORDERED + 5, ORDERED + 6)
    assert scene.drone.cockpit.status is Status.STANDBY


@pytest.mark.parametrize(
    ("act", "said"),
    [
        (lambda scene: scene.keys.press(Command.STOP), "everything is to stop"),
        (lambda scene: scene.keys.press(Command.DISENGAGE), "the operator lets go"),
        (lambda scene: setattr(scene.pad, "trouble", "gone"), "no hand on the sticks for 1 s"),
        (lambda scene: scene.keys.press(Command.QUIT), ""),
    ],
)
@pytest.mark.parametrize(("word", "height"), [("take-off", 0.0), ("land", 8.0), ("home", 8.0)])
def test_stop_sends_no_movement_into_a_task_and_says_what_goes_on(
    word: str, height: float, act: Callable[[Sky], None], said: str, tmp_path: Path
) -> None:
    with sky(tmp_path, FLIGHT) as scene:
        if height:
            scene.airborne(height)
        scene.engage_at(READY)
        scene.tell_at(ORDERED, word)
        scene.at(ORDERED + 0.5, lambda: act(scene))
        scene.quit_at(ORDERED + 6)
        scene.run(after=20.0)
    assert any(said in text for text in scene.said)
    assert f"drone: {word} goes on by itself: take it over with the RC" in scene.said, scene.said
    assert [time for time, _ in scene.of(Move) if time > ORDERED + 0.02] == []
    assert [m for _, m in scene.of(drone.Control) if m.order == ControlOrder.RELEASE]
    assert scene.drone.cockpit.pilot is Pilot.RC
    assert scene.drone.cockpit.status is (Status.IN_AIR if word == "take-off" else Status.STANDBY)
    assert not scene.drone.cockpit.flight.crashed


def test_a_stick_that_is_moved_for_it_takes_the_drone_out_of_a_task(tmp_path: Path) -> None:
    with sky(tmp_path, FLIGHT) as scene:
        scene.airborne(20.0)
        scene.engage_at(READY)
        scene.tell_at(ORDERED, "land")
        scene.hold_at(ORDERED + 3, stick_pitch=0.5)
        scene.hold_at(ORDERED + 5)
        scene.quit_at(ORDERED + 8)
        scene.run()
    assert "drone: land: a stick was moved: the sticks fly it again" in scene.said
    assert moves(scene, ORDERED + 0.02, ORDERED + 3) == []
    assert max(m.x for m in moves(scene, ORDERED + 3, ORDERED + 5)) == pytest.approx(2.5)
    assert scene.drone.cockpit.status is Status.IN_AIR


def test_a_landing_may_be_ordered_while_it_takes_off_and_the_newest_counts(tmp_path: Path) -> None:
    with sky(tmp_path, FLIGHT) as scene:
        scene.engage_at(READY)
        scene.tell_at(ORDERED, "take-off")
        scene.tell_at(ORDERED + 0.5, "take-off")
        scene.tell_at(ORDERED + 3, "land")
        scene.quit_at(ORDERED + 14)
        scene.run()
    assert "drone: take-off: it is under way" in scene.said
    assert [(m.task, m.number) for _, m in scene.of(drone.Task)] == [(TaskKind.TAKE_OFF, 0), (TaskKind.LAND, 1)]
    assert "drone: land: finished: the drone is on the ground" in scene.said


def test_heights_count_from_where_a_take_off_has_left_it(tmp_path: Path) -> None:
    with sky(tmp_path, FLIGHT.replace("mode", "vertical: height, yaw: angle, mode")) as scene:
        scene.drone.cockpit.flight.yaw = math.radians(80)
        scene.engage_at(READY)
        scene.tell_at(ORDERED, "take-off")
        scene.quit_at(ORDERED + 12)
        scene._fresh = lambda _seconds: True  # type: ignore[method-assign]  # a height is no zero
        scene.run()
    last = scene.of(Move)[-1][1]
    assert last.z == pytest.approx(1.15, abs=0.1), "not the ground that it was taken on"
    assert last.yaw == pytest.approx(80, abs=1)
    assert scene.drone.cockpit.pose.height > 1


def test_tilts_are_roll_and_pitch_on_the_wire_and_forward_flies_forward(tmp_path: Path) -> None:
    tilt = FLIGHT.replace("velocity-body", "tilt").replace("horizontal: 5", "horizontal: 10")
    with sky(tmp_path, tilt) as scene:
        scene.airborne()
        scene.engage_at(READY)
        scene.hold_at(READY + 1, stick_pitch=1.0)
        scene.at(READY + 4, lambda: scene.keys.press(Command.DISENGAGE))
        scene.quit_at(READY + 7)
        scene.run()
    flying = moves(scene, READY + 2, READY + 4)
    assert {(m.x, m.y, m.z, m.yaw) for m in flying} == {(0, -10, 0, 0)}
    pose = scene.drone.cockpit.pose
    assert pose.north > 5, "the nose is to the north"
    assert abs(pose.east) < 0.01


@pytest.mark.parametrize("throttle", [0.25, -0.25])
def test_a_climb_is_positive_in_the_state_that_views_and_takes_show(throttle: float, tmp_path: Path) -> None:
    climbs: list[float] = []

    def look(scene: Sky) -> None:
        velocity = scene.sink.state(scene.clock.now()).velocity
        assert velocity is not None
        climbs.append(velocity[2])

    with sky(tmp_path, FLIGHT) as scene:
        scene.airborne()
        scene.engage_at(READY)
        scene.hold_at(READY + 1, stick_throttle=throttle)
        scene.at(READY + 6, lambda: look(scene))
        scene.quit_at(READY + 7)
        scene.run()
    assert climbs == [pytest.approx(2 * throttle, abs=0.02)]
    assert scene.sink.state(scene.clock.now()).stage == Stage.IDLE.value

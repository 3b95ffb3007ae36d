"""A shoot that a client begins in a run by hand, by the wire of the simulated gimbal, the journal and the state."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path
from typing import Any

import pytest
from remote_asks import ended, planned_or_not, played, until
from remote_bench import ANNA, BOB, RemoteBench

from teleop.core.timing import PERIOD
from teleop.dji.gimbal import messages as gimbal
from teleop.dji.gimbal.camera import CameraCommand, Command
from teleop.dji.message import ReturnCode

FRAMES = 6


def shots(bench: RemoteBench) -> list[float]:
    """When the shutter was pressed, on the wire."""
    return [at for at, message in bench.tap.of(Command) if message.command is CameraCommand.SHUTTER]


def shot(bench: RemoteBench, **fields: Any) -> int:
    return played(bench, "shoot", move="turn", **fields)


def places(bench: RemoteBench) -> list[float]:
    """Where pan was sent last before each shutter."""
    yaws = bench.tap.of(gimbal.Position)
    return [[message.yaw for at, message in yaws if at <= pressed + PERIOD][-1] for pressed in shots(bench)]


def assert_every_frame_in_its_slot(bench: RemoteBench, but: int = 0) -> None:
    """Each once, a second apart, at its place; `but` gaps are longer."""
    pressed = shots(bench)
    assert len(pressed) == FRAMES
    gaps = [after - before for before, after in pairwise(pressed)]
    longer = [gap for gap in gaps if gap > 1 + 1.5 * PERIOD]
    assert len(longer) == but
    assert min(gaps) > 1 - 1.5 * PERIOD
    assert places(bench) == sorted(places(bench))


def test_a_shoot_takes_every_frame_in_its_slot_and_gives_the_rig_back(stage: RemoteBench, tmp_path: Path) -> None:
    number = shot(stage)
    until(stage, lambda: stage.state["shoot"]["frames_done"] == 2)
    state = stage.state["shoot"]
    assert (state["title"], state["frames"], state["missed"], state["paused"]) == ("Slow turn", FRAMES, 0, False)
    assert state["interval"] == 1.0
    assert state["eta"] - stage.state["clock"] == pytest.approx(4, abs=1.1)
    assert stage.state["axes"]["pan"]["driver"] == "Slow turn"
    until(stage, lambda: number in stage.ends)
    assert stage.ends[number]["ok"]
    assert_every_frame_in_its_slot(stage)
    assert stage.state["shoot"] is None
    stage.tick(2)
    assert any("6 of 6 frames shot, 0.25 s of clip" in line for line in stage.lines)
    assert (tmp_path / "turn.journal").exists()
    assert "ok" in stage.ask("goto", axes={"pan": 0.0})


def test_it_goes_on_when_its_console_and_its_gateway_are_gone_and_when_control_passes(stage: RemoteBench) -> None:
    number = shot(stage)
    until(stage, lambda: stage.state["shoot"]["frames_done"] == 1)
    stage.say("take_control", BOB, ask=True)
    stage.run(2)
    stage.say("closed")
    stage.quiet, stage.seen = True, {}
    until(stage, lambda: number in stage.ends)
    assert_every_frame_in_its_slot(stage)
    assert stage.state["holder"] in ("Bob", None)


def test_it_pauses_between_two_frames_and_goes_on(stage: RemoteBench) -> None:
    number = shot(stage)
    until(stage, lambda: stage.state["shoot"]["frames_done"] == 2)
    ended(stage, "pause")
    assert stage.state["shoot"]["paused"]
    assert stage.rests
    assert stage.ask("pause")["error"] == "it is paused already"
    stage.run(10)
    assert len(shots(stage)) in (2, 3)
    ended(stage, "resume")
    until(stage, lambda: number in stage.ends)
    assert_every_frame_in_its_slot(stage, but=1)


def test_a_stop_of_a_watcher_halts_it_and_it_is_gone_on_with(stage: RemoteBench) -> None:
    number = shot(stage)
    until(stage, lambda: stage.state["shoot"]["frames_done"] == 2)
    stage.ask("stop", BOB)
    stage.run(5)
    count = len(shots(stage))
    assert stage.rests
    assert stage.state["shoot"]["paused"]
    assert stage.ask("resume")["error"] == "STOP is not cleared"
    stage.ask("clear")
    stage.run(3)
    assert len(shots(stage)) == count
    assert stage.state["shoot"]["why"] == "STOP by Bob"
    ended(stage, "resume")
    until(stage, lambda: number in stage.ends)
    assert stage.ends[number]["ok"]
    assert len(shots(stage)) == FRAMES


@pytest.mark.parametrize("who", ["the joystick at the rig", "the holder"])
def test_a_hand_that_takes_an_axis_of_it_pauses_it(stage: RemoteBench, who: str) -> None:
    number = shot(stage)
    until(stage, lambda: stage.state["shoot"]["frames_done"] == 2)
    if who == "the holder":
        stage.hold(0.5, pan=0.4)
        stage.release()
    else:
        stage.pad.hold(pan=0.4)
        stage.run(0.5)
        stage.pad.hold(pan=0.0)
    stage.run(3)
    assert stage.rests
    assert "an operator moved pan" in stage.state["shoot"]["why"]
    assert any("Slow turn pauses: an operator moved pan" in line for line in stage.lines)
    assert len(shots(stage)) <= 3
    ended(stage, "resume")
    until(stage, lambda: number in stage.ends)
    assert len(shots(stage)) == FRAMES
    assert sorted(places(stage)) == places(stage)


def test_an_abort_waits_for_the_picture_and_the_shoot_can_be_resumed(stage: RemoteBench) -> None:
    number = shot(stage)
    until(stage, lambda: stage.state["shoot"]["phase"] == "expose" and stage.state["shoot"]["frames_done"] == 2)
    ended(stage, "abort")
    assert stage.ends[number]["error"] == "aborted by Anna"
    assert stage.state["shoot"] is None
    released = [m.command for _, m in stage.tap.of(Command)]
    assert released.count(CameraCommand.STOP_SHUTTER) == released.count(CameraCommand.SHUTTER) == 3
    stage.tick(2)
    assert any('frame 3 is next: shoot it again with "resume": true' in line for line in stage.lines)
    again = planned_or_not(stage, stage.say("shoot", move="turn"))
    assert again["kind"] == "refused"
    assert again["error"] == (
        "turn.journal: the shoot of turn.yaml stopped at frame 3 of 6:"
        ' continue with "resume": true, or start over with "restart": true'
    )
    number = shot(stage, resume=True)
    until(stage, lambda: number in stage.ends)
    assert stage.ends[number]["ok"]
    assert len(shots(stage)) == FRAMES


def test_what_is_no_shoot_or_has_no_camera_is_refused_with_the_reason(stage: RemoteBench) -> None:
    assert "it is no timelapse: play it" in planned_or_not(stage, stage.say("shoot", move="there"))["error"]
    assert "it is a timelapse: shoot it" in planned_or_not(stage, stage.say("play", move="turn"))["error"]
    assert "there is no move 'nowhere'" in planned_or_not(stage, stage.say("shoot", move="nowhere"))["error"]
    stage.hands._actions.moves.shoots.has_camera = False
    answer = stage.ask("shoot", move="turn")
    assert (answer["kind"], answer["error"]) == ("refused", "this rig has no camera to shoot with")


def test_nothing_else_begins_while_it_is_shot_and_a_camera_that_refuses_ends_it_and_not_the_run(
    stage: RemoteBench,
) -> None:
    number = shot(stage)
    until(stage, lambda: stage.state["shoot"]["frames_done"] == 1)
    others: dict[str, dict[str, Any]] = {
        "goto": {"axes": {"pan": 1.0}},
        "jog": {"axis": "pan", "by": 1.0},
        "play": {"move": "there"},
        "shoot": {"move": "turn"},
        "shutter": {},
        "follow": {"mode": "lock"},
    }
    for do, fields in others.items():
        answer = stage.ask(do, **fields)
        assert answer["kind"] == "refused", do
        assert "Slow turn is being shot" in answer["error"], do
    stage.tap.gimbal._handlers[Command] = lambda *_: ReturnCode.FAILED
    until(stage, lambda: number in stage.ends)
    assert "the camera refused to shoot frame" in stage.ends[number]["error"]
    assert not stage.loop.faults
    assert "ok" in stage.ask("goto", axes={"pan": 0.0})


def test_a_stop_while_it_is_planned_drops_it(stage: RemoteBench) -> None:
    number = stage.say("shoot", move="turn")
    stage.tick()
    stage.ask("stop", BOB)
    assert planned_or_not(stage, number)["error"] == "STOPPED"
    stage.ask("clear")
    stage.run(1)
    assert stage.state["shoot"] is None
    assert shot(stage) in stage.answers  # its journal is free again


def test_of_a_request_alone_control_lasts_as_long_as_the_shoot(free: RemoteBench) -> None:
    number = shot(free, brief=True)
    assert free.state["holder"] == "Anna"
    assert free.ask("goto", BOB, axes={"pan": 0.0}, brief=True)["holder"] == "Anna"
    ended(free, "pause", brief=True)
    ended(free, "resume", brief=True)
    until(free, lambda: number in free.ends)
    free.tick(3)
    assert free.state["holder"] is None
    assert ANNA not in free.hands.desk._brief

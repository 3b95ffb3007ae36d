"""Cues of a sequence: what each becomes, and every one that could not be done, refused with what would be right."""

from __future__ import annotations

from pathlib import Path

import pytest

from sequences import load, problems_of
from teleop.config.documents.document import DocumentError, UnplayableError
from teleop.core.axes import Axis
from teleop.core.events import Action, DeviceCommand
from teleop.sequence.cues import Cue, Wait

MOVE = "keyframes:\n  - {at: 0, pan: 20, tilt: 0}\n  - {at: 4, pan: -10, tilt: 5, hold: 1s}\n  - {at: 9, pan: 30}\n"


def cued(*cues: str) -> str:
    return MOVE + "cues:\n" + "".join(f"  - {{{cue}}}\n" for cue in cues)


def test_each_kind_becomes_what_its_device_is_told(tmp_path: Path) -> None:
    performance = load(
        tmp_path,
        cued(
            "at: 0, camera: focus",
            "at: 0, follow: pan",
            "at: 0, follow: yaw",
            "at: 4.2, send: gimbal  set_stiffness pitch=40 roll=40 yaw=40",
        ),
    )
    assert performance.cues == [
        Cue(0, Action.FOCUS),
        Cue(0, DeviceCommand("gimbal", "follow yaw")),
        Cue(0, DeviceCommand("gimbal", "follow yaw")),
        Cue(4.2, DeviceCommand("gimbal", "set_stiffness", ("pitch=40", "roll=40", "yaw=40"))),
    ]
    assert [cue.name for cue in performance.cues[:2]] == ["focus", "gimbal follow yaw"]


@pytest.mark.parametrize(
    ("cue", "problem"),
    [
        ("at: 0", "6:5: cue 1 must have one of camera, follow, recenter, send, wait"),
        (
            "at: 0, camera: record, follow: lock",
            "6:5: cue 1 must have one of camera, follow, recenter, send, wait, not camera and follow",
        ),
        (
            "at: 0, follow: lok",
            "6:21: cue 1: follow must be one of lock, pan, yaw, sport, not 'lok'; did you mean lock?",
        ),
        (
            "at: 0, camera: autofocus",
            "6:21: cue 1: camera must be one of record, stop, shutter, focus, end_focus, not",
        ),
        ("at: 0, flow: lock", "6:13: cue 1: unknown key `flow`; did you mean `follow`?"),
        ("at: 0, recenter: now", "6:23: cue 1: recenter must be a time (4, 4s, 1m30s, 96f or 00:00:04:00), not 'now'"),
        (
            "at: 0, send: gimbal folow lock",
            "6:19: cue 1: send: unknown command gimbal folow lock; did you mean gimbal follow",
        ),
        (
            "at: 0, send: gimbal set_stiffness pitch=140 roll=40 yaw=40",
            "6:19: cue 1: send: gimbal.set_stiffness: pitch must be 0..100 %, not 140",
        ),
        (
            "at: 0, send: gimbal set_stiffness pitch=1",
            "6:19: cue 1: send: gimbal.set_stiffness: roll, yaw",
        ),
        ("at: 0, send: camera record", "6:19: cue 1: send must be written as camera: record"),
        ("at: 0, send: camera short_command command=record", "6:19: cue 1: send must be written as camera: record"),
        ("at: 0, send: recenter", "6:19: cue 1: send conflicts with the motion of the run: write recenter: 3s"),
        (
            "at: 0, send: gimbal position yaw=1 roll=0 pitch=0",
            "6:19: cue 1: send conflicts with the motion of the run: write pan:, tilt: and roll: into a keyframe",
        ),
        (
            "at: 0, send: focus set position=1",
            "6:19: cue 1: send conflicts with the motion of the run: write focus: into a keyframe",
        ),
        ("at: 0, send: gimbal track", "6:19: cue 1: send moves the gimbal by itself, against the keyframes"),
        ("at: 0, send: 3", "6:19: cue 1: send must be text, not 3"),
        ("send: gimbal angles", "6:5: cue 1: at is missing"),
        ("at: , camera: stop", "6:10: cue 1: at must be a time (4, 4s, 1m30s, 96f or 00:00:04:00), not empty"),
    ],
)
def test_what_is_wrong_with_a_cue_is_said_at_its_place(tmp_path: Path, cue: str, problem: str) -> None:
    found = problems_of(tmp_path, cued(cue))
    assert [line for line in found if line.startswith(f"shoot.yaml:{problem}")], found


def test_what_changes_the_gimbals_ways_needs_a_rest_and_is_told_where_one_is(tmp_path: Path) -> None:
    moving = cued("at: 2, follow: lock", "at: 5.1, send: follow sport", "at: 2, camera: shutter")
    assert problems_of(tmp_path, moving) == [
        "shoot.yaml:6:5: cue 1 is at 2 s, while pan and tilt move; put it at 0 s or 4 s, or add a key "
        "with `pass: stop` at 2 s",
        "shoot.yaml:7:5: cue 2 is at 5.1 s, while pan moves; put it at 5 s or 9 s, or add a key "
        "with `pass: stop` at 5.1 s",
    ]
    for rest in ("0", "4", "4.5", "5", "9", "100"):
        lock = load(tmp_path, cued(f"at: {rest}, follow: lock")).cues[0].action
        assert lock == DeviceCommand("gimbal", "follow lock")


def test_a_wait_needs_rest_and_a_drone_that_hovers(tmp_path: Path) -> None:
    assert load(tmp_path, cued("at: 4.5, wait: operator")).cues == [Cue(4.5, Wait())]
    [found] = problems_of(tmp_path, cued("at: 6, wait: operator"))
    assert found.startswith(
        "shoot.yaml:6:5: cue 1 is at 6 s, while pan moves; put it at 5 s or 9 s, or add a key with `pass: stop`"
    )
    [found] = problems_of(tmp_path, cued("at: 4, wait: me"))
    assert found == "shoot.yaml:6:19: cue 1: wait must be one of operator, not 'me'"
    flight = (
        "keyframes:\n  - {at: 0, stick_yaw: 0}\n  - {at: 3, stick_yaw: 0.4, hold: 2}\n  - {at: 9, stick_yaw: 0}\n"
        "cues:\n  - {at: 4, wait: operator}\n"
    )
    assert problems_of(tmp_path, flight) == [
        "shoot.yaml:6:5: cue 1 holds stick_yaw deflected, so the drone keeps flying: bring it to 0 before"
    ]
    assert load(tmp_path, flight.replace("at: 4, wait", "at: 9, wait")).cues == [Cue(9, Wait())]


def test_a_stretched_move_keeps_its_cues_in_its_rests(tmp_path: Path) -> None:
    text = "fit: stretch\n" + cued("at: 4, follow: lock").replace("pan: -10", "pan: -170").replace("at: 9", "at: 5.5")
    performance = load(tmp_path, text)
    factor = performance.cues[0].at / 4
    assert factor > 1.2
    assert performance.move.at(4.0 * factor)[Axis.PAN].velocity == pytest.approx(0, abs=1e-6)


def test_a_recentre_is_a_planned_way_from_rest_to_rest(tmp_path: Path) -> None:
    performance = load(tmp_path, cued("at: 9, recenter: 3s", "at: 12, camera: stop"))
    assert performance.cues == [Cue(12, Action.STOP)]
    move = performance.move
    assert move.duration == 12
    assert move.at(9.0)[Axis.PAN] == pytest.approx((30, 0, 0), abs=1e-6)
    assert {axis: state.position for axis, state in move.end.items()} == {Axis.PAN: 0, Axis.TILT: 0}
    between = load(tmp_path, cued("at: 5, recenter: 2s"))
    assert between.move.at(7.0)[Axis.PAN] == pytest.approx((0, 0, 0), abs=1e-6)
    assert between.move.at(9.0)[Axis.PAN].position == 30


@pytest.mark.parametrize(
    ("cue", "problem"),
    [
        (
            "at: 2, recenter: 1s",
            "begins while pan moves to key 2; it rests until 0 s",
        ),
        ("at: 4, recenter: 1s", "begins while key 2 holds pan (until 5 s)"),
        ("at: 5, recenter: 4s", "must end before key 3 (9 s), where pan is elsewhere"),
    ],
)
def test_a_recentre_of_what_moves_or_is_wanted_elsewhere_is_refused(tmp_path: Path, cue: str, problem: str) -> None:
    [found] = problems_of(tmp_path, cued(cue))
    assert found.startswith(f"shoot.yaml:6:23: cue 1: recenter {problem}")


def test_a_recentre_that_is_too_fast_or_moves_nothing_is_said_where_it_stands(tmp_path: Path) -> None:
    found, *_ = problems_of(tmp_path, cued("at: 9, recenter: 0.1s"), UnplayableError)
    assert found.startswith("shoot.yaml:6:5: pan needs 0.958 s from key 3 to cue 1, not 0.100 s ")
    [found] = problems_of(tmp_path, "keyframes: [{at: 0, focus: 0}]\ncues: [{at: 1, recenter: 3s}]\n")
    assert found.endswith("cue 1: recenter needs a keyframe with pan, tilt or roll")


def test_a_rig_without_the_device_of_a_cue_is_said(tmp_path: Path) -> None:
    text = cued("at: 0, camera: record", "at: 9, follow: lock")
    assert problems_of(tmp_path, text, UnplayableError, devices=["focus"]) == [
        "shoot.yaml:6:21: cue 1: camera: the rig has no camera; its sinks are focus",
        "shoot.yaml:7:21: cue 2: follow: the rig has no gimbal; its sinks are focus",
    ]
    assert len(load(tmp_path, text, devices=["focus", "gimbal", "camera"]).cues) == 2


@pytest.mark.parametrize("stick", ["stick_throttle", "stick_yaw"])
def test_a_drone_is_taken_over_and_left_with_its_sticks_in_the_middle(tmp_path: Path, stick: str) -> None:
    text = f"keyframes:\n  - {{at: 0, {stick}: 0.1}}\n  - {{at: 3, {stick}: 0.4}}\n  - {{at: 6, {stick}: -0.2}}\n"
    where = len(f"  - {{at: 0, {stick}: ") + 1
    assert problems_of(tmp_path, text) == [
        f"shoot.yaml:2:{where}: key 1: {stick} must be 0 in its first key, where the drone is to hover",
        f"shoot.yaml:4:{where}: key 3: {stick} must be 0 in its last key, where the drone is to hover",
    ]
    hidden = text.replace("at: 0,", "at: 0, pan: 1}\n  - {at: 1,") + f"  - {{at: 7, pan: 2, {stick}: ~}}\n"
    hidden = hidden.replace("at: 0,", f"at: 0, {stick}: ~,")
    assert [line.partition(" ")[2][:5] for line in problems_of(tmp_path, hidden)] == ["key 2", "key 4"]
    flown = load(tmp_path, text.replace("0.1", "0").replace("-0.2", "0"))
    assert flown.move.at(3.0)[Axis(stick)].position == pytest.approx(0.4)
    with pytest.raises(DocumentError, match=r"must be at most 1"):
        load(tmp_path, text.replace("0.1", "0").replace("-0.2", "0").replace("0.4", "1.4"))

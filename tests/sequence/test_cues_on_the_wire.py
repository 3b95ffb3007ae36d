"""Cues as the gimbal and its camera hear them: each kind as its own command, in the tick that its time falls into."""

from __future__ import annotations

from pathlib import Path

import pytest
import wire

from teleop.config.documents.document import DocumentError
from teleop.config.profile import load_profile
from teleop.core.clock import VirtualClock
from teleop.core.run_state import Result
from teleop.devices.gimbal.commands import CommandSink
from teleop.devices.rig import open_rig
from teleop.dji.gimbal import camera
from teleop.dji.gimbal import messages as gimbal
from teleop.dji.gimbal.camera import CameraCommand
from teleop.dji.gimbal.command_table import COMMANDS, find, is_taken_back
from teleop.dji.gimbal.enums import FollowMode
from teleop.dji.message import Message
from teleop.sequence.compile import load_sequence
from teleop.sequence.cycle import Cycle
from teleop.sequence.source import SequenceSource

STREAMS = (gimbal.Position, gimbal.Angles, gimbal.VersionPush)  # what is sent anyway
RECORD, STOP, SHUTTER = (
    camera.Command(each) for each in (CameraCommand.RECORD, CameraCommand.STOP, CameraCommand.SHUTTER)
)
ARGUMENTS = {
    "gimbal position": "yaw=1 roll=0 pitch=0",
    "gimbal speed": "yaw=1 roll=0 pitch=0",
    "gimbal joystick": "yaw=1 roll=0 pitch=0",
    "gimbal dial": "speed=9",
    "gimbal set limits": "pitch_max=90 pitch_min=50 yaw_max=90 yaw_min=90 roll_max=20 roll_min=20",
    "gimbal set stiffness": "pitch=40 roll=41 yaw=42",
    "gimbal push settings": "switch=on",
    "gimbal version push": "version=01.02.03.04",
    "gimbal parameters": "ids=push_pan",
    "gimbal set parameters": "parameters=7:0a",
    "gimbal mode": "mode=lock",
    "gimbal orientation": "orientation=portrait",
    "focus set": "position=9",
    "camera command": "command=stop_shutter",
    "camera short command": "command=stop_shutter",
}
BY_THEMSELVES = ("gimbal orientation", "gimbal calibrate", "gimbal track")
MOVE = "keyframes:\n  - {at: 0, pan: 0, tilt: 0}\n  - {at: 1.5, pan: 20, tilt: 5, hold: 1.25}\n  - {at: 5, pan: 0}\n"
ROUND = MOVE.replace("{at: 5, pan: 0}", "{at: 5, pan: 0, tilt: 0}")


def heard(
    folder: Path, text: str, speed: float = 1.0, passes: int = 1, streams: tuple[type[Message], ...] = STREAMS
) -> list[tuple[float, Message]]:
    """All that is no stream, with its time in s after the start."""
    (folder / "cued.yaml").write_text(text)
    profile, clock = load_profile("sim"), VirtualClock(100.0)
    performance = load_sequence(str(folder / "cued.yaml"), profile.limits, "the rig")
    with open_rig(profile, clock) as rig:
        tap = wire.tapped(rig)
        source = SequenceSource(performance, profile.limits, speed, cycle=Cycle(0.5, passes=passes))
        told = CommandSink(next(iter(rig.connections.values())), lambda _text: None)
        ended = rig.loop(list(performance.move.tracks), [source], sinks=[told]).run()
    assert (ended.result, ended.reasons) == (Result.DONE, [])
    sent = [(round(time - source.begin, 6), each) for time, each in tap.heard if time > source.begin - 1e-6]
    return [(time, each) for time, each in sent if not isinstance(each, streams)]


EVERY_KIND = (
    MOVE
    + """cues:
  - {at: 0,    camera: record}
  - {at: 0.25, camera: shutter}
  - {at: 0.333, camera: focus}
  - {at: 1.51, camera: end_focus}
  - {at: 1.5,  follow: lock}
  - {at: 2.75, follow: pan}
  - {at: 2.75, follow: sport}
  - {at: 2,    send: gimbal set_stiffness pitch=40 roll=41 yaw=42}
  - {at: 4.99, send: camera status}
  - {at: 5,    camera: stop}
"""
)


def test_each_kind_is_its_own_command_in_its_tick(tmp_path: Path) -> None:
    assert heard(tmp_path, EVERY_KIND) == [
        (0.0, RECORD),
        (0.25, SHUTTER),
        (0.34, camera.Command(CameraCommand.CENTER_FOCUS)),  # the first tick after it
        (1.5, gimbal.Mode(mode=FollowMode.LOCK)),
        (1.51, camera.Command(CameraCommand.END_CENTER_FOCUS)),
        (2.0, gimbal.SetStiffness(pitch=40, roll=41, yaw=42)),
        (2.75, gimbal.Mode(mode=FollowMode.YAW)),
        (2.75, gimbal.Mode(mode=FollowMode.SPORT)),
        (4.99, camera.Status()),
        (5.0, STOP),
    ]


def test_at_another_speed_they_are_where_the_move_is_then(tmp_path: Path) -> None:
    cues = "cues: [{at: 0.3, camera: record}, {at: 2, follow: lock}, {at: 5, camera: stop}]\n"
    times = [time for time, _ in heard(tmp_path, MOVE + cues, speed=0.5)]
    assert times == [0.6, 4.0, 10.0]
    times = [time for time, _ in heard(tmp_path, MOVE + cues, speed=1.25)]
    assert times == [0.24, 1.6, 4.0]


@pytest.mark.parametrize("mode", ["loop", "bounce"])
def test_cues_of_a_repeat_stand_in_the_time_of_the_whole(tmp_path: Path, mode: str) -> None:
    text = ROUND + (
        f"repeat: {{times: 3, mode: {mode}}}\n"
        "cues: [{at: 0, camera: record}, {at: 7.25, follow: lock}, {at: 12.4, camera: shutter}, "
        "{at: 15, camera: stop}]\n"
    )
    found = heard(tmp_path, text)
    assert found == [(0.0, RECORD), (7.25, gimbal.Mode(mode=FollowMode.LOCK)), (12.4, SHUTTER), (15.0, STOP)]


def test_a_bounce_comes_by_its_rests_in_mirrored_time(tmp_path: Path) -> None:
    """There 0 to 5 s, resting 1.5 to 2.75 s; so back it rests from 10 - 2.75 to 10 - 1.5 s."""
    text = ROUND + "repeat: {times: 2, mode: bounce}\n"
    for at in (7.25, 8.5):
        assert heard(tmp_path, f"{text}cues: [{{at: {at}, follow: lock}}]\n")[0][0] == at
    for at in (7.2, 8.55):
        with pytest.raises(DocumentError, match=rf"is at {at} s, while pan and tilt move"):
            heard(tmp_path, f"{text}cues: [{{at: {at}, follow: lock}}]\n")


def test_what_is_included_by_what_is_included_is_as_fast_as_both_say(tmp_path: Path) -> None:
    """200 % of 50 % is its own speed, 5 s and 2 s after what it is in."""
    cues = "cues: [{at: 0, camera: record}, {at: 1.5, follow: lock}, {at: 5, camera: stop}]\n"
    (tmp_path / "inner.yaml").write_text(MOVE + cues)
    (tmp_path / "middle.yaml").write_text("include: [{move: inner.yaml, at: 10, speed: 50%}]\n")
    found = heard(tmp_path, "include: [{move: middle.yaml, at: 2, speed: 200%}]\n")
    assert found == [(7.0, RECORD), (8.5, gimbal.Mode(mode=FollowMode.LOCK)), (12.0, STOP)]


def test_every_pass_has_its_cues(tmp_path: Path) -> None:
    (first_at, first), (at, second) = heard(tmp_path, ROUND + "cues: [{at: 2, camera: shutter}]\n", passes=2)
    assert first == second == SHUTTER
    assert (first_at, at) == (2.0, 7.5), "it ends where it begins, so only the preroll lies between"


@pytest.mark.parametrize("name", COMMANDS)
def test_any_message_of_the_protocol_is_sent_or_refused_with_a_reason(tmp_path: Path, name: str) -> None:
    words = f"{name} {ARGUMENTS.get(name, '')}".strip()
    text = f"keyframes: [{{at: 0, pan: 0}}]\ncues: [{{at: 1, send: {words}}}]\n"
    message = find(words.split())
    if name in BY_THEMSELVES or is_taken_back(message):
        with pytest.raises(
            DocumentError,
            match=r"cued.yaml:2:22: cue 1: send (conflicts with|moves) the ",
        ):
            heard(tmp_path, text)
    else:
        assert (1.0, message) in heard(tmp_path, text, streams=())

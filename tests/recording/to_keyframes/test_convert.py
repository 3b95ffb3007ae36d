"""A take becomes few keyframes, and what is planned through them is never further from it than was allowed."""

from __future__ import annotations

import json
import re
from pathlib import Path

import numpy as np
import pytest
from command import teleop
from made_takes import LIMITS, at_rest, write_take

from teleop.cli import run
from teleop.config.documents.document import UnplayableError
from teleop.config.profile import load_profile
from teleop.core.axes import Axis, Limits, State
from teleop.core.events import Action, DeviceCommand
from teleop.core.setpoints import VelocityTarget
from teleop.planner.keyframes.planner import Key, plan
from teleop.planner.live import Live
from teleop.recording.reader import Take, read_take
from teleop.recording.replay import recorded_move
from teleop.recording.to_keyframes.convert import keyframes
from teleop.sequence.compile import CompiledSequence, load_sequence

SIM = load_profile("sim").limits
PAN, TILT, FOCUS = Axis.PAN, Axis.TILT, Axis.FOCUS
MOVES = {
    "smooth": {
        PAN: [(0, -40), (2, -20), (3.5, -5), (6, 10), (8, 0), (11, 30), (13, 42), (16, 60), (19, 20), (24, -10)]
    },
    "two axes": {PAN: [(0, 0), (3, 20), (5, 50), (9, 10)], TILT: [(0, 5), (3, -10), (6, 20), (9, 30)]},
    "focus": {PAN: [(0, 0), (4, 30), (8, 0)], FOCUS: [(0, 0.1), (2, 0.5), (8, 0.9)]},
    "a twitch": {PAN: [(0, 0), (10, 1), (10.5, 8), (20, 9)]},
}


def planned_take(path: Path, keys: dict[Axis, list[Key]], seconds: float) -> Take:
    move = plan(keys, SIM)
    motion = {axis: move.tracks[axis].at for axis in keys}
    return read_take(write_take(path, motion, seconds, limits={axis: SIM[axis] for axis in keys}))


def stick_take(path: Path, speeds: list[tuple[float, float]], seconds: float) -> Take:
    """Pan as a stick moves it: (s, deg/s), through the live planner."""
    live, states = Live({PAN: SIM[PAN]}, 0.01), [State(0.0)]
    live.reset({PAN: State(0.0)})
    for tick in range(1, round(seconds * 100) + 1):
        wanted = [speed for time, speed in speeds if time <= tick / 100]
        demand = {PAN: VelocityTarget(wanted[-1])} if wanted and wanted[-1] else {}
        states.append(live.step(demand)[PAN])
    return read_take(write_take(path, {PAN: lambda time: states[round(time * 100)]}, seconds, limits={PAN: SIM[PAN]}))


def played(text: str, take: Take, folder: Path) -> CompiledSequence:
    (folder / "fitted.yaml").write_text(text, encoding="utf-8")
    return load_sequence(str(folder / "fitted.yaml"), take.about.limits, "sim")


def furthest(text: str, take: Take, folder: Path) -> dict[Axis, float]:
    """How far the planned file is from the recording, found without anything that fitted it."""
    move, recorded = played(text, take, folder).move, recorded_move(take, take.about.limits)
    times = np.arange(0, recorded.duration + 0.005, 0.01)
    one, two = move.sample(times), recorded.sample(times)
    return {axis: float(np.abs(one[axis][0] - two[axis][0]).max()) for axis in take.axes}


@pytest.mark.parametrize("name", MOVES)
def test_a_planned_move_comes_back_in_about_as_many_keyframes(name: str, tmp_path: Path) -> None:
    keys = {axis: [Key(at, position) for at, position in of_axis] for axis, of_axis in MOVES[name].items()}
    take = planned_take(tmp_path / "take.mcap", keys, max(of_axis[-1].at for of_axis in keys.values()))
    fitted = keyframes(take, 0.2)
    off = furthest(fitted.text, take, tmp_path)
    for axis, size in off.items():
        assert size <= (0.002 if axis is FOCUS else 0.2) + 1e-9
        assert fitted.errors[axis].size == pytest.approx(size, abs=1e-4)
    assert len(fitted.frames) <= 2 * len({key.at for of_axis in keys.values() for key in of_axis}) + 2


def test_a_stick_held_at_several_speeds_has_keyframes_where_the_speed_changes(tmp_path: Path) -> None:
    speeds = [(0.5, 20), (2, 45), (3, 0), (4, -30), (6, 0)]
    take = stick_take(tmp_path / "take.mcap", speeds, 7.5)
    fitted = keyframes(take, 0.2)
    assert furthest(fitted.text, take, tmp_path)[PAN] <= 0.2
    assert len(fitted.frames) <= 20
    assert "hold: " in fitted.text


def test_rests_are_holds_or_stops_of_the_same_length(tmp_path: Path) -> None:
    keys = {
        PAN: [Key(1, 0), Key(4, 30, hold=2), Key(10, 60, stop=True), Key(13, 90)],
        TILT: [Key(1, 0), Key(4, 10, hold=2), Key(8, -5, hold=1), Key(13, 20)],
    }
    take = planned_take(tmp_path / "take.mcap", keys, 14)
    move = played(keyframes(take, 0.2).text, take, tmp_path).move
    times = np.arange(0, 14, 0.01)
    for axis, spans in {PAN: [(0, 1), (4, 6), (13, 14)], TILT: [(0, 1), (4, 6), (8, 9), (13, 14)]}.items():
        moving = np.abs(move.tracks[axis].sample(times)[1]) > 1e-6
        for begin, end in spans:
            assert not moving[(times > begin + 0.4) & (times < end - 0.4)].any()
    assert abs(move.tracks[PAN].at(10).velocity) < 1e-6


def test_actions_of_the_camera_are_cues_and_numbers_are_for_people(tmp_path: Path) -> None:
    keys = {PAN: [Key(0, -1 / 3), Key(5, 100 / 3)]}
    acts = {100: [Action.RECORD], 333: [Action.SHUTTER, DeviceCommand("gimbal", "recenter")], 500: [Action.STOP]}
    move = plan(keys, SIM)
    path = write_take(tmp_path / "take.mcap", {PAN: move.tracks[PAN].at}, 5, acts=acts, limits={PAN: SIM[PAN]})
    text = keyframes(read_take(path), 0.2).text
    cues = [(round(cue.at, 2), cue.action) for cue in played(text, read_take(path), tmp_path).cues]
    assert cues == [(1.0, Action.RECORD), (3.33, Action.SHUTTER), (5.0, Action.STOP)]
    numbers = re.findall(r"-?\d+\.?\d*", text.partition("keyframes:")[2])
    assert all(len(number.partition(".")[2]) <= 2 for number in numbers)
    assert "pan: -0.33" in text


def test_what_was_measured_can_be_followed_instead(tmp_path: Path) -> None:
    move = plan({PAN: [Key(0, 0), Key(3, 30), Key(6, 10)]}, SIM)

    def late(time: float) -> float:
        return round(move.tracks[PAN].at(time - 0.3).position, 1)

    path = write_take(
        tmp_path / "take.mcap", {PAN: move.tracks[PAN].at}, 7, measured={PAN: late}, limits={PAN: SIM[PAN]}
    )
    take = read_take(path)
    followed = played(keyframes(take, 0.3, measured=True).text, take, tmp_path).move.tracks[PAN]
    times = np.arange(0, 6.9, 0.04)
    assert np.abs(followed.sample(times)[0] - [late(time) for time in times]).max() <= 0.3
    assert abs(followed.at(2.0).position - move.at(2.0)[PAN].position) > 2


def test_a_cut_take_is_fitted_as_far_as_it_goes_and_stops(tmp_path: Path) -> None:
    move = plan({PAN: [Key(0, 0), Key(8, 40)]}, SIM)
    path = write_take(tmp_path / "t.mcap", {PAN: move.tracks[PAN].at}, 4, limits={PAN: SIM[PAN]}, closed=False)
    take = read_take(path)
    text = keyframes(take, 0.2).text
    ended = played(text, take, tmp_path).move
    assert ended.at(3.9)[PAN].position == pytest.approx(move.at(3.9)[PAN].position, abs=0.2)
    assert 4.0 < ended.duration < 4.6


@pytest.mark.parametrize(
    ("limits", "said"),
    [
        (
            Limits(-180, 180, 9, 240, 1200),
            "a sequence may use 95% of its velocity limit and would be 10.3 behind; use --speed 55%",
        ),
        (Limits(-180, 180, 120, 7, 40), "keyframes cannot follow the take"),
    ],
)
def test_what_a_sequence_may_not_do_is_refused_with_when_and_what_would_help(
    limits: Limits, said: str, tmp_path: Path
) -> None:
    move = plan({PAN: [Key(0, 0), Key(5, 40)]}, SIM)
    path = write_take(tmp_path / "t.mcap", {PAN: move.tracks[PAN].at}, 5, limits={PAN: limits})
    with pytest.raises(UnplayableError) as refusal:
        keyframes(read_take(path), 0.2)
    assert said in refusal.value.problems[0]
    assert "use " in refusal.value.problems[0]


def test_a_take_that_is_too_fast_for_a_sequence_is_fitted_at_the_speed_it_was_told(tmp_path: Path) -> None:
    move = plan({PAN: [Key(0, 0), Key(5, 40)]}, SIM)
    slow = {PAN: Limits(-180, 180, 9, 240, 1200)}
    take = read_take(write_take(tmp_path / "t.mcap", {PAN: move.tracks[PAN].at}, 5, limits=slow))
    slowed = played(keyframes(take, 0.2, 0.55).text, take, tmp_path).move
    assert slowed.at(2 / 0.55)[PAN].position == pytest.approx(move.at(2)[PAN].position, abs=0.2)


def test_an_axis_that_never_moved_has_one_key(tmp_path: Path) -> None:
    take = read_take(write_take(tmp_path / "t.mcap", {PAN: at_rest(12.5)}, 2.0, limits={PAN: LIMITS}))
    assert keyframes(take, 0.2).text == 'title: "t"\nkeyframes:\n  - {at: 0, pan: 12.5, hold: 2s}\n'


def test_the_command_writes_a_file_that_check_accepts_and_says_how_far_off_it_is(tmp_path: Path) -> None:
    assert teleop("play", "nudge", "--fast", "--take", "n.mcap", cwd=tmp_path).returncode == 0
    done = teleop("take", "keyframes", "n.mcap", "-o", "n.yaml", "--json", cwd=tmp_path)
    assert (done.returncode, done.stderr) == (0, "")
    said = json.loads(done.stdout)
    assert said["keyframes"] <= 14
    assert all(each["error"] <= 0.2 for each in said["largest_errors"].values())
    assert teleop("check", "n.yaml", cwd=tmp_path).returncode == 0


@pytest.mark.parametrize(
    ("arguments", "line"),
    [
        (["-o", "n.yaml"], "teleop: -o n.yaml: already exists; give --overwrite to replace it\n"),
        (["-o", "n.txt"], "teleop: -o n.txt: its ending must be .yaml or .yml\n"),
        (["-o", "m.yaml", "--tolerance", "0"], "teleop: --tolerance 0: must be more than 0 degrees\n"),
        (["-o", "m.yaml", "--speed", "fast"], "--speed fast: must be a percentage above 0, as in 50%\n"),
    ],
)
def test_bad_usage_is_said_in_one_line_before_anything_is_read(
    arguments: list[str], line: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "n.yaml").write_text("mine")
    assert run(["take", "keyframes", "n.mcap", *arguments]) == 2
    assert capsys.readouterr().err == line
    assert (tmp_path / "n.yaml").read_text() == "mine"

"""Sequence files: every error at its line, and what a right one compiles to."""

import re
from pathlib import Path

import pytest

import teleop
from sequences import RIGS, load, problems_of
from teleop.config.documents.document import UnplayableError
from teleop.config.profile import load_profile
from teleop.config.resources import folder
from teleop.core.axes import Axis
from teleop.core.events import Action
from teleop.planner.keyframes.ramp import Ramp
from teleop.sequence.compile import load_sequence
from teleop.sequence.cues import Cue


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ("title: x\n", "shoot.yaml:1:1: keyframes is missing"),
        ("keyframes: []\n", "shoot.yaml:1:12: keyframes must have at least 1"),
        ("keyframes:\n  - {pan: 1}\n", "shoot.yaml:2:5: key 1: at is missing"),
        ("keyframes:\n  - {at: 0}\n", "shoot.yaml:2:5: key 1 has no axis (pan, tilt, roll, focus)"),
        (
            "keyframes:\n  - {at: 0, pan: 0}\n  - {at: 6.5, pan: 1}\n  - {at: 6, tilt: 1}\n",
            "shoot.yaml:4:10: key 3: at must be after key 2 (6.5 s)",
        ),
        (
            "keyframes:\n  - {at: 0, pan: 0, hold: 3s}\n  - {at: 1, tilt: 1}\n  - {at: 2, pan: 1}\n",
            "shoot.yaml:4:10: key 3: at must be after key 1 has held pan (until 3 s)",
        ),
        ("keyframes:\n  - {at: soon, pan: 0}\n", "shoot.yaml:2:10: key 1: at must be a time (4, 4s, 1m30s,"),
        ("keyframes:\n  - {at: 96f, pan: 0}\n", "shoot.yaml:2:10: key 1: at is 96f, in frames, which needs fps"),
        ("keyframes:\n  - {at: 0, pna: 0}\n", "shoot.yaml:2:13: key 1: unknown key `pna`; did you mean `pan`?"),
        ("keyframes:\n  - {at: 0, pan: left}\n", "shoot.yaml:2:18: key 1: pan must be a number, not 'left'"),
        (
            "keyframes:\n  - {at: 0, pan: 0, pass: by}\n",
            "shoot.yaml:2:27: key 1: pass must be one of through, stop, not 'by'",
        ),
        (
            "keyframes:\n  - {at: 0, pan: 0}\ncues:\n  - {at: 0, camera: rcord}\n",
            "shoot.yaml:4:21: cue 1: camera must be one of record, stop, shutter, focus, end_focus, not 'rcord'; did",
        ),
        ("keyframes: 3\n", "shoot.yaml:1:12: keyframes must be a list, not 3"),
        ("- 3\n", "shoot.yaml:1:1: must be a mapping, not [3]"),
    ],
)
def test_what_is_wrong_is_said_where_it_stands(tmp_path: Path, text: str, problem: str) -> None:
    assert any(line.startswith(problem) for line in problems_of(tmp_path, text))


def test_all_errors_come_at_once_whatever_their_kind(tmp_path: Path) -> None:
    text = "keyframes:\n  - {at: 0, pan: 200}\n  - {at: -1, tilt: x}\n  - {at: 3, roll: 1}\nrepeet: 3\n"
    assert [problem.split(":")[1] for problem in problems_of(tmp_path, text)] == ["2", "3", "3", "4", "5"]


def test_what_the_rig_cannot_do_is_another_kind_of_error(tmp_path: Path) -> None:
    text = "keyframes:\n  - {at: 0, pan: 200}\n  - {at: 3, roll: 1}\n"
    assert problems_of(tmp_path, text, UnplayableError) == [
        "shoot.yaml:2:18: key 1: pan must be within -180..180 (the rig), not 200",
        "shoot.yaml:3:19: key 2: roll: the rig has no roll; it has pan, tilt, focus",
    ]


def test_an_infeasible_move_names_keyframe_axis_limit_and_a_time_that_does(tmp_path: Path) -> None:
    text = "keyframes:\n  - {at: 0, pan: -60}\n  - {at: %s, pan: 60}\n"
    [problem] = problems_of(tmp_path, text % 1, UnplayableError)
    assert problem.startswith("shoot.yaml:3:5: pan needs ")
    assert " s from key 1 to key 2, not 1.000 s (jerk would be " in problem
    shortest = float(problem.split(" needs ")[1].split(" s ")[0])
    assert shortest > 1
    assert load(tmp_path, text % (shortest + 0.001)).duration == pytest.approx(shortest + 0.001)
    problems_of(tmp_path, text % (shortest * 0.95), UnplayableError)


def test_a_sequence_compiles_to_a_move_and_cues(tmp_path: Path) -> None:
    performance = load(
        tmp_path,
        "title: Test\nfps: 25\nkeyframes:\n  - {at: 0, pan: -10, focus: 0.2}\n  - {at: 50f, pan: 10, pass: stop}\n"
        "  - {at: 4s, tilt: 5}\n  - {at: 5s, pan: 20, hold: 1s}\ncues:\n  - {at: 8, camera: stop}\n"
        "  - {at: 0, camera: record}\n",
    )
    assert performance.title == "Test"
    assert performance.cues == [Cue(0, Action.RECORD), Cue(8, Action.STOP)]
    assert performance.duration == 8
    move = performance.move
    assert move.duration == 6
    assert move.at(2.0)[Axis.PAN].position == pytest.approx(10, abs=1e-3)
    assert move.at(2.0)[Axis.PAN].velocity == pytest.approx(0, abs=1e-6)
    assert move.at(5.5)[Axis.PAN] == (20, 0, 0)
    assert move.at(0.0)[Axis.TILT].position == 5
    assert set(move.tracks) == {Axis.PAN, Axis.TILT, Axis.FOCUS}


PLAYED = [file for file in sorted(folder("sequences").glob("*.yaml")) if "timelapse:" not in file.read_text()]


@pytest.mark.parametrize("name", [file.stem for file in PLAYED])
def test_every_shipped_sequence_plays_on_a_simulated_rig(name: str) -> None:
    rig = load_profile(RIGS.get(name, "sim"))
    performance = load_sequence(name, rig.limits, rig.name, [sink.type for sink in rig.sinks])
    assert performance.warnings == []


def test_a_timelapse_is_not_played_as_if_its_frames_were_seconds(tmp_path: Path) -> None:
    text = (
        "timelapse: {frames: 9, interval: 3s, exposure: 0.1s}\nfps: 24\nkeyframes: [{at: 0, pan: 0}, {at: 8, pan: 1}]\n"
    )
    assert problems_of(tmp_path, text) == ["shoot.yaml:1:12: timelapse has keyframes in frames: it is shot, not played"]
    assert teleop.plan(tmp_path / "shoot.yaml").duration < 1


def test_a_move_that_is_too_fast_is_stretched_when_asked_and_says_by_how_much(tmp_path: Path) -> None:
    text = "fit: stretch\nkeyframes:\n  - {at: 0, pan: -60}\n  - {at: 1, pan: 60}\ncues:\n  - {at: 1, camera: stop}\n"
    performance = load(tmp_path, text)
    factor = performance.move.duration
    assert 1 < factor < 3
    assert performance.cues[0].at == pytest.approx(factor)
    assert performance.keys[Axis.PAN][1].at == pytest.approx(factor)
    [warning] = performance.warnings
    assert f"shoot.yaml:1:6: fit stretched it {factor:.3f} x" in warning
    assert load(tmp_path, text.replace("at: 1", "at: 9")).warnings == []


def test_tension_evens_the_speed_between_keys(tmp_path: Path) -> None:
    text = "tension: 0\nkeyframes:\n  - {at: 0, pan: 0}\n  - {at: 5, pan: 20}\n  - {at: 10, pan: 80}\n"
    smooth = load(tmp_path, text).move.peaks()[Axis.PAN]
    even = load(tmp_path, text.replace("tension: 0", "tension: 1")).move.peaks()[Axis.PAN]
    assert even.velocity < smooth.velocity * 0.98
    assert even.jerk > smooth.jerk


def test_a_bounce_goes_there_and_back_and_a_loop_ends_where_it_began(tmp_path: Path) -> None:
    text = "repeat: {times: 3, mode: bounce}\nkeyframes:\n  - {at: 0, pan: 0}\n  - {at: 4, pan: 20}\n"
    move = load(tmp_path, text).move
    assert move.duration == 12
    assert [round(move.at(time)[Axis.PAN].position, 3) for time in (0, 4, 8, 12)] == [0, 20, 0, 20]
    [problem] = problems_of(tmp_path, text.replace("bounce", "loop"))
    assert problem == ("shoot.yaml:1:9: repeat pan, key 2: a loop must end where it began, at 0, not 20")


def test_ease_of_the_file_of_a_key_and_of_one_end_of_it(tmp_path: Path) -> None:
    text = (
        "ease: 1s\nkeyframes:\n  - {at: 0, pan: 0, ease: smooth}\n"
        "  - {at: 4, pan: 20, pass: stop, ease: {leave: 25%}}\n"
        "  - {at: 8, pan: 30}\n  - {at: 12, pan: 60}\n"
    )
    first, stop, through, last = load(tmp_path, text).keys[Axis.PAN]
    assert (first.arrive, first.leave) == (None, None)
    assert (stop.arrive, stop.leave) == (Ramp(1.0), Ramp(share=0.25))
    assert (through.arrive, last.arrive) == (Ramp(1.0), Ramp(1.0))


def test_ramps_are_refused_or_lengthened_with_the_line_of_their_key(tmp_path: Path) -> None:
    text = "ease: 3s\nkeyframes:\n  - {at: 0, pan: 0}\n  - {at: 4, pan: 20}\n"
    [problem] = problems_of(tmp_path, text, UnplayableError)
    ramps = "pan needs 6.000 s for its ramps (3 s + 3 s) from key 1 to key 2, not 4.000 s; or a shorter `ease`"
    assert problem == f"shoot.yaml:4:5: {ramps}"
    warnings = load(tmp_path, text.replace("3s", "0.01s")).warnings
    assert [re.sub(r"\d\.\d\d s at", "# s at", warning.removeprefix(f"{tmp_path}/")) for warning in warnings] == [
        "shoot.yaml:3:5: pan needs a ramp of # s at key 1, not 0.01 s",
        "shoot.yaml:4:5: pan needs a ramp of # s at key 2, not 0.01 s",
    ]


def test_preroll_and_back_to_one_are_the_files(tmp_path: Path) -> None:
    text = "keyframes: [{at: 0, pan: 0}, {at: 4, pan: 20}]\n"
    assert (load(tmp_path, text).preroll, load(tmp_path, text).back_to_one) == (0.5, False)
    asked = load(tmp_path, "fps: 25\npreroll: 75f\nback_to_one: true\n" + text)
    assert (asked.preroll, asked.back_to_one) == (3.0, True)
    assert problems_of(tmp_path, "preroll: soon\nback_to_one: 1\n" + text) == [
        "shoot.yaml:1:10: preroll must be a time (4, 4s, 1m30s, 96f or 00:00:04:00), not 'soon'",
        "shoot.yaml:2:14: back_to_one must be true or false, not 1",
    ]


def test_a_program_plans_a_sequence_for_a_rig_in_one_call(tmp_path: Path) -> None:
    file = tmp_path / "shoot.yaml"
    file.write_text("keyframes:\n  - {at: 0, pan: 0}\n  - {at: 4, pan: 20}\n")
    move = teleop.plan(file, rig="sim")
    assert move.duration == 4
    assert move.at(4)[Axis.PAN].position == 20
    assert teleop.plan("reveal").duration == 15


def test_a_title_stands_in_one_line_of_a_screen(tmp_path: Path) -> None:
    text = "keyframes: [{at: 0, pan: 0}]\n"
    assert load(tmp_path, "title: |\n  Two\n  lines\n" + text).title == "Two lines"
    assert load(tmp_path, "title: ' '\n" + text).title == "shoot"
    assert problems_of(tmp_path, f"title: {'x' * 201}\n{text}") == [
        "shoot.yaml:1:8: title must be at most 200 characters"
    ]


def test_what_is_empty_is_called_so(tmp_path: Path) -> None:
    assert problems_of(tmp_path, "keyframes:\n  - {at: , pan: 1, hold: ~}\n") == [
        "shoot.yaml:2:10: key 1: at must be a time (4, 4s, 1m30s, 96f or 00:00:04:00), not empty",
        "shoot.yaml:2:26: key 1: hold must be a time (4, 4s, 1m30s, 96f or 00:00:04:00), not empty",
    ]


def test_an_axis_that_is_empty_is_not_there(tmp_path: Path) -> None:
    text = "keyframes:\n  - {at: 0, pan: 0, tilt: ~, hold: 3}\n  - {at: 2, pan: ~, tilt: 5}\n  - {at: 5, pan: 9}\n"
    assert load(tmp_path, text).duration == 5


def test_key_numbers_are_those_of_the_file_in_errors_options_and_previews(tmp_path: Path) -> None:
    """A recentre adds keys in between, and an axis may leave keys out: the numbers stay those that a person counts."""
    text = (
        "keyframes:\n  - {at: 0, pan: 0}\n  - {at: 4, pan: 20, hold: 8}\n  - {at: 6, tilt: 5}\n"
        "  - {at: 7, tilt: 5}\n  - {at: 20, pan: 30}\ncues:\n  - {at: 12, recenter: 4s}\n"
    )
    performance = load(tmp_path, text)
    assert list(performance.key_times) == [0, 4, 6, 7, 20]
    named = {key.at: key.where for of_axis in performance.keys.values() for key in of_axis}
    assert named == {0: "key 1", 4: "key 2", 6: "key 3", 7: "key 4", 12: "cue 1", 16: "cue 1", 20: "key 5"}
    [problem] = problems_of(tmp_path, text.replace("at: 20", "at: 7"))
    assert problem == "shoot.yaml:6:10: key 5: at must be after key 4 (7 s)"


def test_a_move_made_of_others_has_its_keys_numbered_in_time(tmp_path: Path) -> None:
    performance = load(tmp_path, "include: [{move: nudge, at: 0}]\n")
    assert list(performance.key_times) == [0, 3, 9, 12, 15, 18]
    assert performance.keys[Axis.PAN][1].where == "include 1, key 2"

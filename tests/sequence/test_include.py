"""Sequences within sequences: where they are found, how they are laid in, and errors with all the places they have."""

from __future__ import annotations

import time
from pathlib import Path

import pytest

from sequences import LIMITS, load, problems_of
from teleop.config.documents.document import DocumentError, UnplayableError
from teleop.core.axes import Axis
from teleop.core.events import Action
from teleop.sequence.compile import load_sequence
from teleop.sequence.cues import Cue

PART = "fps: 25\nkeyframes:\n  - {at: 1, pan: 0}\n  - {at: 100f, pan: 30}\ncues: [{at: 3, camera: record}]\n"


def test_a_part_is_laid_in_where_and_as_fast_as_is_said_with_its_cues(tmp_path: Path) -> None:
    (tmp_path / "part.yaml").write_text(PART)
    text = "include:\n  - {move: part.yaml, at: 2s}\n  - {move: ./part.yaml, at: 10, speed: 150%}\n"
    performance = load(tmp_path, text)
    keys = performance.keys[Axis.PAN]
    assert [key.at for key in keys] == pytest.approx([3, 6, 10 + 1 / 1.5, 10 + 4 / 1.5])
    assert [key.position for key in keys] == [0, 30, 0, 30]
    assert performance.cues == [Cue(5, Action.RECORD), Cue(12, Action.RECORD)]
    whole = load_sequence(str(tmp_path / "part.yaml"), LIMITS, "the rig").move
    for moment in (1.0, 2.3, 3.9, 4.0):
        assert performance.move.at(2 + moment)[Axis.PAN] == pytest.approx(whole.at(moment)[Axis.PAN], abs=1e-6)
        p, v, _ = whole.at(moment)[Axis.PAN]
        assert performance.move.at(10 + moment / 1.5)[Axis.PAN][:2] == pytest.approx((p, 1.5 * v), abs=1e-5)


def test_it_keeps_its_own_tension_ease_repeat_and_recentre(tmp_path: Path) -> None:
    part = (
        "tension: 1\nease: 0.5s\nrepeat: {times: 2, mode: bounce}\nkeyframes:\n  - {at: 0, pan: 10}\n"
        "  - {at: 5, pan: 25}\n  - {at: 10, pan: 90}\ncues: [{at: 20, recenter: 2s}]\n"
    )
    (tmp_path / "part.yaml").write_text(part)
    whole = load_sequence(str(tmp_path / "part.yaml"), LIMITS, "the rig").move
    laid = load(tmp_path, "include: [{move: part.yaml, at: 1}]\nkeyframes: [{at: 30, pan: 5}]\n").move
    assert whole.duration == 22
    for moment in range(23):
        assert laid.at(1.0 + moment)[Axis.PAN] == pytest.approx(whole.at(moment)[Axis.PAN], abs=1e-6)


def test_a_shipped_name_and_a_part_of_a_part_in_another_folder(tmp_path: Path) -> None:
    (tmp_path / "inner").mkdir()
    (tmp_path / "inner" / "a.yaml").write_text("include: [{move: b.yaml, at: 1}]\n")
    (tmp_path / "inner" / "b.yaml").write_text("include: [{move: reveal, at: 1}]\n")
    performance = load(tmp_path, "include: [{move: inner/a.yaml, at: 1}]\n")
    assert performance.duration == 18
    assert performance.keys[Axis.FOCUS][0].where == "include 1, include 1, include 1, key 1"


def test_an_error_is_said_where_it_stands_and_where_that_was_included(tmp_path: Path) -> None:
    (tmp_path / "a.yaml").write_text("title: x\ninclude:\n  - {move: b.yaml, at: 1}\nzoom: 3\n")
    (tmp_path / "b.yaml").write_text("keyframes:\n  - {at: 1, pan: 0}\n  - {at: 1, pan: 900}\n")
    text = "include:\n  - {move: a.yaml, at: 0}\n  - {move: none.yaml, at: 0}\n  - {move: a.yaml, at: 0, speed: 0%}\n"
    by_a, by_b = (" (included at shoot.yaml:%d:5)", " (included at a.yaml:3:5) (included at shoot.yaml:%d:5)")
    assert sorted(problems_of(tmp_path, text)) == sorted(
        [
            "shoot.yaml:3:12: include 2: move: none.yaml: no such file",
            "shoot.yaml:4:34: include 3: speed must be 1% to 1000%",
        ]
        + ["a.yaml:4:1: unknown key `zoom`" + by_a % line for line in (2, 4)]
        + ["b.yaml:3:10: key 2: at must be after key 1 (1 s)" + by_b % line for line in (2, 4)]
        + ["b.yaml:3:18: key 2: pan must be within -180..180 (the rig), not 900" + by_b % line for line in (2, 4)]
    )


def test_what_only_the_rig_cannot_do_is_that_kind_of_error_from_within_too(tmp_path: Path) -> None:
    (tmp_path / "part.yaml").write_text("keyframes:\n  - {at: 0, pan: 0}\n  - {at: 1, pan: 60}\n")
    [found] = problems_of(tmp_path, "include:\n  - {move: part.yaml, at: 3, speed: 200%}\n", UnplayableError)
    assert found.startswith("part.yaml:3:5: pan needs 1.261 s from include 1, key 1 to include 1, key 2, not 0.500 s ")
    assert found.endswith(" (included at shoot.yaml:2:5)")
    (tmp_path / "part.yaml").write_text("keyframes:\n  - {at: 0, roll: 0}\n")
    [found] = problems_of(tmp_path, "include:\n  - {move: part.yaml, at: 3}\n", UnplayableError)
    assert found.startswith("part.yaml:2:19: key 1: roll: the rig has no roll")


@pytest.mark.parametrize(
    ("entry", "problem"),
    [
        ("{move: shoot.yaml, at: 0}", "2:12: include 1: move includes itself: shoot.yaml -> shoot.yaml"),
        (
            "{move: a.yaml, at: 0}",
            "a.yaml:1:18: include 1: move includes itself: shoot.yaml -> a.yaml -> ",
        ),
        ("{move: lapse.yaml, at: 0}", "2:12: include 1: move is a timelapse: its times are frames, not seconds"),
        (
            "{move: revel, at: 0}",
            "2:12: include 1: move: revel: no sequence of that name is shipped;",
        ),
        ("{move: ., at: 0}", "2:12: include 1: move: .:"),
        ("{move: reveal}", "2:5: include 1: at is missing"),
        ("{move: reveal, at: 0, speed: 2}", "2:34: include 1: speed must be a percentage (30%), not 2"),
        ("{move: 3, at: 0}", "2:12: include 1: move must be text, not 3"),
        ("reveal", "2:5: include 1 must be a mapping, not 'reveal'"),
    ],
)
def test_what_cannot_be_included(tmp_path: Path, entry: str, problem: str) -> None:
    (tmp_path / "a.yaml").write_text("include: [{move: shoot.yaml, at: 0}]\n")
    (tmp_path / "lapse.yaml").write_text(
        "timelapse: {frames: 9, interval: 3s, exposure: 0.1s}\nkeyframes: [{at: 0, pan: 0}, {at: 8, pan: 1}]\n"
    )
    found = problems_of(tmp_path, f"include:\n  - {entry}\n")
    start = problem if problem.startswith("a.yaml") else f"shoot.yaml:{problem}"
    assert [line for line in found if line.startswith(start)], found


def test_two_may_not_want_an_axis_at_once(tmp_path: Path) -> None:
    (tmp_path / "part.yaml").write_text("keyframes:\n  - {at: 0, pan: 0}\n  - {at: 4, pan: 30}\n")
    text = "include:\n  - {move: part.yaml, at: 1}\n  - {move: part.yaml, at: 4}\nkeyframes:\n  - {at: 3, pan: 1}\n"
    assert problems_of(tmp_path, text) == [
        "shoot.yaml:5:5: key 1 must begin after include 1 ends (pan, 5 s)",
        "shoot.yaml:3:5: include 2 must begin after include 1 ends (pan, 5 s)",
    ]
    meets = "include:\n  - {move: part.yaml, at: 1}\nkeyframes:\n  - {at: 5, pan: 30, hold: 1}\n  - {at: 8, pan: 0}\n"
    assert load(tmp_path, meets).move.at(6.0)[Axis.PAN] == (30, 0, 0)


def test_a_cue_that_needs_rest_is_judged_by_all_that_moves(tmp_path: Path) -> None:
    (tmp_path / "part.yaml").write_text("keyframes: [{at: 0, tilt: 0}]\ncues:\n  - {at: 2, follow: lock}\n")
    text = "include: [{move: part.yaml, at: 1}]\nkeyframes: [{at: 0, pan: 0}, {at: 9, pan: 40}]\n"
    [found] = problems_of(tmp_path, text)
    assert found.startswith("part.yaml:3:5: cue 1 is at 3 s, while pan moves; put it at 0 s or 9 s")
    assert found.endswith(" (included at shoot.yaml:1:11)")


def test_sticks_at_another_speed_are_a_warning(tmp_path: Path) -> None:
    part = "keyframes: [{at: 0, stick_yaw: 0}, {at: 2, stick_yaw: 0.5}, {at: 4, stick_yaw: 0}]\n"
    (tmp_path / "part.yaml").write_text(part)
    text = "title: stick_\ninclude:\n  - {move: part.yaml, at: 1, speed: 50%}\n"
    [warning] = load(tmp_path, text).warnings
    assert "shoot.yaml:3:37: include 1: speed leaves stick_yaw as far as they are" in warning


def test_what_would_include_a_million_files_is_refused_soon(tmp_path: Path) -> None:
    for level in range(8):
        entries = "".join(f"  - {{move: {level + 1}.yaml, at: {at * 10**level}}}\n" for at in range(10))
        (tmp_path / f"{level}.yaml").write_text("include:\n" + entries)
    (tmp_path / "8.yaml").write_text("keyframes: [{at: 0, pan: 0}]\n")
    began = time.thread_time()
    found = problems_of(tmp_path, "include: [{move: 0.yaml, at: 0}]\n")
    assert time.thread_time() - began < 3
    assert any("is too much: at most 200 files can be included" in line for line in found)
    (tmp_path / "deep.yaml").write_text("include: [{move: deeper.yaml, at: 0}]\n")
    (tmp_path / "8.yaml").write_text("include: [{move: 9.yaml, at: 0}]\n")
    (tmp_path / "9.yaml").write_text("keyframes: [{at: 0, pan: 0}]\n")
    for level in range(8):
        (tmp_path / f"{level}.yaml").write_text(f"include: [{{move: {level + 1}.yaml, at: 0}}]\n")
    with pytest.raises(DocumentError, match="is too deep: at most 8 files within files"):
        load(tmp_path, "include: [{move: 0.yaml, at: 0}]\n")


def test_so_are_more_keys_than_can_be_planned(tmp_path: Path) -> None:
    text = "repeat: {times: 10000, mode: bounce}\nkeyframes: [{at: 0, pan: 0}, {at: 5, pan: 9}, {at: 9, pan: 20}]\n"
    assert problems_of(tmp_path, text) == [
        "shoot.yaml:1:17: repeat.times needs 20001 keys of pan; the maximum is 10000"
    ]

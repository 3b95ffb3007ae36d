"""`teleop check`: what it says of a move, for people and for programs."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest

from teleop.cli import run

PAN = """\
title: Pan
keyframes:
- {at: 0s, pan: 0}
- {at: 4s, pan: 20}
"""
CUES = """\
cues:
- {at: 1s, camera: shutter}
- {at: 2s, camera: shutter}
- {at: 3s, camera: record}
- {at: 4s, camera: stop}
"""
TIMELAPSE = """\
title: Dusk
fps: 24
keyframes:
- {at: 0, pan: 0}
- {at: 4, pan: 20}
timelapse: {mode: shoot-move-shoot, frames: 5, interval: 4s, exposure: 0.5s}
"""


@pytest.fixture(autouse=True)
def _wide(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("COLUMNS", "120")
    monkeypatch.chdir(tmp_path)


def checked(text: str, capsys: pytest.CaptureFixture[str], *options: str) -> str:
    Path("move.yaml").write_text(text)
    assert run(["check", "move.yaml", "--rig", "sim", *options]) == 0
    return capsys.readouterr().out


def test_cues_of_one_kind_are_counted(capsys: pytest.CaptureFixture[str]) -> None:
    assert "Cues: 2 x shutter, record, stop." in checked(PAN + CUES, capsys).splitlines()
    assert "Cues" not in checked(PAN, capsys)


def test_the_table_has_a_row_for_each_axis_that_moves(capsys: pytest.CaptureFixture[str]) -> None:
    rows = [line.replace("│", " ").split() for line in checked(PAN, capsys).splitlines()]
    uses = [row for row in rows if sum(word.endswith("%") for word in row) > 1]
    velocity = json.loads(checked(PAN, capsys, "--json"))["axes"]["pan"]["velocity"]
    assert [row[:2] for row in uses] == [["pan", f"{velocity:.0%}"]]


def test_a_timelapse_is_summed_up_and_its_table_is_of_its_rehearsal(capsys: pytest.CaptureFixture[str]) -> None:
    text = " ".join(checked(TIMELAPSE, capsys).split())
    assert "5 frames, 4 s apart: 16.0 s of shooting, 0.21 s of clip at 24 fps. The table is of its rehearsal." in text


def test_programs_are_told_of_a_timelapse_only_where_there_is_one(capsys: pytest.CaptureFixture[str]) -> None:
    found = json.loads(checked(TIMELAPSE, capsys, "--json"))
    assert (found["ok"], found["title"], found["timelapse"]["frames"]) == (True, "Dusk", 5)
    assert "timelapse" not in json.loads(checked(PAN, capsys, "--json"))


def test_it_ends_with_the_peaks_in_units_and_a_verdict(capsys: pytest.CaptureFixture[str]) -> None:
    lines = checked(PAN, capsys).splitlines()
    assert re.fullmatch(r"pan  peak 9\.\d+ of 120 deg/s at 2\.0 s", lines[-2])
    assert lines[-1] == "OK: Simulated rig can play this."
    found = json.loads(checked(PAN, capsys, "--json"))
    assert found["axes"]["pan"]["peak_velocity"] == pytest.approx(9.5, abs=0.5)
    assert found["axes"]["pan"]["peak_at"] == pytest.approx(2, abs=0.05)


def test_a_slow_move_is_a_remark_that_the_verdict_counts(capsys: pytest.CaptureFixture[str]) -> None:
    lines = checked(PAN.replace("pan: 20", "pan: 1"), capsys).splitlines()
    assert lines[-2].startswith("Remark: pan moves 1 deg in 97 frames at 24 fps")
    assert lines[-1] == "OK: Simulated rig can play this, with 1 warning."


def test_the_frames_of_a_table_are_compared_with_the_plan(capsys: pytest.CaptureFixture[str]) -> None:
    Path("track.csv").write_text("ry\n" + "".join(f"{0.5 * frame}\n" for frame in range(60)))
    text = "source: {file: track.csv, fps: 24, columns: {pan: ry}}\n"
    out = checked(text, capsys)
    assert re.search(
        r"^track\.csv: pan is within 0\.0\d+ of 0\.1 deg, worst at frame \d+; \d+ keys for 60 frames$", out, re.M
    )
    found = json.loads(checked(text, capsys, "--json"))["frames"]["pan"]
    assert (found["tolerance"], found["frames"], found["off"] <= 0.1) == (0.1, 60, True)


def test_a_refusal_ends_with_a_verdict_too(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "move.yaml"
    file.write_text("keyframes:\n- {at: 0, pan: 0}\n- {at: 0.1, pan: 70}\n")
    assert run(["check", str(file)]) == 1
    assert capsys.readouterr().out == "Not OK: Simulated rig cannot play this, 1 problem.\n"
    file.write_text("keyframes: 3\nfsp: 24\n")
    assert run(["check", str(file)]) == 2
    assert capsys.readouterr().out == "Not OK: this cannot be read, 2 problems.\n"
    assert run(["check", str(file), "--json"]) == 2
    assert "Not OK" not in capsys.readouterr().out

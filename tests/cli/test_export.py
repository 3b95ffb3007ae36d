"""`teleop export`: each format by its ending, what is beside it, what is not carried, and what is never replaced."""

from __future__ import annotations

import csv
import json
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest
from made_takes import at_rest, write_take

from teleop.cli import run
from teleop.core.axes import Axis, State
from teleop.core.events import Action
from teleop.recording.reader import read_take

MOVE = """title: Shot
fps: 23.976
keyframes:
  - {at: 0, pan: -10, tilt: 0, focus: 0.2}
  - {at: 2, pan: 10, tilt: 5, focus: 0.4, hold: 1s, ease: 0.5s}
  - {at: 5, pan: 0, tilt: 0}
cues:
  - {at: 0, camera: record}
  - {at: 5, camera: stop}
"""


@pytest.fixture
def move(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    file = tmp_path / "shot.yaml"
    file.write_text(MOVE)
    return file


@pytest.fixture
def take(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Two axes of which one was measured, a quarter of a degree beside where it was to be."""
    monkeypatch.chdir(tmp_path)
    motion = {Axis.PAN: lambda t: State(5 * t, 5.0, 0.0), Axis.TILT: at_rest(3.0)}
    measured = {Axis.PAN: lambda t: 5 * t + 0.25}
    return write_take(tmp_path / "run.mcap", motion, 2.0, measured=measured, acts={50: [Action.RECORD]})


@pytest.mark.parametrize("ending", ["chan", "csv", "arcm", "raw", "asc", "usda", "usdc", "usd", "py", "otio"])
def test_each_ending_is_a_format_and_says_its_rate_axes_and_order(
    move: Path, ending: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(["export", "shot.yaml", "-o", f"shot.{ending}"]) == 0
    printed = capsys.readouterr()
    assert "23.976 fps" in printed.out
    files = sorted(each.name for each in move.parent.glob(f"shot.{ending}*"))
    has_own = ending in ("usda", "usdc", "usd", "py", "otio")
    assert files == [f"shot.{ending}"] if has_own else [f"shot.{ending}", f"shot.{ending}.json"]
    if ending == "usdc":
        return
    text = "".join(move.with_name(file).read_bytes().decode(errors="ignore") for file in files)
    if ending != "usd":
        assert "24000/1001" in text
        assert "ZXY" in text
        assert "degrees" in text
        assert "pan" in text


def test_what_a_format_cannot_carry_is_one_line_each(move: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["export", "shot.yaml", "-o", "shot.chan"]) == 0
    lines = [line for line in capsys.readouterr().err.splitlines() if line.startswith("not carried: ")]
    for what in ("keys", "holds", "eases", "focus", "2 cues", "the field of view"):
        assert sum(line.startswith(f"not carried: {what}") for line in lines) == 1, what
    assert json.loads(move.with_name("shot.chan.json").read_text())["not_carried"] == [line[13:] for line in lines]
    assert run(["export", "shot.yaml", "-o", "shot.otio"]) == 0
    lines = [line.partition(": ")[2] for line in capsys.readouterr().err.splitlines()]
    assert [line[:5] for line in lines] == ["keys,", "holds", "eases"]
    assert all(line in move.with_name("shot.otio").read_text() for line in lines)


@pytest.mark.parametrize("ending", ["usda", "py"])
def test_a_file_with_a_place_for_notes_has_within_what_it_does_not_carry(move: Path, ending: str) -> None:
    assert run(["export", "shot.yaml", "-o", f"shot.{ending}"]) == 0
    text = move.with_name(f"shot.{ending}").read_text()
    for what in ("keys, with their tension and repeats", "holds: ", "eases: ", "2 cues: export them as .otio"):
        assert what in text


def test_a_move_without_a_rate_is_written_at_24_and_says_so(move: Path, capsys: pytest.CaptureFixture[str]) -> None:
    move.write_text(MOVE.replace("fps: 23.976\n", ""))
    assert run(["export", "shot.yaml", "-o", "shot.chan"]) == 0
    assert "shot.yaml: has no fps: written at 24 fps; --rate gives another" in capsys.readouterr().err
    assert run(["export", "shot.yaml", "-o", "other.chan", "--rate", "30000/1001", "--first-frame", "1001"]) == 0
    assert "has no fps" not in capsys.readouterr().err
    facts = json.loads(move.with_name("other.chan.json").read_text())
    assert (facts["frame_rate"], facts["first_frame"], facts["rotation_order"]) == ("30000/1001", 1001, "ZXY")
    assert move.with_name("other.chan").read_text().startswith("1001 0 0 0 0.000000000 10.000000000 ")


def test_a_take_has_the_measured_positions_at_the_times_of_the_recording(
    take: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(["export", "run.mcap", "-o", "run.csv"]) == 0
    assert "not carried: tilt: not measured; --commanded has where it was to be" in capsys.readouterr().err
    rows = list(csv.DictReader(take.with_name("run.csv").open()))
    times, positions = read_take(take).measured[Axis.PAN]
    assert list(rows[0]) == ["time", "pan"]
    assert [float(row["time"]) for row in rows] == pytest.approx(times.tolist(), abs=1e-6)
    assert [float(row["pan"]) for row in rows] == pytest.approx(positions.tolist(), abs=1e-6)
    facts = json.loads(take.with_name("run.csv.json").read_text())
    assert (facts["kind"], facts["row_times"]) == ("measured", "those of the recording")


@pytest.mark.parametrize("rate", [[], ["--rate", "25"]])
def test_the_columns_that_the_file_beside_a_table_names_are_those_of_its_first_line(
    take: Path, rate: Sequence[str]
) -> None:
    assert run(["export", "run.mcap", "-o", "run.csv", *rate]) == 0
    first = take.with_name("run.csv").read_text().splitlines()[0]
    assert json.loads(take.with_name("run.csv.json").read_text())["columns"] == first.split(",")


def test_a_take_by_the_frame_lies_between_its_readings(take: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["export", "run.mcap", "-o", "run.chan", "--rate", "24000/1001"]) == 0
    rows = np.loadtxt(take.with_name("run.chan"))
    expected = np.interp(np.arange(len(rows)) * 1001 / 24000, *read_take(take).measured[Axis.PAN])
    assert np.abs(-rows[:, 5] - expected).max() < 1e-6
    assert run(["export", "run.mcap", "-o", "plain.chan"]) == 0
    assert "run.mcap: has no frame rate: written at 24 fps; --rate gives another" in capsys.readouterr().err


def test_commanded_positions_and_a_single_pass_of_a_take(take: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["export", "run.mcap", "-o", "run.csv", "--commanded", "--rate", "50"]) == 0
    rows = list(csv.DictReader(take.with_name("run.csv").open()))
    assert [float(row["pan"]) for row in rows] == pytest.approx([0.1 * place for place in range(101)])
    assert {row["tilt"] for row in rows} == {"3.000000000"}
    assert run(["export", "run.mcap", "-o", "one.csv", "--pass", "1"]) == 0
    assert run(["export", "run.mcap", "-o", "two.csv", "--pass", "2"]) == 1
    assert "has no pass 2; it has 1" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("words", "code", "error"),
    [
        ("shot.yaml -o shot.fbx", 2, "-o shot.fbx: its ending must be one of "),
        ("shot.yaml -o shot.txt", 2, "-o shot.txt: is a raw move of Dragonframe or Kuper ASCII: give --format"),
        ("shot.yaml -o shot.chan --format x", 2, "--format x: must be one of chan, csv, "),
        ("shot.yaml -o shot.chan --rate 0", 2, "--rate 0: must be frames a second"),
        ("shot.yaml -o shot.chan --rate 24/0", 2, "--rate 24/0: must be frames a second"),
        ("shot.yaml -o shot.chan --rate nan", 2, "--rate nan: must be frames a second"),
        ("shot.yaml -o shot.chan --vfov 180", 2, "--vfov 180: must be between 0 and 180 degrees"),
        ("shot.yaml -o shot.chan --commanded", 2, "--commanded: is for takes (.mcap), and shot.yaml is none"),
        ("shot.yaml -o none/shot.chan", 1, "none/shot.chan: cannot be written"),
        ("none.yaml -o shot.chan", 2, "none.yaml"),
    ],
)
def test_what_cannot_be_done_writes_nothing(
    move: Path, words: str, code: int, error: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(["export", *words.split()]) == code
    printed = capsys.readouterr().err
    assert error in printed
    assert printed.count("\n") == 1
    assert [each.name for each in move.parent.iterdir()] == ["shot.yaml"]


def test_neither_the_file_nor_what_is_beside_it_is_replaced_unasked(
    move: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    move.with_name("shot.chan.json").write_text("mine")
    assert run(["export", "shot.yaml", "-o", "shot.chan"]) == 2
    assert "-o shot.chan.json: already exists; give --overwrite to replace it" in capsys.readouterr().err
    assert not move.with_name("shot.chan").exists()
    assert run(["export", "shot.yaml", "-o", "shot.chan", "--overwrite"]) == 0
    assert move.with_name("shot.chan.json").read_text() != "mine"
    assert run(["export", "shot.yaml", "-o", "shot.chan"]) == 2


def test_for_programs_everything_is_one_json_object(move: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["export", "shot.yaml", "-o", "shot.txt", "--format", "kuper", "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert (found["written"], found["format"], found["rate"]) == (["shot.txt", "shot.txt.json"], "kuper", "24000/1001")
    assert move.with_name("shot.txt").read_text().startswith("Axes = Pan, Tilt, Focus\n")

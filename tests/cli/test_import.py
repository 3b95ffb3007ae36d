"""`teleop import`: a sequence that `check` accepts, and one line for whatever is in the way."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
import yaml

from teleop.cli import run

MOVE = """title: Shot
fps: 23.976
keyframes:
  - {at: 0, pan: -10, tilt: 0, focus: 0.2}
  - {at: 4, pan: 10, tilt: 5, focus: 0.4}
cues:
  - {at: 0, camera: record}
  - {at: 4, camera: stop}
"""


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "shot.yaml").write_text(MOVE)
    return tmp_path


@pytest.mark.parametrize("ending", ["chan", "csv", "arcm", "raw", "asc", "usda", "py", "otio"])
def test_what_was_exported_is_a_sequence_again(folder: Path, ending: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["export", "shot.yaml", "-o", f"x.{ending}"]) == 0
    assert run(["import", f"x.{ending}", "-o", "back.yaml"]) == 0
    assert "largest error pan 0.0" in capsys.readouterr().out
    content = yaml.safe_load((folder / "back.yaml").read_text())
    assert content["fps"] == 23.976
    assert content["title"] == "Shot"
    assert ("cues" in content) == (ending == "otio")
    assert run(["check", "back.yaml"]) == 0


def test_text_of_either_kind_is_known_by_what_is_beside_it_or_by_its_first_line(folder: Path) -> None:
    assert run(["export", "shot.yaml", "-o", "a.txt", "--format", "raw"]) == 0
    assert run(["export", "shot.yaml", "-o", "b.txt", "--format", "kuper"]) == 0
    for name in ("a", "b"):
        assert run(["import", f"{name}.txt", "-o", f"{name}.yaml"]) == 0
        (folder / f"{name}.txt.json").unlink()
    assert run(["import", "a.txt", "-o", "a2.yaml", "--rate", "24", "--columns", "pan,tilt,focus"]) == 0
    assert run(["import", "b.txt", "-o", "b2.yaml", "--rate", "24"]) == 0


def test_a_strangers_chan_needs_its_rate_and_rotation_order(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    lines = "".join(f"{frame} 1 2 {frame} {frame / 10} {-frame / 5} 0 40\n" for frame in range(1, 50))
    (folder / "s.chan").write_text(lines)
    assert run(["import", "s.chan", "-o", "s.yaml"]) == 2
    assert "s.chan: does not say its rotation order: give --rotation-order, as in" in capsys.readouterr().err
    assert run(["import", "s.chan", "-o", "s.yaml", "--rotation-order", "zxy"]) == 2
    assert "s.chan: does not say its frame rate: give --rate, as in --rate 24" in capsys.readouterr().err
    assert run(["import", "s.chan", "-o", "s.yaml", "--rotation-order", "zxy", "--rate", "24"]) == 0
    printed = capsys.readouterr().err
    for what in ("positions (tx ty tz)", "vfov", "roll: it is 0 in every frame"):
        assert f"left out: {what}" in printed
        assert f"# Left out: {what}" in (folder / "s.yaml").read_text()
    assert run(["check", "s.yaml"]) == 0


def test_columns_may_be_left_out_and_axes_turned_round(folder: Path) -> None:
    (folder / "t.csv").write_text("".join(f"{place / 10},{-place / 20},9\n" for place in range(60)))
    words = "import t.csv -o t.yaml --rate 25 --columns pan,tilt,- --invert tilt --only tilt"
    assert run(words.split()) == 0
    keys = yaml.safe_load((folder / "t.yaml").read_text())["keyframes"]
    assert all("pan" not in key for key in keys)
    assert keys[-1]["tilt"] > 2.5


@pytest.mark.parametrize(
    ("words", "code", "error"),
    [
        ("none.chan -o a.yaml", 2, "none.chan: no such file"),
        ("shot.yaml -o a.yaml", 2, "shot.yaml: its ending must be one of "),
        (
            "m.txt -o a.yaml",
            2,
            "m.txt: is a raw move of Dragonframe or Kuper ASCII: give --format raw or --format kuper",
        ),
        ("m.txt -o a.yaml --format raw", 2, "m.txt: does not say which column is which axis: give --columns"),
        ("m.txt -o a.yaml --format raw --columns pan,yaw", 2, "--columns pan,yaw: yaw is none of pan, tilt"),
        ("m.txt -o a.yaml --format raw --columns pan,tilt", 2, "m.txt: does not say its frame rate"),
        ("m.txt -o a.csv --format raw", 2, "-o a.csv: its ending must be .yaml or .yml"),
        (
            "m.txt -o shot.yaml --format raw --rate 24 --columns pan,tilt",
            2,
            "shot.yaml: already exists; give --overwrite",
        ),
        ("m.txt -o a.yaml --rotation-order abc", 2, "--rotation-order abc: must be one of XYZ, "),
        ("m.txt -o a.yaml --tolerance 0", 2, "--tolerance 0: must be more than 0 degrees"),
        (
            "m.txt -o a.yaml --format raw --rate 24 --columns pan,tilt --only roll",
            2,
            "m.txt: has no roll; it has pan, tilt",
        ),
        ("m.txt -o a.yaml --format raw --rate 24 --columns pan,tilt --rig none", 2, "none"),
        ("far.txt -o a.yaml --format raw --rate 24 --columns tilt", 1, "far.txt:2: frame 2: tilt must be within"),
    ],
)
def test_what_cannot_be_read_writes_nothing(
    folder: Path, words: str, code: int, error: str, capsys: pytest.CaptureFixture[str]
) -> None:
    (folder / "m.txt").write_text("1 2\n1 2\n1 2\n")
    (folder / "far.txt").write_text("1\n175\n1\n")
    assert run(["import", *words.split()]) == code
    printed = capsys.readouterr().err
    assert error in printed
    assert printed.count("\n") == 1
    assert not (folder / "a.yaml").exists()
    assert (folder / "shot.yaml").read_text() == MOVE


def test_markers_of_an_editor_become_cues(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Set on a clip in the middle of a track, with a rate of its own and a source that begins at an hour."""
    import opentimelineio as otio

    def moment(value: float, rate: float = 25) -> otio.opentime.RationalTime:
        return otio.opentime.RationalTime(value, rate)

    track = otio.schema.Track()
    for name in ("one", "two"):
        span = otio.opentime.TimeRange(moment(90_000), moment(100))
        track.append(otio.schema.Clip(name=name, source_range=span))
    for frame, name in ((90_010, "record"), (90_050, "camera: stop"), (90_060, "explosion")):
        place = otio.opentime.TimeRange(moment(frame), moment(0))
        track[1].markers.append(otio.schema.Marker(name=name, marked_range=place))
    timeline = otio.schema.Timeline(name="Edit", global_start_time=moment(90_000))
    timeline.tracks.append(track)
    otio.adapters.write_to_file(timeline, "edit.otio")
    assert run(["import", "edit.otio", "-o", "edit.yaml"]) == 0
    content = yaml.safe_load((folder / "edit.yaml").read_text())
    assert content["cues"] == [{"at": 4.4, "camera": "record"}, {"at": 6, "camera": "stop"}]
    printed = capsys.readouterr().err
    assert "left out: marker 'explosion' at 6.400 s: is no cue" in printed
    assert "placeholder" in printed
    assert run(["check", "edit.yaml"]) == 0


def test_for_programs_everything_is_one_json_object(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["export", "shot.yaml", "-o", "x.csv"]) == 0
    capsys.readouterr()
    assert run(["import", "x.csv", "-o", "x.yaml", "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["ok"] is True
    assert set(found["largest_errors"]) == {"pan", "tilt", "focus"}
    (folder / "bad.csv").write_text("pan\nx\n")
    assert run(["import", "bad.csv", "-o", "y.yaml", "--rate", "24", "--json"]) == 2
    assert json.loads(capsys.readouterr().out)["ok"] is False

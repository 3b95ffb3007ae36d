"""`teleop calibrate`: every axis in turn, with its doubt and a picture, kept for later runs; and what it would move."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from teleop.cli import run
from teleop.config.response_store import ResponseStore, default_folder

PROFILE = """\
name: Late
links: {gimbal: "sim:"}
axes:
  pan:  {min: -180, max: 180, velocity: 60, acceleration: 240, jerk: 1200}
  tilt: {min: LOW, max: 146, velocity: 60, acceleration: 180, jerk: 900}
sinks:
- {type: gimbal, link: gimbal, mode: MODE, rate: 50, delay: 0.02, payload: a7,
   simulated: {lag: {pan: 0.12, tilt: 0.05}, dead_time: 0.06, gain: 0.93, drift: 0.3, position_lag: 0.08}}
"""


def rig(folder: Path, mode: str = "speed", low: float = -56) -> str:
    path = folder / "rig.yaml"
    path.write_text(PROFILE.replace("MODE", mode).replace("LOW", str(low)))
    return str(path)


@pytest.mark.parametrize("mode", ["speed", "stick"])
def test_each_axis_is_measured_and_kept(mode: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["calibrate", "--rig", rig(tmp_path, mode), "--fast", "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert (found["result"], found["mode"], found["link"], found["payload"]) == ("done", mode, "sim", "a7")
    for axis, delay in (("pan", 0.18), ("tilt", 0.11)):
        of = found["axes"][axis]
        assert of["delay"] == pytest.approx(delay, abs=0.008)
        assert abs(of["delay"] - delay) < 2 * of["delay_doubt"] + 0.002
        assert of["drift"] == pytest.approx(0.3, abs=0.1)
        assert of["kept"]
        if mode == "speed":
            assert of["gain"] == pytest.approx(0.93, abs=3 * of["gain_doubt"])
            assert of["gain_doubt"] < 0.02
    run(["doctor", "--json"])
    kept = json.loads(capsys.readouterr().out)["responses"]
    assert [(each["axis"], each["mode"], each["payload"]) for each in kept] == [
        ("pan", mode, "a7"),
        ("tilt", mode, "a7"),
    ]


def test_in_mode_position_it_is_the_delay_of_calibrate_delay(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    profile = rig(tmp_path, "position")
    assert run(["calibrate", "response", "--axis", "pan", "--rig", profile, "--fast", "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert run(["calibrate", "delay", "--rig", profile, "--fast", "--json"]) == 0
    assert found["delay"] == pytest.approx(json.loads(capsys.readouterr().out)["delay"], abs=0.005)


def test_it_says_the_figures_their_doubts_and_the_line_for_the_profile(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(["calibrate", "--axis", "tilt", "--rig", rig(tmp_path), "--fast"]) == 0
    figures, _, delay = capsys.readouterr().out.splitlines()
    assert figures.startswith("tilt answers 0.11")
    assert figures.count("doubt") == 3
    assert figures.endswith("; kept for the next run")
    assert delay.strip().startswith("delay: 0.11")


@pytest.mark.parametrize(("ending", "begin"), [("html", b"<!doctype html>"), ("png", b"\x89PNG")])
def test_the_picture_has_each_axis(
    ending: str, begin: bytes, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / f"picture.{ending}"
    options = ["--axis", "pan", "--fast", "-o", str(path)]
    assert run(["calibrate", "--rig", rig(tmp_path), *options]) == 0
    content = path.read_bytes()
    assert content.startswith(begin)
    if ending == "html":
        assert b"pan" in content
        assert content.count(b"<polyline") == 3  # measured, explained, and what is left


def test_a_dry_run_shows_what_would_move_and_keeps_nothing(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """No link is opened: there is no adapter on this one."""
    options = ["--rig", rig(tmp_path), "--link", "gimbal=socketcan:none", "--dry-run"]
    assert run(["calibrate", *options]) == 0
    assert capsys.readouterr().out.splitlines() == [
        "pan would move 6 deg to the side with more room and back, 8 times in 16 s, at most 9 deg/s, mode speed",
        "tilt would move 6 deg to the side with more room and back, 8 times in 16 s, at most 9 deg/s, mode speed",
        "nothing was moved",
    ]
    assert run(["calibrate", *options, "--json"]) == 0
    planned = json.loads(capsys.readouterr().out)
    assert planned["axes"]["pan"] == {"reach": 6.0, "swings": 8, "seconds": 16.0}


def test_an_axis_without_room_ends_it_and_what_was_found_before_is_kept(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = Path(rig(tmp_path, low=-2))
    path.write_text(path.read_text().replace("max: 146", "max: 2"))
    assert run(["calibrate", "--rig", str(path), "--fast"]) == 1
    assert "tilt has no room for a test move of 6 deg" in capsys.readouterr().err
    assert [each.axis for each in ResponseStore(default_folder()).read()] == ["pan"]


def test_a_wrong_ending_and_an_axis_that_is_not_there_are_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(["calibrate", "--rig", rig(tmp_path), "--fast", "-o", "x.pdf"]) == 2
    assert "its ending must be one of .html, .svg, .png" in capsys.readouterr().err
    assert run(["calibrate", "--rig", rig(tmp_path), "--fast", "--axis", "roll"]) == 2
    assert "--axis roll: no gimbal of Late moves it" in capsys.readouterr().err

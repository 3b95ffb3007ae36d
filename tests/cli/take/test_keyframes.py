"""`teleop take keyframes`: what it refuses before it reads, and the file that it writes."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from made_takes import write_take

from teleop.cli import run
from teleop.core.axes import Axis, State


def ramp(time: float) -> State:
    """Ten degrees in two seconds, at rest at both ends."""
    u = min(max(time / 2, 0.0), 1.0)
    place = 10 * (10 * u**3 - 15 * u**4 + 6 * u**5)
    return State(place, 5 * (30 * u**2 - 60 * u**3 + 30 * u**4), 2.5 * (60 * u - 180 * u**2 + 120 * u**3))


@pytest.fixture
def take(tmp_path: Path) -> Path:
    return write_take(tmp_path / "a.mcap", {Axis.PAN: ramp}, 2.0)


@pytest.mark.parametrize(
    ("options", "error"),
    [
        (["--tolerance", "0"], "--tolerance 0: must be more than 0 degrees"),
        (["--tolerance", "nan"], "--tolerance nan"),
        (["--speed", "-1"], "--speed -1: must be a percentage above 0"),
    ],
)
def test_what_cannot_be_asked_for_writes_nothing(
    take: Path, options: list[str], error: str, capsys: pytest.CaptureFixture[str]
):
    out = take.with_name("a.yaml")
    assert run(["take", "keyframes", str(take), "-o", str(out), *options]) == 2
    assert error in capsys.readouterr().err
    assert not out.exists()


def test_a_sequence_file_has_the_ending_of_one(take: Path, capsys: pytest.CaptureFixture[str]):
    assert run(["take", "keyframes", str(take), "-o", str(take.with_name("a.txt"))]) == 2
    assert "its ending must be .yaml or .yml" in capsys.readouterr().err


def test_the_keyframes_play_within_the_tolerance(take: Path, capsys: pytest.CaptureFixture[str]):
    out = take.with_name("a.yaml")
    assert run(["take", "keyframes", str(take), "-o", str(out), "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["keyframes"] >= 2
    assert found["largest_errors"]["pan"]["error"] <= 0.2
    assert run(["check", str(out), "--rig", "sim"]) == 0

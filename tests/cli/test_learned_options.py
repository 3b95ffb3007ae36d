"""`teleop play --learn` and `--learned`: passes that correct the next, their file, and what is refused in one line."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest

from teleop.cli import run
from teleop.recording.reader import read_take

MOVE = "keyframes:\n  - {at: 0, pan: 0}\n  - {at: 2, pan: 40}\n  - {at: 4, pan: -5}\n"
RIG = """
name: {name}
links: {{gimbal: "sim:"}}
axes: {{pan: {{min: -90, max: 90, velocity: {velocity}, acceleration: 240, jerk: 1200}}}}
sinks: [{{type: gimbal, link: gimbal, mode: speed, rate: 50,{delay} simulated: {dynamics}}}]
"""
LATE = "{lag: 0.1, dead_time: 0.03, backlash: 0.05}"
WRONG = " delay: 0.0,"  # what the profile has of the gimbal: so nothing is identified, and there is much to learn


@dataclass(frozen=True)
class Shot:
    """A folder with a move, its rig, a take of passes that learned, and what the run printed as JSON."""

    folder: Path
    report: dict[str, Any]

    @property
    def learned(self) -> Path:
        return self.folder / "a.learned.json"

    def play(self, *options: str, move: str = "move.yaml", rig: str = "rig.yaml") -> int:
        return run(["play", str(self.folder / move), "--rig", str(self.folder / rig), "--fast", *options])


def learned(folder: Path, delay: str) -> Shot:
    """Three passes that learn, in a new folder, on a rig with this delay."""
    of = {"velocity": 120, "delay": delay, "dynamics": LATE}
    (folder / "move.yaml").write_text(MOVE)
    (folder / "edited.yaml").write_text(MOVE.replace("pan: 40", "pan: 40.5"))
    (folder / "rig.yaml").write_text(RIG.format(name="Bench", **of))
    (folder / "other.yaml").write_text(RIG.format(name="Another", **of))
    with pytest.MonkeyPatch.context() as patch:
        printed: list[str] = []
        patch.setenv("XDG_STATE_HOME", str(folder / "state"))
        patch.setattr("builtins.print", lambda *words, **_: printed.append(" ".join(map(str, words))))
        shot = Shot(folder, {})
        assert shot.play("--passes", "3", "--learn", "--take", str(folder / "a.mcap"), "--json") == 0
    return Shot(folder, json.loads(next(line for line in printed if line.startswith("{"))))


@pytest.fixture(scope="module")
def shot(tmp_path_factory: pytest.TempPathFactory) -> Shot:
    return learned(tmp_path_factory.mktemp("shot"), WRONG)


@pytest.fixture(scope="module")
def unmeasured(tmp_path_factory: pytest.TempPathFactory) -> Shot:
    """Of which the profile has no delay."""
    return learned(tmp_path_factory.mktemp("unmeasured"), "")


@pytest.mark.parametrize("of", ["shot", "unmeasured"])
def test_by_the_third_pass_a_quarter_of_the_error_is_left(of: str, request: pytest.FixtureRequest):
    shot = request.getfixturevalue(of)
    passes = shot.report["learning"]["passes"]
    rms = [each["axes"]["pan"]["rms"] for each in passes]
    assert [each["pass"] for each in passes] == [1, 2, 3]
    assert min(rms[1:]) <= max(rms[0] / 4, 0.05)
    best = shot.report["learning"]["best"]["pan"]
    assert best["rms"] == min(rms)
    assert passes[best["pass"] - 1]["axes"]["pan"]["rms"] == best["rms"]


def test_the_file_is_beside_the_take_and_says_what_it_is(shot: Shot):
    assert shot.report["learning"]["file"] == str(shot.learned)
    content = json.loads(shot.learned.read_text())
    assert (content["format"], content["version"], content["rig"]) == ("teleop learned passes", 1, "Bench")
    assert content["sequence"] == read_take(shot.folder / "a.mcap").about.sequence.fingerprint
    offset = content["axes"]["pan"]
    assert offset["unit"] == "deg"
    assert len(offset["times"]) == len(offset["position"]) == len(offset["velocity"]) == len(offset["acceleration"])
    assert [each["pass"] for each in content["passes"]] == [1, 2, 3]


def test_what_was_learned_makes_the_first_pass_as_good(
    shot: Shot, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.setenv("XDG_STATE_HOME", str(shot.folder / "state"))  # the next run of the same user
    assert shot.play("--learned", str(shot.learned), "--json") == 0
    first = json.loads(capsys.readouterr().out)["axes"]["pan"]["rms"]
    unlearned = shot.report["learning"]["passes"][0]["axes"]["pan"]["rms"]
    assert first <= max(unlearned / 4, 0.06)


@pytest.mark.parametrize(
    ("options", "reason"),
    [
        ({"rig": "other.yaml"}, "was learned on Bench, not on Another"),
        ({"move": "edited.yaml"}, "was learned for another move"),
    ],
)
def test_it_is_refused_for_another_rig_or_move(
    shot: Shot, options: dict[str, str], reason: str, capsys: pytest.CaptureFixture[str]
):
    assert shot.play("--learned", str(shot.learned), **options) == 2
    refusal = capsys.readouterr().err.strip().splitlines()
    assert len(refusal) == 1
    assert reason in refusal[0]


@pytest.mark.parametrize(
    ("damage", "reason"),
    [
        (lambda text: text[: len(text) // 2], "damaged"),
        (lambda text: text.replace('"best_pass"', '"best pass"'), "damaged or edited"),
        (lambda text: text.replace("0.", "1.", 3), "damaged or edited"),
        (lambda text: text.replace('"version": 1', '"version": 2'), "has version 2, this program reads 1"),
        (lambda _text: "[1, 2]", "not a file of learned passes"),
        (lambda _text: "", "damaged"),
    ],
)
def test_a_damaged_file_is_refused_in_one_line(
    shot: Shot, tmp_path: Path, damage: Any, reason: str, capsys: pytest.CaptureFixture[str]
):
    (tmp_path / "bad.json").write_text(damage(shot.learned.read_text()))
    assert shot.play("--learned", str(tmp_path / "bad.json")) == 2
    refusal = capsys.readouterr().err.strip().splitlines()
    assert len(refusal) == 1
    assert reason in refusal[0]


@pytest.mark.parametrize(
    ("options", "cure"),
    [
        (["--learn"], "--learn: needs passes"),
        (["--learn", "--passes", "1"], "--learn: needs passes"),
        (["--learn", "--loop"], "leave out --loop"),
        (["--learn", "--passes", "3", "--speed", "50%"], "leave out --speed"),
        (["--learn", "--passes", "3", "--start-at", "1s"], "leave out --start-at"),
        (["--learned", "nothing.json"], "nothing.json: cannot be read"),
    ],
)
def test_options_that_do_not_go_together_are_refused(
    shot: Shot, options: list[str], cure: str, capsys: pytest.CaptureFixture[str]
):
    assert shot.play(*options) == 2
    assert cure in capsys.readouterr().err


def test_a_file_is_never_replaced_by_another_run(
    shot: Shot, monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capsys: pytest.CaptureFixture[str]
):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "move.learned.json").write_text("kept")
    assert shot.play("--learn", "--passes", "2") == 2
    assert "move.learned.json already exists" in capsys.readouterr().err
    assert (tmp_path / "move.learned.json").read_text() == "kept"


def test_a_recorded_take_can_be_learned_too(
    shot: Shot, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, tmp_path: Path
):
    monkeypatch.chdir(tmp_path)
    assert shot.play("--take", "hand.mcap", "--json") == 0
    capsys.readouterr()
    move = str(tmp_path / "hand.mcap")
    assert shot.play("--learn", "--passes", "2", "--json", move=move) == 0
    learned = json.loads(capsys.readouterr().out)["learning"]
    first, second = (each["axes"]["pan"]["rms"] for each in learned["passes"])
    assert second <= max(first / 4, 0.05)
    assert learned["file"] == "hand.learned.json"
    assert shot.play("--learned", "hand.learned.json", "--json", move=move) == 0
    assert json.loads(capsys.readouterr().out)["axes"]["pan"]["rms"] <= max(first / 4, 0.06)


def test_a_take_of_corrected_passes_has_the_plan_and_its_report_is_against_that(
    shot: Shot, capsys: pytest.CaptureFixture[str]
):
    take = read_take(shot.folder / "a.mcap")
    assert [mark.number for mark in take.marks] == [1, 0, 2, 0, 3, 0]
    assert take.firmware["gimbal"]
    assert len(next(iter(take.plan.values()))[0]) > 0
    page = shot.folder / "c.html"
    assert run(["take", "certificate", str(take.path), "-o", str(page), "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert [each["corrected"] for each in found["passes"]] == [False, True, True]
    by_run = shot.report["learning"]["passes"][2]["axes"]["pan"]["rms"]
    assert found["passes"][2]["axes"]["pan"]["plan"]["all"]["rms"] == pytest.approx(by_run, rel=0.05)
    assert found["sequence"] == take.about.sequence.fingerprint
    assert found["firmware"] == dict(take.firmware)

"""`teleop take list` and `take info`: what there is, damaged files named as such."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from command import teleop
from made_takes import at_rest, write_take

from teleop.core.axes import Axis, State
from teleop.core.events import Action, DeviceCommand
from teleop.recording import summary as module
from teleop.recording.summary import summarize, summarize_index, takes_in


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    acts = {5: [Action.RECORD], 50: [DeviceCommand("gimbal", "recenter")]}
    write_take(tmp_path / "b.mcap", {Axis.PAN: at_rest(1)}, 2.5, acts=acts, result="failed", reasons=["pan: stalled"])
    write_take(tmp_path / "c.mcap", {Axis.PAN: lambda time: State(time, 1.0)}, 1.0, closed=False)
    (tmp_path / "a.mcap").write_bytes(b"")
    (tmp_path / "notes.txt").write_text("not a take")
    return tmp_path


def test_a_list_has_every_take_with_its_end_and_says_which_are_damaged(folder: Path) -> None:
    done = teleop("take", "list", "--json", cwd=folder)
    assert (done.returncode, done.stderr) == (0, "")
    a, b, c = json.loads(done.stdout)["takes"]
    assert a == {
        "file": "a.mcap",
        "damaged": True,
        "problem": "not a take (.mcap), or cut off before anything was recorded",
    }
    assert (b["title"], b["rig"], b["seconds"], b["damaged"]) == ("b", "Bench", 2.5, False)
    assert (b["result"], b["reasons"]) == ("failed", ["pan: stalled"])
    assert (c["result"], c["damaged"], c["seconds"]) == (None, True, 1.0)
    assert c["problem"].endswith("teleop take recover c.mcap")
    for_people = teleop("take", "list", str(folder))
    assert for_people.returncode == 0
    assert "failed: pan: stalled" in " ".join(for_people.stdout.replace("│", " ").split())
    assert for_people.stdout.count("damaged") == 2


def test_a_list_reads_a_closed_take_by_its_index_alone(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    whole = summarize(folder / "b.mcap")
    monkeypatch.setattr(module, "summarize", lambda path: pytest.fail(f"{path} was read through"))
    glanced = summarize_index(folder / "b.mcap")
    assert (glanced.about, glanced.seconds, glanced.ending) == (whole.about, whole.seconds, whole.ending)


def test_info_counts_what_is_in_a_take(folder: Path) -> None:
    done = teleop("take", "info", "b.mcap", "--json", cwd=folder)
    said = json.loads(done.stdout)
    assert said["messages"]["/motion"] == 251
    assert said["actions"] == [
        {"time": 0.05, "action": "record"},
        {"time": 0.5, "action": "told", "words": "gimbal recenter"},
    ]
    assert said["axes"]["pan"] == {"minimum": -180, "maximum": 180, "velocity": 120, "acceleration": 240, "jerk": 1200}
    cut = teleop("take", "info", "c.mcap", cwd=folder)
    assert cut.returncode == 0
    assert (
        cut.stderr
        == "c.mcap: the recording was cut off; only the whole part is read. To repair: teleop take recover c.mcap\n"
    )
    assert "ended     cut off: the file does not say how" in cut.stdout


def test_a_run_leaves_what_its_links_counted(tmp_path: Path) -> None:
    assert teleop("play", "nudge", "--fast", "--take", "n.mcap", cwd=tmp_path).returncode == 0
    said = json.loads(teleop("take", "info", "n.mcap", "--json", cwd=tmp_path).stdout)
    assert said["links"]["gimbal"]["frames_out"] > 100
    assert (said["result"], said["title"]) == ("done", "Nudge")


def test_an_empty_folder_and_none(tmp_path: Path) -> None:
    assert list(takes_in(tmp_path)) == []
    assert "no takes (.mcap) in ." in teleop("take", "list", cwd=tmp_path).stdout
    missing = teleop("take", "list", "nowhere", cwd=tmp_path)
    assert (missing.returncode, missing.stderr) == (2, "nowhere: cannot be listed: No such file or directory\n")

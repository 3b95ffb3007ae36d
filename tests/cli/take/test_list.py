"""`teleop take list` and `take info`: whole, cut off and damaged takes, and what is in one."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from made_takes import at_rest, write_take

from teleop.cli import run
from teleop.core.axes import Axis
from teleop.core.events import Action

MOTION = {Axis.PAN: at_rest(1.0)}


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    write_take(tmp_path / "a.mcap", MOTION, 1.0, acts={5: [Action.RECORD], 9: [Action.SHUTTER], 20: [Action.SHUTTER]})
    write_take(tmp_path / "b.mcap", MOTION, 1.0, closed=False)
    (tmp_path / "c.mcap").write_bytes(b"not a take")
    (tmp_path / "notes.txt").write_text("nothing")
    return tmp_path


def test_every_take_of_the_folder_is_listed_with_its_end(folder: Path, capsys: pytest.CaptureFixture[str]):
    assert run(["take", "list", str(folder)]) == 0
    lines = capsys.readouterr().out.splitlines()
    rows = {name: next(line for line in lines if f"{name}.mcap" in line) for name in "abc"}
    assert "done" in rows["a"]
    assert "damaged" in rows["b"]
    assert "damaged" in rows["c"]
    assert not any("notes" in line for line in lines)
    assert any(line.startswith(f"{folder}/c.mcap: ") for line in lines)


def test_programs_get_an_object_for_each(folder: Path, capsys: pytest.CaptureFixture[str]):
    assert run(["take", "list", str(folder), "--json"]) == 0
    takes = {Path(each["file"]).stem: each for each in json.loads(capsys.readouterr().out)["takes"]}
    assert {name: each["damaged"] for name, each in takes.items()} == {"a": False, "b": True, "c": True}
    assert (takes["a"]["result"], takes["b"]["result"]) == ("done", None)


def test_an_empty_folder_says_so(tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    assert run(["take", "list", str(tmp_path)]) == 0
    assert capsys.readouterr().out == f"no takes (.mcap) in {tmp_path}\n"


def test_info_counts_what_was_done(folder: Path, capsys: pytest.CaptureFixture[str]):
    assert run(["take", "info", str(folder / "a.mcap")]) == 0
    printed = capsys.readouterr().out
    assert "actions   record 1, shutter 2\n" in printed
    assert "-180 .. 180, 120/s, 240/s2, 1200/s3" in printed
    assert run(["take", "info", str(folder / "b.mcap")]) == 0
    assert "cut off: the file does not say how" in capsys.readouterr().out

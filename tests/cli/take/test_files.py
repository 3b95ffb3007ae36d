"""`teleop take export` and `take recover`: new files made of a take, which itself never changes."""

from __future__ import annotations

import csv
import json
from pathlib import Path

import pytest
from made_takes import at_rest, write_take

from teleop.cli import run
from teleop.core.axes import Axis
from teleop.recording.reader import read_take

MOTION = {Axis.PAN: at_rest(1.0)}


def test_a_table_has_a_row_for_each_tick(tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    take = write_take(tmp_path / "a.mcap", MOTION, 1.0)
    table = tmp_path / "a.csv"
    assert run(["take", "export", str(take), "--csv", str(table), "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["rows"] == 101
    with table.open(newline="") as stream:
        rows = list(csv.DictReader(stream))
    assert len(rows) == 101
    assert {row["pan"] for row in rows} == {"1.0"} or {float(row["pan"]) for row in rows} == {1.0}
    assert run(["take", "export", str(take), "--csv", str(table)]) == 2


def test_a_take_that_was_cut_off_is_recovered_beside_it(tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    take = write_take(tmp_path / "a.mcap", MOTION, 1.0, closed=False)
    before = take.read_bytes()
    assert run(["take", "recover", str(take)]) == 0
    assert "lost: only what was never written" in capsys.readouterr().out
    assert take.read_bytes() == before
    assert read_take(tmp_path / "a-recovered.mcap").remark == ""
    assert run(["take", "recover", str(take)]) == 2  # it is there


def test_a_complete_take_needs_no_second_file(tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    take = write_take(tmp_path / "a.mcap", MOTION, 1.0)
    assert run(["take", "recover", str(take)]) == 0
    assert "is complete; nothing to recover" in capsys.readouterr().out
    assert not (tmp_path / "a-recovered.mcap").exists()


def test_a_recovered_take_has_the_ending_of_takes(tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    take = write_take(tmp_path / "a.mcap", MOTION, 1.0, closed=False)
    assert run(["take", "recover", str(take), "-o", str(tmp_path / "b.txt")]) == 2
    assert "its ending must be .mcap" in capsys.readouterr().err

"""`teleop preview` as typed, and in process where something is missing."""

from __future__ import annotations

import csv
import json
import signal
import subprocess
import sys
from pathlib import Path

import pytest
from command import teleop

from teleop.cli import run


def test_page_and_table_of_the_demo(tmp_path: Path) -> None:
    done = teleop("preview", "reveal", "-o", "move.html", "--csv", "move.csv", cwd=tmp_path)
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout.splitlines() == [
        "move.html: Slow reveal, 15.00 s on Simulated rig",
        "move.csv: Slow reveal, 15.00 s on Simulated rig",
    ]
    assert "<title>Slow reveal</title>" in (tmp_path / "move.html").read_text(encoding="utf-8")
    with (tmp_path / "move.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert list(rows[0])[:6] == ["time", "pan", "pan_velocity", "pan_acceleration", "pan_jerk", "tilt"]
    assert [float(row["time"]) for row in rows] == [k / 100 for k in range(1501)]
    assert {float(rows[0]["pan"]), float(rows[-1]["pan"])} == {-30, 40}


def test_json_says_what_was_written_and_no_port_is_opened(tmp_path: Path) -> None:
    arguments = ("--csv", "move.csv", "--rate", "24", "--rig", "rs2", "--link", "gimbal=slcan:/dev/nothing-here")
    done = teleop("preview", "reveal", *arguments, "--json", cwd=tmp_path)
    assert (done.returncode, done.stderr) == (0, "")
    size = (tmp_path / "move.csv").stat().st_size
    assert json.loads(done.stdout) == {
        "ok": True,
        "title": "Slow reveal",
        "duration": 15,
        "written": [{"path": "move.csv", "bytes": size}],
        "warnings": [],
    }
    assert len((tmp_path / "move.csv").read_text().splitlines()) == 1 + 15 * 24 + 1


@pytest.mark.parametrize(
    ("arguments", "code", "said"),
    [
        (["reveal"], 2, "nothing to write: give -o FILE.html, .svg or .png, or --csv FILE"),
        (["reveal", "-o", "move.pdf"], 2, "-o move.pdf: its ending must be one of .html, .svg, .png"),
        (["reveal", "--csv", "move.csv", "--rate", "0"], 2, "--rate 0: must be more than 0 rows per second"),
        (["reveal", "--csv", "move.csv", "--rate", "nan"], 2, "--rate nan: must be"),
        (["reveal", "-o", "move.html", "--csv", "./move.html"], 2, "is where -o writes too"),
        (["revel", "-o", "move.html"], 2, "did you mean reveal?"),
        (["reveal", "-o", "nowhere/move.html"], 1, "nowhere/move.html: cannot be written: No such file or directory"),
    ],
)
def test_what_cannot_be_done_is_said_in_one_line(
    arguments: list[str], code: int, said: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys
) -> None:
    monkeypatch.chdir(tmp_path)
    assert run(["preview", *arguments]) == code
    output = capsys.readouterr()
    assert said in output.err
    assert len(output.err.strip().splitlines()) == 1
    assert output.out == ""
    assert list(tmp_path.iterdir()) == []


def test_a_drawing_without_matplotlib_says_how_to_get_it_before_anything_is_written(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys
) -> None:
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    monkeypatch.chdir(tmp_path)
    assert run(["preview", "reveal", "-o", "move.png", "--csv", "move.csv"]) == 2
    assert capsys.readouterr().err == "teleop: -o move.png: a drawing needs matplotlib: pip install 'rs-teleop[plot]'\n"
    assert list(tmp_path.iterdir()) == []


def test_a_move_that_cannot_be_is_not_drawn(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "hard.yaml").write_text("keyframes:\n  - {at: 0, pan: 0}\n  - {at: 0.2, pan: 90}\n")
    assert run(["preview", "hard.yaml", "-o", "hard.html", "--json"]) == 1
    output = capsys.readouterr()
    assert output.err.startswith("hard.yaml:3:5: pan needs ")
    assert json.loads(output.out) == {"ok": False, "problems": [output.err.strip()]}
    (tmp_path / "bad.yaml").write_text("keyframes:\n  - {at: 0, pna: 1}\n")
    assert run(["preview", "bad.yaml", "-o", "bad.html"]) == 2
    assert sorted(file.name for file in tmp_path.iterdir()) == ["bad.yaml", "hard.yaml"]


@pytest.mark.parametrize("ending", ["svg", "png"])
def test_a_drawing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, ending: str) -> None:
    pytest.importorskip("matplotlib", reason="the plot extra is not installed")
    monkeypatch.chdir(tmp_path)
    assert run(["preview", "reveal", "-o", f"move.{ending.upper()}"]) == 0
    data = (tmp_path / f"move.{ending.upper()}").read_bytes()
    assert data.startswith({"svg": b"<?xml", "png": b"\x89PNG"}[ending])


def test_the_last_row_of_a_table_is_the_end_of_the_move(tmp_path: Path) -> None:
    (tmp_path / "short.yaml").write_text("keyframes:\n  - {at: 0, pan: 0}\n  - {at: 1.237, pan: 3}\n")
    assert run(["preview", str(tmp_path / "short.yaml"), "--csv", str(tmp_path / "short.csv"), "--rate", "10"]) == 0
    *_, before, last = (tmp_path / "short.csv").read_text().splitlines()
    assert before.split(",")[0] == "1.2"
    assert [float(cell) for cell in last.split(",")[:3]] == [1.237, 3.0, pytest.approx(0.0, abs=1e-6)]


@pytest.mark.parametrize(("number", "owned"), [(signal.SIGTERM, True), (signal.SIGHUP, True), (signal.SIGTERM, False)])
def test_a_table_that_a_signal_ends_leaves_nothing_behind(tmp_path: Path, number: signal.Signals, owned: bool) -> None:
    """On a file system that cannot keep a file without a name until it is whole; in the command, and elsewhere."""
    code = f"""
import os
from pathlib import Path
from teleop.cli.signals import process, unwound_by_signals
from teleop.config import files
if {owned}:
    process.own()
os.O_TMPFILE = None
with unwound_by_signals(), files.replacing(Path("move.csv")) as stream:
    assert list(Path().glob(".*.part"))
    os.kill(os.getpid(), {int(number)})
"""
    done = subprocess.run([sys.executable, "-c", code], cwd=tmp_path, check=False)
    assert done.returncode == -number
    assert list(tmp_path.iterdir()) == []

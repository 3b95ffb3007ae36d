"""`teleop take export --csv`: the columns that are promised, every tick, and never the whole take in memory."""

from __future__ import annotations

import csv
import io
import json
from collections.abc import Iterator
from pathlib import Path

import pytest
from command import teleop
from made_takes import write_take

from teleop.cli import run
from teleop.core.axes import Axis, State
from teleop.core.events import Action, DeviceCommand
from teleop.recording.messages import Line
from teleop.recording.table import _rows, write_table

PAN = Axis.PAN
OF_PAN = ["_stick", "_wish", "_asked", "", "_velocity", "_acceleration", "_measured", "_measured_time"]


def test_a_row_for_each_tick_with_what_was_measured_in_the_row_of_its_time(tmp_path: Path) -> None:
    acts = {3: [Action.RECORD, DeviceCommand("gimbal", "follow lock, now")]}
    path = write_take(
        tmp_path / "t.mcap", {PAN: lambda time: State(time, 1.0)}, 1.0, measured={PAN: lambda time: time / 2}, acts=acts
    )
    text = io.StringIO()
    messages, count = write_table(path, text)
    rows = list(csv.DictReader(io.StringIO(text.getvalue())))
    assert list(rows[0]) == ["time", *(f"pan{name}" for name in OF_PAN), "actions"]
    assert (len(rows), count, messages.remark) == (101, 101, "")
    assert [float(row["time"]) for row in rows] == [number / 100 for number in range(101)]
    assert rows[3]["actions"] == "record; gimbal follow lock, now"
    for number, row in enumerate(rows):
        assert (float(row["pan"]), float(row["pan_velocity"])) == (number / 100, 1.0)
        assert row["pan_measured"] == (f"{number / 200:g}" if number % 4 == 0 and number else row["pan_measured"])
        assert bool(row["pan_measured"]) is (number % 4 == 0)


def test_what_was_asked_for_and_a_stick_hold_until_they_change(tmp_path: Path) -> None:
    state = {"pan": {"position": 1.5, "velocity": 0, "acceleration": 0}}
    said = [
        (0.0, "/motion", state),
        (0.0, "/demand", {"pan": {"wish": "cruise", "velocity": 12}}),
        (0.0, "/sticks", {"pan": 0.5}),
        (0.01, "/motion", state),
        (0.01, "/measured", {"pan": 1.4}),
        (0.02, "/motion", state),
        (0.02, "/demand", {"pan": {"wish": "follow"}}),
        (0.005, "/measured", {"pan": 1.3}),
        (0.03, "/motion", state),
        (0.03, "/demand", {}),
    ]
    lines = [Line(time, topic, json.dumps(content).encode()) for time, topic, content in said]
    rows = list(_rows(lines, ["pan"]))
    assert [(row["pan_wish"], row["pan_asked"], row["pan_stick"]) for row in rows] == [
        ("cruise", 12, 0.5),
        ("cruise", 12, 0.5),
        ("follow", 1.5, 0.5),
        ("", "", 0.5),
    ]
    assert (rows[1]["pan_measured"], rows[1]["pan_measured_time"]) == (1.3, 0.005)


def test_rows_are_written_while_the_take_is_read() -> None:
    read = 0

    def lines() -> Iterator[Line]:
        nonlocal read
        for read in range(100_000):
            state = {"pan": {"position": read, "velocity": 0, "acceleration": 0}}
            yield Line(read / 100, "/motion", json.dumps(state).encode())

    rows = _rows(lines(), ["pan"])
    for number in range(500):
        assert next(rows)["pan"] == number
        assert read <= number + 102


def test_the_command_and_what_it_refuses(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    write_take(tmp_path / "t.mcap", {PAN: lambda time: State(time, 1.0)}, 0.5, closed=False)
    (tmp_path / "text.mcap").write_text("no take")
    done = teleop("take", "export", "t.mcap", "--csv", "t.csv", cwd=tmp_path)
    assert (done.returncode, done.stdout) == (0, "t.csv: 51 rows\n")
    assert done.stderr.startswith("t.mcap: the recording was cut off")
    for arguments, line in [
        (["t.mcap", "--csv", "t.csv"], "teleop: --csv t.csv: already exists; give --overwrite to replace it\n"),
        (["t.mcap", "--csv", "t.mcap"], "teleop: --csv t.mcap: is the take itself; choose another file\n"),
        (["text.mcap", "--csv", "u.csv"], "text.mcap: not a take (.mcap), or cut off before anything was recorded\n"),
    ]:
        assert run(["take", "export", *arguments]) == 2
        assert capsys.readouterr().err == line
    assert not (tmp_path / "u.csv").exists()
    assert run(["take", "export", "t.mcap", "--csv", "t.csv", "--overwrite"]) == 0

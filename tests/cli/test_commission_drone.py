"""`teleop commission` of a rig with a drone, on a real terminal of 80 x 24, and the results that it leaves."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from terminal_screen import screen

from teleop.captures.reader import read
from teleop.cli import run


def test_a_drone_is_commissioned_after_the_propellers_are_typed_off(tmp_path: Path) -> None:
    with screen("commission", "--rig", "sim-drone", "--report", "out", folder=tmp_path, cwd=tmp_path) as terminal:
        terminal.wait_for("Take all propellers off")
        terminal.look(key_line="Enter goes")
        terminal.type("\n")
        terminal.wait_for("Then type props-off")
        terminal.type("props-off\n")
        terminal.wait_for("Propellers off, typed by the operator")
        terminal.type("\n")
        terminal.wait_for("then activated with your app id")
        terminal.look(key_line="Enter goes")
        terminal.type("\n")
        terminal.wait_for("It takes the activation")
        terminal.look(key_line="Enter next")
        terminal.type("q")
        assert terminal.end() == 0
        assert any("report.html" in row for row in terminal.everything)
    folder = tmp_path / "out"
    report = json.loads((folder / "report.json").read_text())
    assert (report["device"], report["firmware"]) == ("drone", "SDK-v1.0 BETA M100-03.01.01.00")
    assert "serials" not in report
    assert "Propellers off" in (folder / "report.html").read_text()
    data = b"".join(frame.data for _, frame in read(folder / "capture.mcap"))
    assert b"SDK-v1.0" in data
    assert b"041D492163" not in data


def test_without_a_terminal_nothing_is_opened_and_nothing_left(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    assert run(["commission", "--rig", "sim-drone"]) == 2
    assert capsys.readouterr().err == (
        "teleop: teleop commission asks before anything moves: run it on a terminal, or with --console\n"
    )
    assert list(tmp_path.iterdir()) == []

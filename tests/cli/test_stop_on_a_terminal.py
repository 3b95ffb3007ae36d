"""STOP in runs that move by themselves, typed on a real terminal: it holds, is cleared, the run goes on."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from terminal import terminal

from teleop.core.axes import Axis
from teleop.recording.reader import read_take

MOVE = """
title: There
keyframes:
  - {at: 0, pan: 0}
  - {at: 4s, pan: 40}
"""


def test_a_stop_in_a_move_holds_until_it_is_cleared_and_then_the_move_goes_on(tmp_path: Path) -> None:
    (tmp_path / "there.yaml").write_text(MOVE)
    take = tmp_path / "take.mcap"
    with terminal("play", str(tmp_path / "there.yaml"), "--take", str(take), folder=tmp_path) as term:
        term.wait_for("playing")
        term.type(" ")
        term.wait_for("STOPPED. Press c to clear, q to end.")
        term.type("c")
        term.wait_for("STOP cleared. Press p or Enter to continue")
        term.type("p")
        code, out = term.end()
        assert term.restored
    assert code == 0, term.shown
    assert "stopped" not in out
    recorded = read_take(take)
    assert recorded.state(Axis.PAN, -1).position == pytest.approx(40, abs=1e-3)


@pytest.mark.parametrize("command", [["play", "MOVE"], ["calibrate", "delay"]])
def test_a_run_that_is_ended_while_it_is_stopped_says_so(tmp_path: Path, command: list[str]) -> None:
    (tmp_path / "there.yaml").write_text(MOVE)
    command = [str(tmp_path / "there.yaml") if each == "MOVE" else each for each in command]
    with terminal(*command, "--json", folder=tmp_path) as term:
        term.wait_for_keys()
        term.type(" ")
        term.wait_for("STOP by keys")
        term.type("q")
        code, out = term.end()
    report = json.loads(out)
    assert (code, report["result"]) == (130, "interrupted")
    assert report["reasons"] == ["stopped by keys", "ended while stopped: STOP by keys"]

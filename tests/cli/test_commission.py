"""`teleop commission` on a real terminal of 80 x 24, what it refuses, and what is left moving when it is killed."""

from __future__ import annotations

import json
import signal
import time
from pathlib import Path

import pytest
from command import teleop
from far_gimbal import FarGimbal, far_gimbal
from terminal_screen import TerminalScreen, screen

from teleop.commission.runner import AUTOREPEAT
from teleop.config.profile import load_profile
from teleop.config.sinks_section import GimbalSection
from teleop.dji.gimbal import camera
from teleop.dji.gimbal import messages as gimbal
from teleop.dji.gimbal.session import Session

STALLED = "the computer stalled"
URL = "udp_multicast:239.74.163.61"


def to_the_first_move(terminal: TerminalScreen) -> None:
    """Through what only asks, and past what can be skipped, to the page of pan's position command."""
    pages = "Leave 10 cm", "Enter next", "r repeats"
    while "Leave 10 cm" not in terminal.text:  # a busy computer loses replies, or stalls: both are shown
        terminal.wait_until(lambda rows: any(page in row for page in pages for row in rows), "a page")
        if "Leave 10 cm" not in terminal.text:
            terminal.type("\n")
            time.sleep(2 * AUTOREPEAT)  # a hand is no faster: two Enters within that are a key that is held down
    terminal.type("\n")
    terminal.wait_for("balanced, unlocked and on?")
    terminal.type("y")
    terminal.wait_for("Balanced and unlocked")
    terminal.type("\n")
    for title in ("Version, model", "Limits and stiffness", "The angles at rest", "Pushes of the gimbal"):
        terminal.wait_for(title)
        terminal.type("s")
    terminal.wait_for("pan goes 2 deg to one side")


def test_an_operator_is_taken_to_a_profile(tmp_path: Path) -> None:
    with screen("commission", "-o", "mine.yaml", folder=tmp_path, cwd=tmp_path) as terminal:
        to_the_first_move(terminal)
        terminal.look(key_line="Enter goes")
        go(terminal, "Did the camera turn right")
        terminal.look(key_line="space STOP")
        terminal.type("n")
        rows = terminal.wait_for("Sign of pan in position commands")
        assert any("Sign of pan in position commands" in row and "-1" in row and "different" in row for row in rows)
        terminal.look(key_line="Enter next")
        terminal.type("q")
        terminal.wait_for("Enter writes mine.yaml")
        terminal.type("\n")
        assert terminal.end() == 0
        assert any("mine.yaml: " in row for row in terminal.everything)
    section = load_profile(str(tmp_path / "mine.yaml")).sinks[0]
    assert isinstance(section, GimbalSection)
    assert section.signs == {"pan": -1}
    assert "# commission: signs.pan -1: the operator saw" in (tmp_path / "mine.yaml").read_text()


def test_space_stops_a_step_and_the_axis_goes_back_before_the_next(tmp_path: Path) -> None:
    with far_gimbal(URL) as far, screen("commission", *link(), folder=tmp_path, cwd=tmp_path) as terminal:
        to_the_first_move(terminal)
        terminal.type("\n")
        until(lambda: far.angles.yaw > 0.5)
        terminal.type(" ")
        terminal.wait_for("r repeats")
        assert any("STOPPED" in row for row in terminal.rows)
        terminal.look(key_line="r repeats")
        assert far.rates.yaw == 0
        terminal.type("s")
        terminal.wait_for("Position command: roll")
        assert abs(far.angles.yaw) < 0.4
        terminal.type("q")
        terminal.wait_for("Enter writes sim.yaml")
        terminal.type("q")
        assert terminal.end() == 1


@pytest.mark.parametrize("number", [signal.SIGKILL, signal.SIGTERM])
def test_a_kill_while_an_axis_moves_leaves_nothing_moving(number: signal.Signals, tmp_path: Path) -> None:
    with far_gimbal(URL) as far, screen("commission", *link(), folder=tmp_path, cwd=tmp_path) as terminal:
        to_the_first_move(terminal)
        terminal.type("\n")
        until(lambda: far.angles.yaw > 0.3)
        terminal.process.send_signal(number)
        terminal.end()
        time.sleep(1.0)  # the longest single command there is: what was sent has its own end
        place = far.angles
        time.sleep(0.3)
        assert far.angles == place
        assert not far.controlled
        assert abs(far.angles.yaw) <= 2.05


def test_it_refuses_to_begin_while_the_camera_records(tmp_path: Path) -> None:
    with far_gimbal(URL) as far:
        far.receive(Session().command(camera.Command(camera.CameraCommand.RECORD)), time.monotonic())
        with screen("commission", *link(), folder=tmp_path, cwd=tmp_path) as terminal:
            assert terminal.end() == 1
            assert any("the camera is recording: stop the recording" in row for row in terminal.everything)
        assert far.heard_of(gimbal.Position) == []
        assert far.heard_of(gimbal.Speed) == []


def test_it_needs_a_terminal_a_gimbal_and_a_file_of_one_s_own(tmp_path: Path) -> None:
    ran = teleop("commission", cwd=tmp_path)
    assert (ran.returncode, ran.stdout) == (2, "")
    assert (
        ran.stderr == "teleop: teleop commission asks before anything moves: run it on a terminal, or with --console\n"
    )


def test_with_json_the_findings_are_printed(tmp_path: Path) -> None:
    with screen("commission", "--json", folder=tmp_path, cwd=tmp_path) as terminal:
        terminal.wait_for("Leave 10 cm around it")
        terminal.type("q")
        assert terminal.end() == 1
        printed = terminal.raw.decode()
    report = json.loads('{"ok"' + printed.partition('{"ok"')[2].partition("\r")[0])
    assert report["ok"] is False
    assert report["findings"]["facts"][0]["key"] == "adapter.kind"


def go(terminal: TerminalScreen, text: str) -> None:
    """Enter, until the text is there; a step that a busy computer stalled is repeated."""
    terminal.type("\n")
    while not any(
        text in row for row in terminal.wait_until(lambda rows: any(text in r or STALLED in r for r in rows), text)
    ):
        terminal.type("r")
        terminal.wait_for("Enter goes")
        terminal.type("\n")
        terminal.wait_until(lambda rows: not any(STALLED in row for row in rows), "another try")


def link() -> list[str]:
    return ["--rig", "sim", "--link", f"gimbal={URL}"]


def until(holds) -> None:
    deadline = time.monotonic() + 30
    while not holds():
        assert time.monotonic() < deadline
        time.sleep(0.005)


__all__ = ["FarGimbal"]

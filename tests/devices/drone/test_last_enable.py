"""The note of the last enable: the next run waits from there, and where it cannot be read it waits from its begin."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

from teleop.devices.drone.last_enable import LastEnable, default_file


def test_the_next_run_knows_of_it(tmp_path: Path) -> None:
    last = LastEnable(tmp_path / "deep" / "enabled")
    assert last.read(100.0) == -math.inf, "never"
    assert last.write(100.25) == ""
    assert LastEnable(tmp_path / "deep" / "enabled").read(101.0) == 100.25
    assert LastEnable(tmp_path / "deep" / "enabled").read(50.0) == -math.inf, "the machine was rebooted"


def test_what_cannot_be_known_keeps_the_wait(tmp_path: Path) -> None:
    (tmp_path / "enabled").write_text("")  # killed while it wrote
    assert LastEnable(tmp_path / "enabled").read(100.0) == 100.0
    (tmp_path / "file").write_text("")
    assert LastEnable(tmp_path / "file" / "enabled").read(100.0) == 100.0


def test_what_cannot_be_noted_is_said(tmp_path: Path) -> None:
    trouble = LastEnable(tmp_path).write(1.0)
    assert trouble.startswith(f"{tmp_path}: ")
    assert "wait before engaging" in trouble


def test_it_is_kept_with_the_state_of_the_program(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path))
    assert default_file() == tmp_path / "teleop" / "virtual-rc-enabled"
    monkeypatch.setenv("XDG_STATE_HOME", "relative")
    assert default_file() == Path.home() / ".local/state/teleop/virtual-rc-enabled"

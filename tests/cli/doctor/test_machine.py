"""What doctor finds in the computer."""

from __future__ import annotations

import shutil
import sys
from collections import namedtuple

import pytest

from teleop.cli.doctor import machine
from teleop.cli.doctor.finding import State

Usage = namedtuple("Usage", "total used free")


def test_an_old_python_is_fatal(monkeypatch):
    monkeypatch.setattr(machine, "PYTHON", (99, 0))
    (finding,) = machine.python()
    assert (finding.state, finding.todo) == (State.FATAL, "install Python 3.11 or later")


def test_a_package_that_is_missing_is_named_with_its_cure(monkeypatch):
    monkeypatch.setattr(machine, "PACKAGES", {"hidapi": "no_such_module", "ruckig": "no_such_module", "numpy": "numpy"})
    states = {finding.found.partition(":")[0]: finding.state for finding in machine.packages()}
    assert states["hidapi"] is State.PROBLEM  # some things work without it
    assert states["ruckig"] is State.FATAL
    assert State.OK in states.values()


@pytest.mark.parametrize(("free", "state"), [(1e6, State.PROBLEM), (1e12, State.OK)])
def test_a_disk_without_room_is_a_problem(monkeypatch, tmp_path, free, state):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(shutil, "disk_usage", lambda _path: Usage(2e12, 0, free))
    (finding,) = machine.disk()
    assert finding.state is state


def test_a_folder_that_was_deleted_is_a_problem(monkeypatch, tmp_path):
    gone = tmp_path / "gone"
    gone.mkdir()
    monkeypatch.chdir(gone)
    gone.rmdir()
    (finding,) = machine.disk()
    assert finding.state is State.PROBLEM
    assert "cannot be used" in finding.found


def test_no_terminal_is_a_note(monkeypatch):
    monkeypatch.setattr(sys, "stdin", open("/dev/null"))  # noqa: SIM115 - pytest closes it
    (finding,) = machine.terminal()
    assert finding.state is State.NOTE

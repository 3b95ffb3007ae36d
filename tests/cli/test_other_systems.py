"""On macOS and Windows the package imports, and checks, plays on simulated rigs, previews and decodes.

Both are stood in for by a process of this system from which what they have not is hidden (tests/support).
"""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

OTHER = Path(__file__).parents[1] / "support" / "other_system.py"
SYSTEMS = pytest.mark.parametrize("system", ["win32", "darwin"])


def teleop_on(system: str, *arguments: str, cwd: Path, stdin: int = subprocess.DEVNULL) -> tuple[int, str, str]:
    done = subprocess.run(
        [sys.executable, str(OTHER), system, *arguments],
        stdin=stdin, capture_output=True, text=True, cwd=cwd, check=False, timeout=100,
    )  # fmt: skip
    return done.returncode, done.stdout, done.stderr


@SYSTEMS
@pytest.mark.parametrize(
    "command",
    [
        ("check", "reveal"),
        ("preview", "reveal", "-o", "reveal.html"),
        ("decode", "hid", "--descriptor", "pad.bin", "017f7f80"),
        ("play", "nudge", "--fast", "--take", "nudge.mcap"),
        ("live", "--sticks", "sticks.csv", "--fast"),
        ("devices", "--json"),
        ("copy", "xbox", "pad.yaml"),
    ],
    ids=" ".join,
)
def test_what_needs_no_hardware_runs(system: str, command: tuple[str, ...], tmp_path: Path) -> None:
    (tmp_path / "sticks.csv").write_text("time,pan\n0,1\n0.5,0\n1,0\n")
    (tmp_path / "pad.bin").write_bytes(bytes.fromhex("05010904a10109300931150026ff00750895028102c0"))
    code, _, errors = teleop_on(system, *command, cwd=tmp_path)
    assert (code, "Traceback" in errors) == (0, False), errors


@pytest.mark.parametrize(
    ("command", "line"),
    [
        (("live",), "teleop: warning: keys cannot be read on this system: use a pad; Ctrl-C stops"),
        (("live", "--learn"), "teleop: --learn cannot see Enter on this system: use Linux or macOS"),
        (("sim", "--drone"), "this system has no pseudo-terminals"),
    ],
    ids=lambda each: " ".join(each) if isinstance(each, tuple) else "",
)
def test_what_windows_has_not_is_one_line_at_a_terminal(command: tuple[str, ...], line: str, tmp_path: Path) -> None:
    master, slave = os.openpty()
    try:
        code, _, errors = teleop_on("win32", *command, cwd=tmp_path, stdin=slave)
    finally:
        os.close(master)
        os.close(slave)
    assert code in (1, 2)
    assert "Traceback" not in errors
    assert [each for each in errors.splitlines() if line in each] != []

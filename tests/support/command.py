"""The installed `teleop` command, as a user or a script runs it."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

TELEOP = str(Path(sys.executable).with_name("teleop"))


def teleop(*arguments: str, stdin: str = "", cwd: Path | None = None) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [TELEOP, *arguments], input=stdin, capture_output=True, text=True, cwd=cwd, check=False, timeout=100
    )


@contextmanager
def running(*arguments: str, cwd: Path | None = None) -> Iterator[subprocess.Popen[str]]:
    """A command in the background, killed when the block ends if it still runs then."""
    process = subprocess.Popen(
        [TELEOP, *arguments],
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        bufsize=1,
        cwd=cwd,
    )
    try:
        yield process
    finally:
        process.kill()
        process.communicate()

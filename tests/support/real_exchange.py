"""A real run of the simulated rig with an exchange, as a user starts it."""

from __future__ import annotations

import socket
import subprocess
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import IO

from real_console import RealConsole

from teleop.config.resources import find


def free_port(kind: socket.SocketKind = socket.SOCK_STREAM) -> int:
    with socket.socket(socket.AF_INET, kind) as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


@contextmanager
def real_exchange(folder: Path, *entries: str, errors: IO[bytes] | int = subprocess.DEVNULL) -> Iterator[RealConsole]:
    """`entries` are those of the profile's exchange, in flow style."""
    text = find("sim", "profiles", "rig")[0].read_text(encoding="utf-8")
    lines = "".join(f"  - {entry}\n" for entry in entries)
    (folder / "rig.yaml").write_text(f"{text}\nexchange:\n{lines}", encoding="utf-8")
    with RealConsole(folder, rig="rig.yaml", errors=errors) as console:
        yield console

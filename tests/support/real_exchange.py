"""A real run of the simulated rig with an exchange, as a user starts it."""

from __future__ import annotations

import socket
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from real_console import RealConsole

from teleop.config.resources import find


def free_port(kind: socket.SocketKind = socket.SOCK_STREAM) -> int:
    with socket.socket(socket.AF_INET, kind) as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


@contextmanager
def real_exchange(folder: Path, *entries: str) -> Iterator[RealConsole]:
    """`entries` are those of the profile's exchange, in flow style."""
    text = find("sim", "profiles", "rig")[0].read_text(encoding="utf-8")
    lines = "".join(f"  - {entry}\n" for entry in entries)
    (folder / "rig.yaml").write_text(f"{text}\nexchange:\n{lines}", encoding="utf-8")
    with RealConsole(folder, rig="rig.yaml") as console:
        yield console

"""The CAN interface under a run in motion: taken down, up again, and away, with real processes at both of its ends."""

from __future__ import annotations

import subprocess
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest
from bus_listener import BusListener
from command import running
from network import own_network

GIMBAL = "gimbal=socketcan:vcan0"
DOWN = "socketcan:vcan0: vcan0 is down: sudo ip link set vcan0 up"
GONE = "socketcan:vcan0: the adapter is gone: plug it in, then start again"


def ip(*words: str) -> None:
    subprocess.run(["ip", *words], check=True)


def ended(process: subprocess.Popen[str]) -> tuple[int, list[str]]:
    """The exit code, and the errors that were said."""
    _, said = process.communicate(timeout=30)
    return process.returncode, [line for line in said.splitlines() if line.startswith("teleop: ")]


@pytest.fixture
def sticks(tmp_path: Path) -> Path:
    """A slow pan to the right for longer than any test."""
    (tmp_path / "sticks.csv").write_text("time,pan\n0,0.1\n60,0\n")
    return tmp_path / "sticks.csv"


@contextmanager
def panning(sticks: Path) -> Iterator[list[subprocess.Popen[str]]]:
    """The simulated gimbal and what drives it, once a third node has seen it move."""
    with running("sim", "--link", GIMBAL) as sim:
        assert sim.stdout is not None
        assert "simulated gimbal" in sim.stdout.readline()
        with running("live", "--sticks", str(sticks), "--link", GIMBAL) as live:
            with BusListener("vcan0") as listener:
                listener.until(lambda: listener.pan > 5, "the pan")
            yield [sim, live]


def test_an_interface_goes_down_comes_back_and_goes_away(sticks: Path) -> None:
    with own_network("link add dev vcan0 type vcan", "link set vcan0 up"):
        with panning(sticks) as (sim, live):
            ip("link", "set", "vcan0", "down")
            assert ended(live) == (1, [f"teleop: stopped: {DOWN}"])
            assert ended(sim) == (1, [f"teleop: {DOWN}"])
        ip("link", "set", "vcan0", "up")
        with panning(sticks) as (sim, live):
            ip("link", "delete", "vcan0")
            assert ended(live) == (1, [f"teleop: stopped: {GONE}"])
            assert ended(sim) == (1, [f"teleop: {GONE}"])

"""Faults that only a real process can have: signals, a frozen process, a killed one. The gimbal is on a real bus."""

from __future__ import annotations

import os
import signal
import time
from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from subprocess import DEVNULL, PIPE, Popen

import pytest
from command import TELEOP, running
from far_gimbal import FarGimbal, far_gimbal
from network import own_network
from waiting import DEADLINE, wait_until

from teleop.dji.gimbal import messages as gimbal

URL = "udp_multicast:239.74.163.2"
SPEED = 36.0  # deg/s: sticks at 0.3
STICKS = "time,pan\n0,0.3\n40,0\n"
HOLDS = {"position": 0.1, "speed": 0.5}  # s for which the gimbal obeys its last command
COASTS = 0.35  # s: seven of its motors' time constants
PROFILES = Path(__file__).parents[2] / "profiles"


def freeze(process: Popen[str]) -> None:
    process.send_signal(signal.SIGSTOP)
    time.sleep(0.3)  # this is the fault, not waiting for one
    process.send_signal(signal.SIGCONT)


def sends(*numbers: signal.Signals) -> Callable[[Popen[str]], None]:
    def send(process: Popen[str]) -> None:
        for number in numbers:
            process.send_signal(number)

    return send


@dataclass(frozen=True)
class Row:
    name: str
    breaks: Callable[[Popen[str]], None]
    said: str
    code: int


ROWS = [
    Row("SIGINT", sends(signal.SIGINT), "stopped: SIGINT received", 130),
    Row("SIGTERM", sends(signal.SIGTERM), "stopped: SIGTERM received", 130),
    Row("SIGHUP", sends(signal.SIGHUP), "stopped: SIGHUP received", 130),
    Row("one signal after the other", sends(signal.SIGINT, signal.SIGTERM, signal.SIGINT), "received", 130),
    Row("300 ms stall", freeze, "stopped: the computer stalled for 0.", 1),
    Row("SIGKILL", sends(signal.SIGKILL), "", -signal.SIGKILL),
]


@pytest.fixture(scope="module")
def bus() -> Iterator[str]:
    with own_network("link set lo up", "route add 239.0.0.0/8 dev lo"):
        yield URL


@pytest.fixture
def far(bus: str) -> Iterator[FarGimbal]:
    with far_gimbal(bus) as gimbal:
        yield gimbal


@pytest.mark.parametrize("mode", ["position", "speed"])
@pytest.mark.parametrize("row", ROWS, ids=[row.name for row in ROWS])
def test_a_process_that_is_stopped_leaves_the_gimbal_at_rest(
    row: Row, mode: str, far: FarGimbal, bus: str, tmp_path: Path
) -> None:
    (tmp_path / "rig.yaml").write_text((PROFILES / "sim.yaml").read_text().replace("mode: position", f"mode: {mode}"))
    (tmp_path / "sticks.csv").write_text(STICKS)
    arguments = ["live", "--sticks", str(tmp_path / "sticks.csv"), "--rig", str(tmp_path / "rig.yaml")]
    with running(*arguments, "--link", f"gimbal={bus}") as process:
        wait_until(lambda: sum(rate > 0.9 * SPEED for _, rate in far.turned) > 50, "cruising")
        broken_at = time.monotonic()
        row.breaks(process)
        _, said = process.communicate(timeout=DEADLINE)
    assert process.returncode == row.code, said
    assert row.said in said
    wait_until(lambda: abs(far.rates.yaw) < 0.01, "rest")
    commands = far.heard_of(gimbal.Position if mode == "position" else gimbal.Speed)
    after = [rate for at, rate in far.turned if at > broken_at]
    assert min(after) > -0.2 * SPEED
    assert max(after) < 2 * SPEED, "catching up a late datagram, and no more"
    if row.code == -signal.SIGKILL:
        [(last, _)] = commands[-1:]
        still = next(at for at, rate in far.turned if at > last and abs(rate) < 0.01 * SPEED)
        assert still - last < HOLDS[mode] + COASTS
        assert far.controlled is (mode == "speed"), "the one exit that cannot give it back"
        return
    assert not far.controlled
    if mode == "speed":
        speeds = [message for _, message in far.heard if isinstance(message, gimbal.Speed)]
        assert [speed.take_over for speed in speeds[-4:]] == [True, True, True, False]
        assert [speed.yaw for speed in speeds[-4:]] == [0, 0, 0, 0]


def full_pipe() -> tuple[int, int]:
    """A pipe that has no room left: the end to read from, and the one to write to."""
    reading, writing = os.pipe()
    os.set_blocking(writing, False)
    with suppress(BlockingIOError):
        while True:
            os.write(writing, b"\n" * 512)
    os.set_blocking(writing, True)
    return reading, writing


def test_a_log_that_nobody_reads_holds_up_neither_the_motion_nor_its_end(
    far: FarGimbal, bus: str, tmp_path: Path
) -> None:
    (tmp_path / "rig.yaml").write_text((PROFILES / "sim.yaml").read_text().replace("mode: position", "mode: speed"))
    (tmp_path / "sticks.csv").write_text(STICKS)
    arguments = ["live", "--sticks", str(tmp_path / "sticks.csv"), "--rig", str(tmp_path / "rig.yaml")]
    reading, writing = full_pipe()
    command = [TELEOP, *arguments, "--link", f"gimbal={bus}"]
    with Popen(command, stdin=DEVNULL, stdout=PIPE, stderr=writing, text=True) as process:
        os.close(writing)
        wait_until(lambda: sum(rate > 0.9 * SPEED for _, rate in far.turned) > 1000, "cruising for 2 s")
        process.send_signal(signal.SIGTERM)
        wait_until(lambda: abs(far.rates.yaw) < 0.01 and not far.controlled, "rest, and given back")
        with os.fdopen(reading) as log:
            said = log.read()
        process.communicate(timeout=DEADLINE)
    assert process.returncode == 130
    cruising = [line for line in said.splitlines() if "pan" in line]
    assert len(cruising) >= 2, "what there was no room for came when there was"
    assert "stopped: SIGTERM received" in said

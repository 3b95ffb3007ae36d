"""The gateway as a process: it ends with its parent, and one that dies or hangs is started again, and that is told."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path

import msgpack
import pytest
from waiting import wait_until

from teleop.door.address import new_door
from teleop.door.ring import RingWriter
from teleop.door.sockets import CommandSocket
from teleop.remote import gateway_child
from teleop.remote.gateway_child import MOST, GatewayChild


class Door:
    """A door without a rig: what a gateway says is taken in `hears`."""

    def __init__(self, stack: ExitStack) -> None:
        address = stack.enter_context(new_door())
        ring = RingWriter(address.ring)
        stack.callback(ring.close)
        self._socket = CommandSocket(address.commands)
        stack.callback(self._socket.close)
        self.folder, self.heard, self.lines, self.ended = address.folder, -1e9, [], 0
        self.child = GatewayChild({"door": str(self.folder)}, (), lambda: self.heard, self.lines.append, self._ends)
        stack.callback(self.child.close)

    def _ends(self) -> None:
        self.ended += 1

    def hears(self) -> bool:
        said = [msgpack.unpackb(datagram.data)["do"] for datagram in self._socket.receive(50)]
        if "alive" in said:
            self.heard = time.monotonic()
        return "alive" in said

    @property
    def pid(self) -> int:
        assert self.child.process is not None
        return self.child.process.pid


@pytest.fixture
def door() -> Iterator[Door]:
    with ExitStack() as stack:
        made = Door(stack)
        made.child.start()
        wait_until(made.hears, "the gateway")
        yield made


def gone(pid: int) -> bool:
    try:
        return Path(f"/proc/{pid}/stat").read_text().split()[2] == "Z"
    except OSError:
        return True


def test_a_gateway_that_is_killed_is_started_again_and_says_so(door: Door) -> None:
    before = door.pid
    os.kill(before, signal.SIGKILL)
    wait_until(lambda: door.pid != before and door.hears(), "the next one")
    assert door.ended == 1
    assert door.lines == ["the gateway ended (signal 9): started again; the rig goes on"]


def test_a_gateway_that_hangs_is_killed_and_started_again(door: Door, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(gateway_child, "HUNG", 0.7)
    before = door.pid
    os.kill(before, signal.SIGSTOP)
    wait_until(lambda: (door.hears() or True) and door.pid != before, "the next one")
    assert gone(before)
    assert "did not answer for 0.7 s: started again" in door.lines[0]


def test_a_gateway_that_ends_at_once_is_started_three_times_a_minute() -> None:
    with ExitStack() as stack:
        door = Door(stack)
        door.child._settings = {}  # without a door it cannot begin
        door.child.start()
        wait_until(lambda: any("times in a minute" in line for line in door.lines), "the last line")
        assert door.ended == MOST + 1


def test_the_gateway_ends_with_the_run(door: Door) -> None:
    pid = door.pid
    door.child.close()
    assert gone(pid)
    assert not door.lines


STARTS = """
import subprocess, sys, json, time
child = subprocess.Popen([sys.executable, "-m", "teleop.gateway"], stdin=subprocess.PIPE)
child.stdin.write(json.dumps({"door": sys.argv[1]}).encode() + b"\\n"); child.stdin.flush()
print(child.pid, flush=True)
time.sleep(60)
"""


@pytest.mark.parametrize("stopped", [False, True])
def test_the_gateway_ends_with_a_control_process_that_is_killed(stopped: bool) -> None:
    if stopped and sys.platform != "linux":
        pytest.skip("the parent-death signal is Linux's")
    with ExitStack() as stack:
        door = Door(stack)
        with subprocess.Popen([sys.executable, "-c", STARTS, str(door.folder)], stdout=subprocess.PIPE) as parent:
            assert parent.stdout is not None
            pid = int(parent.stdout.readline())
            wait_until(door.hears, "the gateway")
            if stopped:
                os.kill(pid, signal.SIGSTOP)
            parent.kill()
        wait_until(lambda: gone(pid), "the end of the gateway")

"""The simulated gimbal on a real bus, in a thread of the test's own, which keeps what it heard and how it moved."""

from __future__ import annotations

import fcntl
import tempfile
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TypeVar

from teleop.cli.sim import serve
from teleop.core.clock import SystemClock
from teleop.dji.gimbal.session import Session
from teleop.dji.message import Message
from teleop.links import open_link
from teleop.sim.gimbal.device import SimulatedGimbal

Kind = TypeVar("Kind", bound=Message)


class FarGimbal(SimulatedGimbal):
    """`heard` is every message with its time (s, monotonic), `turned` the rate of yaw (deg/s) every 2 ms."""

    def __init__(self) -> None:
        super().__init__()
        self.heard: list[tuple[float, Message]] = []
        self.turned: list[tuple[float, float]] = []
        self._listening = Session()

    def heard_of(self, kind: type[Kind]) -> list[tuple[float, Kind]]:
        return [(time, message) for time, message in self.heard if isinstance(message, kind)]

    def receive(self, data: bytes, now: float) -> None:
        self.heard += [(now, received.message) for received in self._listening.receive(data, now)]
        super().receive(data, now)
        self.turned.append((now, self.rates.yaw))


LOCK = Path(tempfile.gettempdir()) / "teleop-tests-far-gimbal.lock"


@contextmanager
def far_gimbal(url: str) -> Iterator[FarGimbal]:
    """A gimbal at the other end of a bus by multicast; one at a time on this computer.

    A socket hears every group of its port that anybody here has joined, so two buses are one, whatever their groups.
    """
    with open(LOCK, "w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)  # until the file is closed
        with _far_gimbal(url) as gimbal:
            yield gimbal


@contextmanager
def _far_gimbal(url: str) -> Iterator[FarGimbal]:
    gimbal, stop, clock = FarGimbal(), threading.Event(), SystemClock()
    link = open_link(url, host=False, now=clock.now)
    thread = threading.Thread(target=serve, args=({"gimbal": link}, {"gimbal": gimbal}, clock, stop))
    thread.start()
    try:
        yield gimbal
    finally:
        stop.set()
        thread.join()
        link.close()

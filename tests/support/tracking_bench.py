"""A rig in real time with a gateway process that serves its exchange, and what the simulated gimbal truly does."""

from __future__ import annotations

import select
import socket
import threading
import time
from bisect import bisect_left
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from itertools import pairwise
from pathlib import Path

import msgpack
from remote_bench import PROFILE, RemoteBench, remote_bench
from waiting import wait_until

from teleop.app.realtime import realtime
from teleop.config.profile import checked_profile
from teleop.core.clock import SystemClock
from teleop.core.events import Tick
from teleop.dji.gimbal import messages as gimbal
from teleop.door.messages import packed
from teleop.door.sockets import ClientSocket
from teleop.exchange.opening import opened
from teleop.remote.gateway_child import Gateway
from teleop.sim.gimbal.gimbal_axes import Angles

RESOLUTION = 0.1  # deg, of a gimbal's angles on its wire
ON_ITS_WAY = 0.06  # deg that the bench's axes move in the ms that a question is on its way
AROUND = 0.15  # s
EVEN, EVEN_TICKS = 0.05, 0.015  # s between two questions and two ticks of a machine that keeps up


class TrackingBench:
    """`truth` is the gimbal's attitude at each of `times`; `receiver` has what arrives for the test."""

    def __init__(self, folder: Path, stack: ExitStack, entries: str, receiver: socket.socket) -> None:
        profile = checked_profile(f"{PROFILE}\nexchange:\n{entries}", "bench.yaml")
        exchange = stack.enter_context(opened(profile))
        gateway = Gateway(exchange.settings, exchange.passed, [exchange.greeting])
        self.receiver = receiver
        self.times: list[float] = []
        self.truth: list[Angles] = []
        self._bench: RemoteBench | None = None
        self._bench = stack.enter_context(remote_bench(folder, SystemClock(), self, gateway))
        address = self._bench.hands.door.address
        self._socket = ClientSocket(address.client(2), address.commands)
        stack.callback(self._socket.close)
        self._socket.setblocking(True)
        self._number = 0
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()
        stack.callback(self._end)

    def _run(self) -> None:
        assert self._bench is not None
        with realtime(True, print):
            self._bench.loop.run()

    def observe(self, tick: Tick) -> None:
        if self._bench is not None:
            there = self._bench.tap.gimbal
            if not self.times or there._now > self.times[-1]:
                self.truth.append(there.angles)
                self.times.append(there._now)

    def ask(self, do: str, **fields: object) -> dict:
        """The answer to a command of the holder."""
        self._number += 1
        self._socket.send(packed({"do": do, "id": self._number, "session": "anna", "person": "Anna", **fields}))
        while True:
            assert select.select([self._socket.fileno()], [], [], 10)[0], self._faults()
            answer = msgpack.unpackb(self._socket.recv(4096))
            if answer["id"] == self._number and not answer.get("done"):
                return answer

    def receive(self, seconds: float) -> list[tuple[float, bytes]]:
        """When each datagram arrived, and what it has, for so long from the first one on."""
        self.receiver.settimeout(30)
        found: list[tuple[float, bytes]] = []
        while not found or found[-1][0] - found[0][0] < seconds:
            try:
                data = self.receiver.recv(65536)
            except TimeoutError:
                raise AssertionError(self._faults()) from None
            found.append((time.monotonic(), data))
        return found

    def missed(self, instant: float, pan: float, tilt: float) -> float:
        """By how many degrees an attitude is off the true one, beyond what a message can know."""
        true = self.true_at(instant)
        return max(abs(pan - true.yaw), abs(tilt - true.pitch)) - RESOLUTION - ON_ITS_WAY

    def kept_up(self, instant: float) -> bool:
        """Whether the machine did, around `instant`: questions and commands came evenly."""
        assert self._bench is not None
        asked = [at for at, _ in self._bench.tap.of(gimbal.Angles) if abs(at - instant) < AROUND]
        ticks = [at for at in self.times if abs(at - instant) < AROUND]
        return _even(asked, EVEN) and _even(ticks, EVEN_TICKS)

    def true_at(self, instant: float) -> Angles:
        """The gimbal's own attitude, from the ticks around `instant`."""
        wait_until(lambda: self.times and self.times[-1] >= instant, "the tick")
        place = bisect_left(self.times, instant)
        begin, end = self.times[place - 1], self.times[place]
        share = (instant - begin) / (end - begin)
        rows = zip(self.truth[place - 1], self.truth[place], strict=True)
        return Angles(*(one + share * (other - one) for one, other in rows))

    @property
    def lines(self) -> list[str]:
        assert self._bench is not None
        return self._bench.lines

    def _faults(self) -> str:
        assert self._bench is not None
        return "; ".join([*map(str, self._bench.loop.faults), *self.lines])

    def _end(self) -> None:
        assert self._bench is not None
        self._bench.loop.interrupt("the test is over")
        self._thread.join(10)


def _even(times: list[float], most: float) -> bool:
    return len(times) > 2 and max(after - before for before, after in pairwise(times)) <= most


@contextmanager
def tracking_bench(folder: Path, entry: str) -> Iterator[TrackingBench]:
    """`entry` is that of an exchange, with TO for where the bench receives."""
    with ExitStack() as stack:
        receiver = stack.enter_context(socket.socket(socket.AF_INET, socket.SOCK_DGRAM))
        receiver.bind(("127.0.0.1", 0))
        port = receiver.getsockname()[1]
        yield TrackingBench(folder, stack, f"  - {entry.replace('TO', f'127.0.0.1:{port}')}\n", receiver)

"""A rig with a door in real time, its loop in a thread, and clients in other processes to which bad things happen."""

from __future__ import annotations

import signal
import subprocess
import sys
import threading
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from itertools import pairwise
from pathlib import Path

from remote_bench import remote_bench
from waiting import wait_until

from teleop.app.realtime import realtime
from teleop.core.axes import Axis
from teleop.core.clock import SystemClock
from teleop.core.events import Tick
from teleop.core.timing import PERIOD
from teleop.dji.gimbal.camera import CameraCommand, Command
from teleop.remote.desk import Desk
from teleop.remote.shoot_job import ShootJob

RAMP = 60 / 240 + 240 / 2400  # s from the bench's full speed to rest, at its limits
SILENCE = 0.25
HAND = Path(__file__).with_name("door_hand.py")


class ChaosBench:
    """`ticks` are the time and the commanded speed of pan; `heard` when the newest stick was sent, at each of them."""

    def __init__(self, folder: Path, stack: ExitStack, fifo: bool = False) -> None:
        self._fifo = fifo
        self.ticks: list[tuple[float, float]] = []
        self.heard: list[float] = []
        self.desk: Desk | None = None
        self._bench = stack.enter_context(remote_bench(folder, clock=SystemClock(), observer=self))
        self.door, self.loop = self._bench.hands.desk, self._bench.loop
        self.desk = self.door
        self.wire = self._bench.tap
        self._stack = stack
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()
        stack.callback(self._end)

    def observe(self, tick: Tick) -> None:
        self.ticks.append((tick.time, tick.motion[Axis.PAN].velocity))
        self.heard.append(self.desk.stick._stream.sent if self.desk else -1.0)

    def client(self, what: str, amount: int | str = 0) -> subprocess.Popen[str]:
        """Once it has begun."""
        folder = self._bench.hands.door.address.folder
        process = subprocess.Popen(
            [sys.executable, str(HAND), str(folder), what, str(amount)], stdout=subprocess.PIPE, text=True
        )
        self._stack.callback(self._kill, process)
        assert process.stdout is not None
        assert process.stdout.readline() == "holding\n"
        return process

    def until_full_speed(self, client: subprocess.Popen[str]) -> None:
        """And until its client has seen it, which from then on does not take control again by itself."""
        wait_until(lambda: any(speed > 59.9 for _, speed in self.ticks), "full speed")
        assert client.stdout is not None
        assert client.stdout.readline() == "moved\n"

    def until_rest(self) -> None:
        """Then one rest follows that lasts: 0.3 s of ticks."""
        wait_until(lambda: len(self.ticks) > 30 and not any(speed for _, speed in self.ticks[-30:]), "rest")

    @property
    def shoot(self) -> ShootJob | None:
        return self._bench.hands._actions.moves.shoots.job

    @property
    def plays(self) -> bool:
        return self._bench.hands._jobs.job is not None

    @property
    def shots(self) -> list[float]:
        """When the shutter was pressed, on the wire."""
        commands = list(self.wire.of(Command))
        return [at for at, message in commands if message.command is CameraCommand.SHUTTER]

    @property
    def late(self) -> float:
        """By how much the loop itself was late at worst, in s."""
        return max(after - before for (before, _), (after, _) in pairwise(self.ticks)) - PERIOD

    def overruns(self) -> float:
        """By how much motion outlasted what it may, at worst, in s, beyond what the loop itself was late.

        For each tick with motion: how old the newest stick was, less the time it may take to rest.
        """
        worst = -1.0
        for place, (now, speed) in enumerate(self.ticks):
            if speed and self.heard[place] > 0:
                before = [at for at, _ in self.ticks[max(0, place - 60) : place + 1]]
                late = max(b - a for a, b in pairwise(before))
                worst = max(worst, now - self.heard[place] - SILENCE - RAMP - 2 * late)
        return worst

    def _kill(self, process: subprocess.Popen[str]) -> None:
        process.send_signal(signal.SIGKILL)
        process.wait()
        if process.stdout is not None:
            process.stdout.close()

    def _run(self) -> None:
        with realtime(self._fifo, lambda _line: None):
            self.loop.run()

    def _end(self) -> None:
        self.loop.interrupt("the test is over")
        self._thread.join(10)


@contextmanager
def chaos_bench(folder: Path, fifo: bool = False) -> Iterator[ChaosBench]:
    """With `fifo` the loop is a real-time thread, where that is permitted: a machine under load does not stall it."""
    with ExitStack() as stack:
        yield ChaosBench(folder, stack, fifo)

"""A whole rig on virtual time over a CAN bus that a test can break, mid-move, and everything that passed on it.

The rig is real from its profile to python-can; what stands at the far end is the simulated gimbal, looked after every
2 ms, as a real one looks after itself while our computer stalls.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from itertools import pairwise
from pathlib import Path
from typing import TypeVar

import can
import can.interfaces
import pytest
from faulty_bus import FaultyBus, register
from hooked_clock import HookedClock

from teleop.config.profile import load_profile
from teleop.core.axes import Axis, Limits
from teleop.core.clock import SystemClock
from teleop.core.control_loop import LEAD, ControlLoop
from teleop.core.events import Tick
from teleop.core.interfaces import Link, Observer, Source
from teleop.core.run_state import RunState, RunStateMachine
from teleop.core.setpoints import VelocityTarget
from teleop.devices.rig import Rig, open_rig
from teleop.dji.gimbal import messages as gimbal
from teleop.dji.gimbal.session import Session
from teleop.dji.message import Message
from teleop.links import open_link
from teleop.sim.gimbal.device import SimulatedGimbal

PAN = Limits(-180, 180, 60, 240, 2400)
SPEEDS = {Axis.PAN: 40.0, Axis.TILT: -10.0}  # deg/s of the move that is broken
PROFILE = """
name: Faulty
links: {gimbal: "faulty:CHANNEL"}
axes:
  pan:  {min: -180, max: 180, velocity: 60, acceleration: 240, jerk: 2400}
  tilt: {min: -90,  max: 146, velocity: 60, acceleration: 240, jerk: 2400}
sinks: [{type: gimbal, link: gimbal, mode: MODE, rate: 50, delay: DELAY}]
"""
DELAYS = {"position": 0.0, "speed": 0.05, "stick": 0.05}
LOOK = 0.002  # s between looks at the bus
BREAKS = 1.5  # s after the start of the move
SLACK = 3.0  # deg/s: the grid of angles over a command's time, settling, and correction

_channels = itertools.count()
Kind = TypeVar("Kind", bound=Message)


class SteppingClock(HookedClock):
    """Calls `hook` every LOOK seconds while time passes, also during a stall."""

    def sleep_until(self, time: float) -> None:
        time = max(time, self.now()) + self._too_long
        step = max(LOOK, self._too_long / 5000)
        self._too_long = 0.0
        while self.now() < time:
            super().sleep_until(min(self.now() + step, time))


class RealClock(SystemClock):
    """The machine's own time, with the hook."""

    def __init__(self) -> None:
        self.hook: Callable[[float], None] = lambda _now: None

    def sleep_until(self, time: float) -> None:
        while (now := self.now()) < time:
            super().sleep_until(min(now + LOOK, time))
            self.hook(self.now())


class Mover:
    """A source that moves pan and tilt for `seconds`, and has something done to it at BREAKS."""

    def __init__(self, breaks: Callable[[float], object], seconds: float) -> None:
        self._seconds = seconds
        self.begin = self.broken_at = float("inf")
        self._breaks = breaks

    def start(self, now: float, motion: object) -> None:
        self.begin = now

    def read(self, now: float, _feedback: object):
        if now >= self.begin + BREAKS and self.broken_at == float("inf"):
            self.broken_at = now - LEAD  # the clock's time: a tick is read that long before its moment
            self._breaks(self.broken_at)
        return (
            {axis: VelocityTarget(speed) for axis, speed in SPEEDS.items()} if now < self.begin + self._seconds else {}
        ), ()

    def next_change(self, now: float) -> float:
        return now if now < self.begin + self._seconds else float("inf")


class Watcher:
    """Sees each tick; a test may break it."""

    def observe(self, tick: Tick) -> None: ...


class GimbalFaultBench:
    """`wire` is every message to the gimbal with its time, `rates` its rates (deg/s) with theirs."""

    def __init__(self, mode: str, rig: Rig, clock: SteppingClock | RealClock, far: Link) -> None:
        self.mode, self.rig, self.clock, self._far = mode, rig, clock, far
        self.bus = FaultyBus.opened[-1]
        self.gimbal = SimulatedGimbal()
        self.wire: list[tuple[float, Message]] = []
        self.rates: list[tuple[float, float, float]] = []  # time, yaw, pitch
        self.mute = self.deaf = False
        self.releasing_at = math.inf
        self.loop: ControlLoop
        self._run: RunStateMachine | None = None
        self.ended: RunStateMachine
        self.mover: Mover
        self.watcher = Watcher()
        self._session = Session()
        clock.hook = self.pass_time

    def pass_time(self, now: float) -> None:
        if self._run is not None and self._run.state is RunState.RELEASING:
            self.releasing_at = min(self.releasing_at, now)
        arrived = self._far.receive()
        if not self.deaf:
            self.gimbal.receive(arrived, now)
            self.wire += [(now, received.message) for received in self._session.receive(arrived, now)]
        said = self.gimbal.advance(now)
        if said and not self.mute:
            self._far.send(said)
        self.rates.append((now, self.gimbal.rates.yaw, self.gimbal.rates.pitch))

    def move(
        self, breaks: Callable[[float], object], observers: Sequence[Observer] = (), seconds: float = 60.0
    ) -> None:
        """The whole run of a move that is broken, and a second after it."""
        self.mover = Mover(breaks, seconds)
        self.run(self.mover, [self.watcher, *observers])

    def run(self, source: Source, observers: Sequence[Observer]) -> None:
        """A whole run, and a second after it."""
        self.loop = self.rig.loop(list(SPEEDS), [source], observers)
        self._run = self.loop.supervisor
        self.ended = self.loop.run()
        self.over = self.clock.now()
        self.clock.sleep_until(self.over + 1)

    @property
    def broken_at(self) -> float:
        return self.mover.broken_at

    def of(self, kind: type[Kind]) -> list[tuple[float, Kind]]:
        return [(time, message) for time, message in self.wire if isinstance(message, kind)]

    def commands(self) -> list[tuple[float, tuple[float, float]]]:
        """Speeds or aims of pan and tilt as they were sent, the last ones of a release left out."""
        if self.mode == "position":
            return [(time, (each.yaw, each.pitch)) for time, each in self.of(gimbal.Position)]
        if self.mode == "speed":
            return [(time, (each.yaw, each.pitch)) for time, each in self.of(gimbal.Speed) if each.take_over]
        return [(time, (each.yaw / 250, each.pitch / 250)) for time, each in self.of(gimbal.Joystick)]

    def assert_moving_when_broken(self) -> None:
        yaw, pitch = next((yaw, pitch) for time, yaw, pitch in self.rates if time >= self.broken_at)
        assert (yaw, pitch) == (pytest.approx(SPEEDS[Axis.PAN], abs=2), pytest.approx(SPEEDS[Axis.TILT], abs=2))

    def assert_no_lurch(self, lunge: float = 0.0, regains: float = SLACK) -> None:
        """Once it was broken, the gimbal never went faster than it did, nor back, by more than `lunge` (deg/s).

        Nor did an axis that had slowed down, or stopped, set out again: it gains `regains` deg/s at the most.
        """
        slack = SLACK + lunge
        slowest = [abs(SPEEDS[Axis.PAN]), abs(SPEEDS[Axis.TILT])]
        for time, *rates in self.rates:
            if time < self.broken_at:
                continue
            since = f"{time - self.broken_at:.3f} s: {rates}, at the slowest {slowest}"
            for index, axis in enumerate(SPEEDS):
                onward = rates[index] * math.copysign(1.0, SPEEDS[axis])
                assert -slack <= onward <= abs(SPEEDS[axis]) + slack, since
                assert onward <= slowest[index] + regains, since
                slowest[index] = min(slowest[index], max(onward, 0.0))

    def assert_no_jump(self) -> None:
        """What was commanded changed within the limits from each frame to the next, the correction's share included."""
        commands = [each for each in self.commands() if each[0] < self.releasing_at or self.mode != "position"]
        if self.mode == "position":
            steps = [
                (b[0], b[0] - a[0], [y - x for x, y in zip(a[1], b[1], strict=True)]) for a, b in pairwise(commands)
            ]
            for time, seconds, moved in steps:
                assert all(
                    abs(way) <= PAN.velocity * seconds + 0.11 + 0.1 * 2 * PAN.acceleration * seconds for way in moved
                ), time
            return
        for (before, one), (after, other) in pairwise(commands):
            most = (2 * PAN.acceleration + (DELAYS[self.mode] + 0.01) * PAN.jerk) * (after - before) + 0.3
            assert all(abs(y - x) <= most for x, y in zip(one, other, strict=True)), (after, one, other)

    def assert_at_rest(self) -> None:
        assert self.rates[-1][1:] == (pytest.approx(0, abs=0.01), pytest.approx(0, abs=0.01))

    def assert_given_back(self) -> None:
        assert not self.gimbal.controlled
        if self.mode == "speed":
            speeds = [speed for _, speed in self.of(gimbal.Speed)]
            assert not speeds[-1].take_over
            assert [(each.yaw, each.roll, each.pitch) for each in speeds[-4:]] == [(0, 0, 0)] * 4
        if self.mode == "stick":
            assert [(push.yaw, push.pitch) for _, push in self.of(gimbal.Joystick)][-3:] == [(0, 0)] * 3


@contextmanager
def gimbal_fault_bench(
    mode: str, folder: Path, monkeypatch: pytest.MonkeyPatch, clock: SteppingClock | RealClock | None = None
) -> Iterator[GimbalFaultBench]:
    register(monkeypatch)
    monkeypatch.setattr(can.interfaces, "VALID_INTERFACES", can.interfaces.VALID_INTERFACES | {"faulty"})
    channel = f"bench{next(_channels)}"
    text = PROFILE.replace("CHANNEL", channel).replace("MODE", mode).replace("DELAY", str(DELAYS[mode]))
    (folder / "rig.yaml").write_text(text)
    clock = clock or SteppingClock()
    far = open_link(f"virtual:{channel}", host=False, now=clock.now)
    try:
        with open_rig(load_profile(str(folder / "rig.yaml")), clock) as rig:
            yield GimbalFaultBench(mode, rig, clock, far)
    finally:
        far.close()

"""A gimbal that obeys bytes and moves as its dynamics say: dead time, lag, gain, drift, and what else real ones have.

It is independent of the program's own simulator, so that what is identified is not what was assumed: all is integrated
in steps of a millisecond, a second-order mode is one of the speed, and a drift is there at rest too.
"""

from __future__ import annotations

import math
import random
from collections import deque

from teleop.dji.gimbal import messages as gimbal
from teleop.dji.gimbal.enums import AngleKind
from teleop.dji.gimbal.session import Session
from teleop.dji.message import Message, Result
from teleop.sim.gimbal.dynamics import Dynamics

STEP = 0.001  # s
HOLDS = 0.5  # s that a speed is obeyed
STICK_FULL = 15_000


class Drive:
    """One axis; `at` is where it is now, in deg."""

    def __init__(self, dynamics: Dynamics, at: float) -> None:
        self.dynamics = dynamics
        self.at = self.motor = at
        self.rate = self._push = self._push_rate = 0.0
        self.held = False
        self.commands: deque[tuple[float, float]] = deque()
        self._command, self._until = 0.0, -math.inf
        self._travel: tuple[float, float] | None = None  # the target of a position command, and when it is reached

    def speed(self, now: float, value: float) -> None:
        self.commands.append((now + self.dynamics.dead_time, value))
        self._travel = None

    def go(self, now: float, target: float, seconds: float) -> None:
        self.commands.clear()
        self._travel = target, now + seconds

    def step(self, now: float) -> None:
        """From `now` on, for one step."""
        of = self.dynamics
        while self.commands and self.commands[0][0] <= now:
            self._command, self._until = self.commands.popleft()[1], now + HOLDS
        wanted = of.gain * self._command if now < self._until else 0.0
        if self._travel is not None:
            target, end = self._travel
            left = end - now
            self.rate = (target - self.motor) / left if left > STEP else 0.0
            if left <= STEP:
                self.motor, self._travel = target, None
                self._command = 0.0
            self._turn(self.rate * STEP)
            return
        if of.natural_frequency:  # the lag's output is what a second-order mode follows
            self._push += (wanted - self._push) * (1 - math.exp(-STEP / of.lag))
            omega = 2 * math.pi * of.natural_frequency
            self._push_rate += STEP * (
                omega * omega * (self._push - self.rate) - 2 * of.damping * omega * self._push_rate
            )
            self.rate += STEP * self._push_rate
            self._turn((self.rate + of.drift) * STEP)
            return
        decay = math.exp(-STEP / of.lag)
        moved = wanted * STEP + (self.rate - wanted) * of.lag * (1 - decay)
        self.rate = wanted + (self.rate - wanted) * decay
        self._turn(moved + of.drift * STEP)

    def _turn(self, way: float) -> None:
        if self.held:
            return
        self.motor += way
        half = self.dynamics.backlash / 2
        self.at = min(max(self.at, self.motor - half), self.motor + half)


class UnknownGimbal:
    """Frames in, frames out. `dynamics` is that of each axis; `path` has the exact pan (deg) every 5 ms.

    With `pushes_at` (Hz) it answers no question for its angles and pushes them instead. Of the readings `lost` is the
    share that never comes.
    """

    def __init__(
        self,
        dynamics: Dynamics,
        boot: tuple[float, float, float] = (0.0, 0.0, 0.0),
        pushes_at: float = 0.0,
        lost: float = 0.0,
        seed: int = 1,
    ) -> None:
        self.drives = [Drive(dynamics, angle) for angle in boot]  # yaw, roll, pitch
        self.path: list[tuple[float, float]] = []
        self.speeds: list[tuple[float, float]] = []  # of yaw, as they were sent
        self._session = Session()
        self._now: float | None = None
        self._steps = 0
        self._outgoing = bytearray()
        self._pushes_at, self._lost = pushes_at, lost
        self._next_push = math.inf
        self._random = random.Random(seed)
        self._past: deque[tuple[float, ...]] = deque(maxlen=400)

    def become(self, dynamics: Dynamics) -> None:
        for drive in self.drives:
            drive.dynamics = dynamics

    def receive(self, data: bytes, now: float) -> None:
        self._pass(now)
        for received in self._session.receive(data, now):
            frame, message = received.frame, received.message
            if frame.is_reply:
                continue
            answer = self._obey(message, now)
            if answer is not None and frame.cmd_type & 0x1F:
                self._outgoing += self._session.reply(frame, answer)

    def advance(self, now: float) -> bytes:
        self._pass(now)
        sent = bytes(self._outgoing)
        self._outgoing.clear()
        return sent

    def _pass(self, now: float) -> None:
        if self._now is None:
            self._now, self._origin = now, now
            self._next_push = now
        while self._now + STEP <= now + 1e-9:
            if self._steps % 5 == 0:
                self.path.append((self._now, self.drives[0].at))
            for drive in self.drives:
                drive.step(self._now)
            self._past.append(tuple(drive.at for drive in self.drives))
            self._steps += 1
            self._now = self._origin + self._steps * STEP
            if self._pushes_at and self._now >= self._next_push:
                self._next_push += 1 / self._pushes_at
                if self._random.random() >= self._lost:
                    yaw, roll, pitch = self._seen()
                    push = gimbal.ShortPush(
                        angles_valid=True, limits_valid=False, stiffness_valid=False, yaw=yaw, roll=roll, pitch=pitch
                    )
                    self._outgoing += self._session.command(push)

    def _seen(self) -> list[float]:
        late = round(self.drives[0].dynamics.report_age / STEP)
        angles = self._past[-1 - min(late, len(self._past) - 1)] if self._past else tuple(d.at for d in self.drives)
        noise = self.drives[0].dynamics.noise
        return [angle + (self._random.gauss(0, noise) if noise else 0.0) for angle in angles]

    def _obey(self, message: Message, now: float) -> Message | None:
        match message:
            case gimbal.Speed():
                self.speeds.append((now, message.yaw if message.take_over else 0.0))
                for drive, speed in zip(self.drives, (message.yaw, message.roll, message.pitch), strict=True):
                    drive.speed(now, speed if message.take_over else 0.0)
            case gimbal.Joystick():
                for drive, push in zip(self.drives, (message.yaw, message.roll, message.pitch), strict=True):
                    drive.speed(now, 120.0 * push / STICK_FULL)
            case gimbal.Position():
                ignored = message.yaw_ignored, message.roll_ignored, message.pitch_ignored
                angles = message.yaw, message.roll, message.pitch
                for drive, angle, ignore in zip(self.drives, angles, ignored, strict=True):
                    if not ignore:
                        drive.go(now, angle, message.time_for_action)
            case gimbal.Angles():
                if self._pushes_at or self._random.random() < self._lost:
                    return None
                yaw, roll, pitch = self._seen()
                return gimbal.AnglesReply(0, AngleKind.ATTITUDE, yaw, roll, pitch)
        return Result(0)

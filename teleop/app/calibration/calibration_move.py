"""A small test move: an axis swings to one side of where it stands and back, eased in and out, a few times over.

One-sided, so that it begins and ends where the axis stood, and towards the side with more room. Slow, so that it is
harmless, and because a lag and a dead time then look the same.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise

from teleop.core.axes import Axis, Limits, Motion
from teleop.core.errors import DeviceError, UsageError
from teleop.core.events import SourceEvent, TickEvent
from teleop.core.interfaces import Feedback
from teleop.core.run_status import RunStatus
from teleop.core.setpoints import Demand, Setpoint, StateTarget

SWING_SECONDS = 4.0  # s for one swing, or longer where the axis's limits ask for it
LONGEST = 30.0  # s for one swing
SHARE = 0.8  # of the axis's limits that a swing may use
REST = 1.0  # s at rest before and after, so that what is late is seen to its end


class CalibrationMove:
    """A source of `swings` swings of `reach` units. `begin` is when the first starts, inf until the run has started.

    A swing takes `seconds`, or longer where the limits ask for it. Raises UsageError when the axis is too slow for it;
    `start` raises DeviceError when there is no room for it.
    """

    def __init__(self, axis: Axis, limits: Limits, reach: float, swings: int, seconds: float = SWING_SECONDS) -> None:
        self.begin = math.inf
        self._axis, self._limits, self._reach, self._swings = axis, limits, reach, swings
        self._rest, self._side = 0.0, 1.0
        self.period = seconds
        while not self._legal():
            self.period *= 1.25
            if self.period > LONGEST:
                raise UsageError(f"{axis}: its limits are too low for a test move of {reach:g} deg")

    @property
    def duration(self) -> float:
        return self.period * self._swings

    @property
    def fastest(self) -> float:
        """The highest speed on the way, in units/s."""
        return max(abs(self._at(self.duration * k / 2000)[1]) for k in range(2000))

    def start(self, now: float, motion: Motion) -> None:
        self._rest = motion[self._axis].position
        room = self._limits.maximum - self._rest, self._rest - self._limits.minimum
        if max(room) < self._reach:
            raise DeviceError(f"{self._axis} has no room for a test move of {self._reach:g} deg: move it further in")
        self._side = 1.0 if room[0] >= self._reach else -1.0
        self.begin = now + REST

    resumable, pauses, busy, quits = True, False, False, False  # a pause would spoil the measurement: it begins anew

    def pause(self, now: float) -> bool | None:  # noqa: ARG002 - see `pauses`
        return False

    def suspend(self, now: float) -> None:  # noqa: ARG002 - what was measured so far is not used
        self.begin = math.inf

    def linger(self, now: float) -> Sequence[TickEvent]:  # noqa: ARG002 - it does nothing but move
        return ()

    def resume(self, now: float, motion: Motion) -> None:
        """From the first swing, where the axis rests now."""
        self.start(now, motion)

    def read(self, now: float, _feedback: Feedback) -> tuple[Demand, Sequence[SourceEvent]]:
        place, velocity, acceleration = self._at(now - self.begin)
        setpoint: Setpoint = StateTarget(
            self._rest + self._side * place, self._side * velocity, self._side * acceleration
        )
        return {self._axis: setpoint}, ()

    def status(self, now: float) -> RunStatus:
        """What a view shows of it at `now`."""
        elapsed = min(max(0.0, now - self.begin), self.duration)
        phase = "at rest" if now < self.begin or elapsed >= self.duration else "swinging"
        return RunStatus(phase, elapsed, self.duration, self.duration - elapsed)

    def next_change(self, now: float) -> float:
        return now if now < self.begin + self.duration + REST else math.inf

    def _at(self, time: float) -> tuple[float, float, float]:
        """How far out, with velocity and acceleration: a raised cosine, eased in and out."""
        if not 0.0 < time < self.duration:
            return 0.0, 0.0, 0.0
        rate = 2 * math.pi / self.period
        wave = (1 - math.cos(rate * time)) / 2, rate * math.sin(rate * time) / 2, rate**2 * math.cos(rate * time) / 2
        from_end = time > self.duration / 2
        x = min(1.0, (self.duration - time if from_end else time) / self.period)
        cover = x**3 * (10 - 15 * x + 6 * x * x), 30 * x**2 * (1 - x) ** 2 / self.period, 60 * x * (1 - x) * (1 - 2 * x)
        slope = -cover[1] if from_end else cover[1]
        bend = cover[2] / self.period**2
        place = cover[0] * wave[0]
        velocity = slope * wave[0] + cover[0] * wave[1]
        acceleration = bend * wave[0] + 2 * slope * wave[1] + cover[0] * wave[2]
        return self._reach * place, self._reach * velocity, self._reach * acceleration

    def _legal(self) -> bool:
        step = self.period / 500
        states = [self._at(step * k) for k in range(round(self.duration / step))]
        jerks = [(after[2] - before[2]) / step for before, after in pairwise(states)]
        most = max(abs(s[1]) for s in states), max(abs(s[2]) for s in states), max(map(abs, jerks))
        allowed = self._limits.velocity, self._limits.acceleration, self._limits.jerk
        return all(value <= SHARE * limit for value, limit in zip(most, allowed, strict=True))

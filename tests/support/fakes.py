"""Plain objects in the shape of the interfaces, for tests of what stands between them."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence

from teleop.core.axes import Axis, Motion, Reading
from teleop.core.clock import VirtualClock
from teleop.core.events import Action, Tick
from teleop.core.interfaces import Feedback
from teleop.core.setpoints import Demand, VelocityTarget

NO_FEEDBACK = Feedback({}, {})  # for a source that asks for none


class ScriptedSource:
    """Demands from a function of the time since its start, until `end` seconds."""

    def __init__(self, demand: Callable[[float], Demand], end: float, actions: Sequence[tuple[float, Action]] = ()):
        self._demand, self._end, self._actions = demand, end, list(actions)
        self.begin = math.inf

    def start(self, now: float, motion: Motion) -> None:
        self.begin = now

    def read(self, now: float, _feedback: Feedback) -> tuple[Demand, Sequence[Action]]:
        elapsed = now - self.begin
        due = [action for at, action in self._actions if at <= elapsed]
        self._actions = [(at, action) for at, action in self._actions if at > elapsed]
        return (self._demand(elapsed) if elapsed < self._end else {}), due

    def next_change(self, now: float) -> float:
        return now if now - self.begin < self._end else math.inf


def cruising(axis: Axis, velocity: float, end: float) -> ScriptedSource:
    return ScriptedSource(lambda _elapsed: {axis: VelocityTarget(velocity)}, end)


class RecordingSink:
    """Keeps every tick, and when it was asked to release; gives the device back in `steps` steps of 50 ms."""

    def __init__(self, steps: int = 1) -> None:
        self.ticks: list[Tick] = []
        self.released: list[float] = []
        self._steps = steps

    def write(self, tick: Tick) -> None:
        self.ticks.append(tick)

    def release(self, now: float) -> float | None:
        self.released.append(now)
        return now + 0.05 if len(self.released) < self._steps else None


class RecordingObserver:
    """Keeps every tick."""

    def __init__(self) -> None:
        self.ticks: list[Tick] = []

    def observe(self, tick: Tick) -> None:
        self.ticks.append(tick)


class PlacedReporter:
    """Says that the axes are where they were placed."""

    def __init__(self, positions: Mapping[Axis, float]) -> None:
        self._positions = positions

    def report(self, now: float) -> Mapping[Axis, Reading]:
        return {axis: Reading(position, now) for axis, position in self._positions.items()}


class StallingClock(VirtualClock):
    """A clock on a machine that once freezes for a while."""

    def __init__(self, at: float, seconds: float) -> None:
        super().__init__()
        self._at, self._seconds = at, seconds

    def sleep_until(self, time: float) -> None:
        super().sleep_until(time)
        if self.now() >= self._at:
            super().sleep_until(self.now() + self._seconds)
            self._at = math.inf

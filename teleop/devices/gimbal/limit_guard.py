"""Keeps the measured angle within the soft limits, whatever the plan says and however the gimbal answers.

Of an axis with a lag and a dead time all that was sent still comes, and no more: it comes to rest at the last reading,
plus the gain times what was sent and has not been travelled. The rest needs no tuning: the speed that is sent may be
so high that this, a period at that speed and the axis's own stop from it, end at the limit. What counts is the worst
of the responses that the readings leave plausible: many at first, and few once the axis has moved.
"""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np

from teleop.core.axes import Axis, Limits
from teleop.core.events import Tick
from teleop.core.setpoints import Stop
from teleop.identification.estimator import ResponseEstimator

BEYOND = 0.25  # deg: the grid and noise of the readings are no reason to act
BACK = 2.0  # deg/s per deg beyond, towards the limit
BACK_AT_MOST = 5.0  # deg/s
ACTS = 1.0  # deg/s less than wanted: then it is said
AGAIN = 1.0  # s without acting, after which it is another event
PLANS = 100  # ticks of plan: an axis that is planned outside is not held back there


class LimitGuard:
    """`period` is that of the commands, in s. `lines` are what it has to say."""

    def __init__(
        self, limits: Mapping[Axis, Limits], period: float, estimators: Mapping[Axis, ResponseEstimator]
    ) -> None:
        self.lines: list[str] = []
        self._limits, self._period, self._estimators = limits, period, estimators
        self._acted: dict[Axis, float] = {}

    def speeds(self, tick: Tick, speeds: Mapping[Axis, float]) -> dict[Axis, float]:
        """The speeds, or less."""
        return {axis: self._speed(axis, speed, tick) for axis, speed in speeds.items()}

    def _speed(self, axis: Axis, speed: float, tick: Tick) -> float:
        if self._limits[axis].continuous or self._estimators[axis].reading is None:
            return speed
        stopping = isinstance(tick.demand.get(axis), Stop)
        high, low = self._most(axis, 1, tick), self._most(axis, -1, tick)
        if stopping:
            high, low = max(high, 0.0), max(low, 0.0)
        allowed = max(min(speed, high), -low)
        if abs(allowed - speed) > ACTS:
            self._say(axis, speed, tick)
        return allowed

    def _most(self, axis: Axis, side: int, tick: Tick) -> float:
        """The most speed (deg/s) towards `side`; below 0 when it has to come back."""
        limits = self._limits[axis]
        limit = (
            max(limits.maximum, tick.motion[axis].position)
            if side > 0
            else max(-limits.minimum, -tick.motion[axis].position)
        )
        rests, gains = self._estimators[axis].rests(tick.time, side)
        room = limit + BEYOND - side * rests
        a, t = limits.acceleration, self._period / 2
        # u^2 / 2a + u t = room / gain: what a stop from u takes in commands that are a period long
        inside = np.maximum(room, 0.0) / gains
        speeds = a * (np.sqrt(t * t + 2 * inside / a) - t)
        back = np.maximum(BACK * np.minimum(room, 0.0), -BACK_AT_MOST)
        return float(np.min(speeds + back))

    def _say(self, axis: Axis, speed: float, tick: Tick) -> None:
        before = self._acted.get(axis, -math.inf)
        self._acted[axis] = tick.time
        if tick.time - before > AGAIN:
            limit = self._limits[axis].maximum if speed > 0 else self._limits[axis].minimum
            measured = self._measured(axis)
            self.lines.append(
                f"{axis} is slowed down to stop at its soft limit of {limit:g} deg: measured {measured:.1f}"
            )

    def _measured(self, axis: Axis) -> float:
        reading = self._estimators[axis].reading
        return math.nan if reading is None else reading.position

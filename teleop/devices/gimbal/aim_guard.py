"""Keeps the measured angle within the soft limits where positions are sent.

A gimbal goes to the position that it is sent and stays there, so with a good one there is nothing to do: no aim lies
beyond a soft limit. One that ends up elsewhere, because its mount has slipped or its angles are off, is aimed so much
short of the limit as it is measured beyond.
"""

from __future__ import annotations

import math
from collections.abc import Mapping

from teleop.core.axes import Axis, Limits
from teleop.core.events import Tick
from teleop.core.setpoints import Stop

BEYOND = 0.3  # deg: the grid, noise and a little overshoot are no reason to act
FRESH = 0.2  # s: an older reading says nothing
SHARE = 2.0  # of what it is beyond, per s
AT_MOST = 10.0  # deg short of a limit
INSIDE = 1.0  # deg of aim within the limit after which it is another event


class AimGuard:
    """`lines` are what it has to say. `limits` are those of the axes that it is for."""

    def __init__(self, limits: Mapping[Axis, Limits]) -> None:
        self.lines: list[str] = []
        self._limits = {axis: of for axis, of in limits.items() if not of.continuous}
        self._short: dict[Axis, float] = {}  # deg, of the limit on the side that the axis is beyond
        self._seen: dict[Axis, float] = {}

    def aim(self, axis: Axis, aim: float, tick: Tick) -> float:
        """Where to send an axis that is to go to `aim`, in deg."""
        limits, reading = self._limits.get(axis), tick.reported.get(axis)
        if limits is None or reading is None or isinstance(tick.demand.get(axis), Stop):
            return aim
        side = 1 if reading.position - limits.minimum > limits.maximum - reading.position else -1
        limit = limits.maximum if side > 0 else limits.minimum
        if side * (limit - aim) > INSIDE or side * (limit - tick.motion[axis].position) < 0:
            self._short.pop(axis, None)  # it goes inside by its plan, or is planned outside: it began there
            return aim
        beyond = side * (reading.position - limit)
        before = self._seen.get(axis, -math.inf)
        if reading.time > before and tick.time - reading.time < FRESH:
            self._seen[axis] = reading.time
            if beyond > BEYOND and axis not in self._short:
                self.lines.append(
                    f"{axis} is aimed short of its soft limit of {limit:g} deg: measured {reading.position:.1f}"
                )
                self._short[axis] = 0.0
            if axis in self._short:
                more = SHARE * beyond * min(reading.time - before, FRESH)
                self._short[axis] = min(max(self._short[axis] + more, 0.0), AT_MOST)
        short = self._short.get(axis, 0.0)
        return min(aim, limit - short) if side > 0 else max(aim, limit + short)

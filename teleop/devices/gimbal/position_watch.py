"""How late each axis is that is sent positions, seen while it moves anyway. Nothing goes by it: it is shown and kept.

What is sent positions is not integrated on the way, so a delay describes it, and a dead time and a lag look the same.
"""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Iterable, Mapping

from teleop.core.axes import Axis, Reading
from teleop.core.events import Tick
from teleop.core.response import Response
from teleop.monitors.delay_estimate import estimate

COMMANDS, READINGS = 3000, 750  # the last half minute of motion, at 100 and 25 Hz
SURE = 0.012  # s of doubt of the delay
FAITHFUL = 0.9, 1.1  # times as far as commanded: beyond these it did something else
MISFIT = 0.3  # deg rms that no delay explains
EASED = 0.5  # s after which an axis that rests says no more


class PositionWatch:
    """`lead` (s) is by how much each axis is sent ahead: that much later it is than its readings show."""

    def __init__(self, axes: Iterable[Axis], lead: float) -> None:
        self._lead = lead
        self._commanded = {axis: deque[tuple[float, float]](maxlen=COMMANDS) for axis in axes}
        self._readings = {axis: deque[Reading](maxlen=READINGS) for axis in self._commanded}
        self._moved: dict[Axis, float] = {}  # when each last moved

    def note(self, tick: Tick) -> None:
        """Call it for every tick; what rests is not noted."""
        for axis, commanded in self._commanded.items():
            state, reading = tick.motion.get(axis), tick.reported.get(axis)
            if state is None:
                continue
            if state.velocity or state.acceleration:
                self._moved[axis] = tick.time
            if tick.time - self._moved.get(axis, -math.inf) > EASED:
                continue
            commanded.append((tick.time, state.position))
            read = self._readings[axis]
            if reading is not None and (not read or reading.time > read[-1].time):
                read.append(reading)

    @property
    def responses(self) -> Mapping[Axis, Response]:
        """Of the axes that have moved enough to be sure of them."""
        found = {axis: self._response(axis) for axis in self._commanded}
        return {axis: response for axis, response in found.items() if response is not None}

    def _response(self, axis: Axis) -> Response | None:
        commanded, readings = self._commanded[axis], self._readings[axis]
        if not commanded or not readings:
            return None
        begin, end = max(commanded[0][0], readings[0].time), readings[-1].time
        read = [(each.time, each.position) for each in readings]
        delay = estimate(commanded, read, begin, end)
        if delay is None or not delay.doubt < SURE or delay.rms > MISFIT:
            return None
        if not FAITHFUL[0] <= delay.scale <= FAITHFUL[1]:
            return None
        return Response(max(0.0, delay.seconds + self._lead), 0.0, delay.scale, 0.0, delay.doubt)

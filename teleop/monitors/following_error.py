"""Stops the run when an axis does not follow: blocked, held by hand, or without readings.

A gimbal trails what is commanded by a little, so a reading is compared with everywhere the axis was commanded to be
during the time that it may lag, not with one moment. What lies beyond that by more than the tolerance, reading after
reading, is no lag. An axis whose readings stop altogether is moved blindly, which is no better.
"""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Callable, Container, Mapping, Sequence

from teleop.core.axes import Axis, Limits, Motion
from teleop.core.errors import DeviceError
from teleop.core.events import Tick

EXCESS_TIMEOUT = 0.5  # s for which an axis may be elsewhere
OBEYS_FOR = 1.3  # s of its way that show whether it obeys: longer than it takes to turn round, where nothing shows
TRAILING = 0.2  # s by which readings may trail the command, beyond the delay that is known
GIVEN_UP = 5.0  # s for which an axis that goes where it is sent may be elsewhere: it does not come closer
BLIND = 2.5  # s without a reading; a gimbal that only pushes may do so once a second (docs/protocol-facts.md)
HISTORY = 300  # ticks of commanded motion: the lag, and the age of a reading


class FollowingErrorGuard:
    """An observer of the run.

    `tolerance` is how far from commanded each axis to be watched may be, in units; `delay` how much later than
    commanded it moves, in s (0 where absent). Of an axis that is `excused` the reason is known already. `obeys` says
    whether an axis has gone where it was sent since a time (s), by what is known of its response; None: unknown.
    """

    def __init__(
        self,
        limits: Mapping[Axis, Limits],
        tolerance: Mapping[Axis, float],
        delay: Mapping[Axis, float],
        excused: Sequence[Container[Axis]] = (),
        obeys: Callable[[Axis, float], bool | None] = lambda _axis, _since: None,
    ) -> None:
        self._excused, self._obeys = excused, obeys
        self._tolerance, self._delay = tolerance, delay
        self._turns = {axis for axis in tolerance if axis in limits and limits[axis].continuous}
        self._commanded: deque[tuple[float, Motion]] = deque(maxlen=HISTORY)
        self._judged: dict[Axis, float] = {}  # the time of the last reading that was looked at
        self._away: dict[Axis, float] = {}  # since which reading an axis is elsewhere

    def observe(self, tick: Tick) -> None:
        """Raises DeviceError for an axis that has been elsewhere, or unseen, for too long."""
        self._commanded.append((tick.time, tick.motion))
        for axis in self._tolerance:
            reading = tick.reported.get(axis)
            if axis not in tick.motion or reading is None or any(axis in known for known in self._excused):
                continue
            if tick.time - max(reading.time, self._commanded[0][0]) > BLIND:
                raise DeviceError(f"{axis}: no position has been reported for {BLIND:g} s")
            if reading.time != self._judged.get(axis) and reading.time >= self._commanded[0][0]:
                self._judged[axis] = reading.time
                self._judge(axis, reading.position, reading.time)

    def _judge(self, axis: Axis, measured: float, time: float) -> None:
        nearest = self._nearest(axis, measured, time)
        if abs(measured - nearest) <= self._tolerance[axis]:
            self._away.pop(axis, None)
        elif time - self._away.setdefault(axis, time) > EXCESS_TIMEOUT:
            if self._obeys(axis, time - OBEYS_FOR):
                self._wait_for(axis, measured, nearest, time)
                return
            del self._away[axis]
            raise DeviceError(
                f"{axis} does not follow: commanded {nearest:.1f}, measured {measured:.1f}:"
                " is it blocked, or held by hand?"
            )

    def _wait_for(self, axis: Axis, measured: float, nearest: float, time: float) -> None:
        """It goes where it is sent, and that is elsewhere: held back at a soft limit, or slower than was thought."""
        if time - self._away[axis] > GIVEN_UP:
            del self._away[axis]
            raise DeviceError(f"{axis} does not come closer: commanded {nearest:.1f}, measured {measured:.1f}")

    def _nearest(self, axis: Axis, measured: float, time: float) -> float:
        """Of everywhere the axis was commanded to be while a reading at `time` may lag, what is nearest to it."""
        begin = time - self._delay.get(axis, 0.0) - TRAILING
        low, high = math.inf, -math.inf
        for commanded, motion in reversed(self._commanded):
            position = motion[axis].position
            low, high = min(low, position), max(high, position)
            if commanded <= begin:
                break
        if axis in self._turns:  # a turn more or less is the same place
            middle = (low + high) / 2
            turns = 360 * round((measured - middle) / 360)
            low, high = low + turns, high + turns
        return min(max(measured, low), high)

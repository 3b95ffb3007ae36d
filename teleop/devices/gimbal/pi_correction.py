"""The speed that takes an axis along its plan: feed-forward, plus what corrects the measured error (PI).

The error is taken at the time of the reading, so that the age of a report does not look like lag, and an old one
corrects nothing (docs/explanation/planning.md, E).

A correction may never be a lunge, whatever the readings say (a gimbal that was rebooted, an axis held by hand): the
error counts up to a bound, the correction changes no faster than the axis may accelerate, and it fades once the axis
is to stop. The integral rests while the plan accelerates and where its soft limit is near, because what looks like an
error there is lag; and it gives up what was not sent in the end.
"""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Mapping
from typing import NamedTuple

from teleop.core.axes import Axis, Limits, Motion, State
from teleop.core.events import Tick
from teleop.core.guard_stop import stop_reach
from teleop.core.setpoints import Stop


class Gains(NamedTuple):
    """How hard the measured error is worked against: deg/s per deg, and deg/s2 per deg."""

    proportional: float = 3.0  # docs/explanation/planning.md, E
    integral: float = 2.0


MAX_ERROR = 5.0  # deg: an axis that is further away does not follow, and working harder would not help
MAX_INTEGRAL = 5.0  # deg/s: an axis held by hand must not wind up a lunge
DEAD_BAND = 0.05  # deg, half of the gimbal's grid
STEADY = 0.05  # of the axis's acceleration: less is a steady speed
UNSENT = 5.0  # deg/s2 per deg/s that was not sent, by which the integral goes back
ROUNDING = 0.1  # deg/s by which what is sent may differ for its rounding
FRESH = 0.2  # s: an older reading corrects nothing
HISTORY = 100  # ticks of commanded motion that readings are compared with


class PiCorrection:
    """`ahead` is in s: how much later than commanded a speed is reached, half a command's period included."""

    def __init__(self, limits: Mapping[Axis, Limits], ahead: float, gains: Gains = Gains()) -> None:  # noqa: B008 - immutable
        self._limits, self._ahead, self._gains = limits, ahead, gains
        self._commanded: deque[tuple[float, Motion]] = deque(maxlen=HISTORY)
        self._errors: dict[Axis, tuple[float, float]] = {}  # time of the reading (s), error (deg)
        self._integrals: dict[Axis, float] = {}
        self._wanted: dict[Axis, float] = {}  # before any limit, deg/s
        self._sent_at = -math.inf
        self._applied: dict[Axis, tuple[float, float]] = {}  # when (s), and what (deg/s) was last added

    def note(self, tick: Tick) -> None:
        """Remember what this tick commands; call it for every tick."""
        self._commanded.append((tick.time, tick.motion))

    def speeds(self, tick: Tick) -> dict[Axis, float]:
        """The speed to command now for each axis, in deg/s, never beyond the axis's own velocity."""
        return {axis: self._speed(axis, state, tick) for axis, state in tick.motion.items() if axis in self._limits}

    def sent(self, now: float, speeds: Mapping[Axis, float]) -> None:
        """These speeds were sent in the end: what is missing of the integral was for nothing."""
        for axis, wanted in self._wanted.items():
            missing = wanted - speeds.get(axis, 0.0)
            integral = self._integrals.get(axis, 0.0)
            if abs(missing) > ROUNDING and missing * integral > 0:
                back = min(abs(integral), UNSENT * abs(missing) * min(now - self._sent_at, FRESH))
                self._integrals[axis] = integral - math.copysign(back, integral)
        self._sent_at = now

    def _speed(self, axis: Axis, state: State, tick: Tick) -> float:
        limits = self._limits[axis]
        feed_forward = state.velocity + self._ahead * state.acceleration
        wanted = 0.0 if isinstance(tick.demand.get(axis), Stop) else self._correction(axis, tick)
        time, applied = self._applied.get(axis, (self._commanded[0][0], 0.0))
        change = limits.acceleration * min(tick.time - time, FRESH)
        applied += min(max(wanted - applied, -change), change)
        self._applied[axis] = tick.time, applied
        self._wanted[axis] = feed_forward + applied
        return min(max(feed_forward + applied, -limits.velocity), limits.velocity)

    def _correction(self, axis: Axis, tick: Tick) -> float:
        reading = tick.reported.get(axis)
        if reading is None or tick.time - reading.time > FRESH or reading.time < self._commanded[0][0]:
            return 0.0
        before, error = self._errors.get(axis, (reading.time, 0.0))
        if reading.time != before or axis not in self._errors:
            error = min(max(self._at(axis, reading.time) - reading.position, -MAX_ERROR), MAX_ERROR)
            error = error if abs(error) > DEAD_BAND else 0.0
            self._errors[axis] = (reading.time, error)
            integral = self._integrals.get(axis, 0.0)
            if integral * error < 0 or self._may_gather(axis, tick.motion[axis], error):
                integral += self._gains.integral * error * min(reading.time - before, FRESH)
            self._integrals[axis] = min(max(integral, -MAX_INTEGRAL), MAX_INTEGRAL)
        return self._gains.proportional * error + self._integrals[axis]

    def _may_gather(self, axis: Axis, state: State, error: float) -> bool:
        """Whether an error may count for longer: the plan goes steadily, and ends well within the soft limit."""
        limits = self._limits[axis]
        if abs(state.acceleration) > STEADY * limits.acceleration:
            return False
        low, high = stop_reach(state.velocity, state.acceleration, limits.acceleration, limits.jerk)
        if not state.velocity:
            return True  # it has to hold its place there against a drift
        return state.position + high < limits.maximum if error > 0 else state.position + low > limits.minimum

    def _at(self, axis: Axis, time: float) -> float:
        """Where the axis was commanded to be at the tick nearest to a time in the last second."""
        _, motion = min(self._commanded, key=lambda commanded: abs(commanded[0] - time))
        return motion[axis].position

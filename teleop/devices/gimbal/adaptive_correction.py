"""The speed that takes an axis along its plan when the response of the gimbal is being identified meanwhile.

What is sent now is felt a dead time later, so the plan is looked at then, and so is the axis: where the commands that
are already under way will have taken it. What lag explains is therefore no error, and nothing winds up on it. Speeds
count as they left, after every limit and the rounding: what was not sent is not expected. A lasting error is a drift,
and the estimator finds that (docs/explanation/closed-loop.md).
"""

from __future__ import annotations

import math
from collections.abc import Mapping

from teleop.core.axes import Axis, Limits, State
from teleop.core.events import Tick
from teleop.core.setpoints import Stop
from teleop.devices.gimbal.outlook import Foreseen, Outlook, outlook
from teleop.devices.gimbal.pi_correction import FRESH, MAX_ERROR, Gains
from teleop.identification.estimator import Ahead, ResponseEstimator

GAIN = 0.75, 1.3  # what may be made up for
LARGE, FIRMER = 0.15, 0.7  # deg; by that share more what is beyond counts
FIRM = 0.03  # s of doubt of the delay at which that may be
DRIFT = 1.5  # deg/s that may be made up for


class AdaptiveCorrection:
    """`period` is that of the commands, in s."""

    def __init__(
        self, limits: Mapping[Axis, Limits], period: float, estimators: Mapping[Axis, ResponseEstimator], gains: Gains
    ) -> None:
        self._limits, self._period, self._estimators, self._gains = limits, period, estimators, gains
        self.foreseen: Foreseen | None = None
        self._applied: dict[Axis, tuple[float, float]] = {}  # when (s), and what (deg/s) was last added

    def note(self, tick: Tick) -> None:
        """Nothing is remembered: the estimators do that."""

    def sent(self, now: float, speeds: Mapping[Axis, float]) -> None:
        """The estimators know what was sent."""

    def speeds(self, tick: Tick) -> dict[Axis, float]:
        """The speed to command now for each axis, in deg/s, never beyond the axis's own velocity."""
        return {axis: self._speed(axis, state, tick) for axis, state in tick.motion.items() if axis in self._limits}

    def _speed(self, axis: Axis, state: State, tick: Tick) -> float:
        limits = self._limits[axis]
        ahead = self._estimators[axis].ahead(tick.time)
        if ahead is None:
            return state.velocity + self._period / 2 * state.acceleration
        stopping = isinstance(tick.demand.get(axis), Stop)
        plan, weights = outlook(axis, tick.time, state, None if stopping else self.foreseen), ahead.weights
        dead_time, lag = float(weights @ ahead.dead_times), float(weights @ ahead.lags)
        _, velocity, acceleration = plan.at(dead_time + self._period / 2)
        feed_forward = velocity + lag * acceleration
        wanted = 0.0 if stopping else self._correction(axis, plan, ahead, tick)
        time, applied = self._applied.get(axis, (tick.time - self._period, 0.0))
        change = limits.acceleration * min(tick.time - time, FRESH)
        applied += min(max(wanted - applied, -change), change)
        self._applied[axis] = tick.time, applied
        gain = min(max(float(weights @ ahead.gains), GAIN[0]), GAIN[1])
        return min(max((feed_forward + applied) / gain, -limits.velocity), limits.velocity)

    def _correction(self, axis: Axis, plan: Outlook, ahead: Ahead, tick: Tick) -> float:
        reading = self._estimators[axis].reading
        if reading is None or tick.time - reading.time > FRESH:
            return 0.0
        planned = plan.at(float(ahead.weights @ ahead.dead_times)).position
        error = min(max(planned - float(ahead.weights @ ahead.places), -MAX_ERROR), MAX_ERROR)
        drift = min(max(float(ahead.weights @ ahead.drifts), -DRIFT), DRIFT) if self._gains.integral else 0.0
        firm = self._estimators[axis].response.delay_doubt < FIRM
        large = math.copysign(max(0.0, abs(error) - LARGE), error)
        return self._gains.proportional * (error + firm * FIRMER * large) - drift

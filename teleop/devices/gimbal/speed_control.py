"""What becomes of a plan before a gimbal is sent speeds: corrected by readings, held back at a soft limit, remembered.

The response of each axis is identified on the way. A profile with a `delay` overrides what is found of it: the
correction then takes the profile's word, and only the guard at the soft limits goes by what is measured.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping

from teleop.core.axes import Axis, Limits
from teleop.core.events import Tick
from teleop.core.response import Response
from teleop.devices.gimbal.adaptive_correction import AdaptiveCorrection
from teleop.devices.gimbal.limit_guard import LimitGuard
from teleop.devices.gimbal.outlook import Foreseen
from teleop.devices.gimbal.pi_correction import Gains, PiCorrection
from teleop.identification.candidates import Start
from teleop.identification.estimator import ResponseEstimator

UNKNOWN_REST = 1.5  # s (tests/benchmarks/unknown_gimbals.py)
RINGS = 4.0  # times its delay, for which an axis swings after a short and brisk move


class SpeedControl:
    """`period` is that of the commands, in s; `delay` how much later than commanded a speed is reached, None: unknown.

    `priors` are what was found of the axes before, `start` what is thought of their gain without.
    """

    def __init__(
        self,
        limits: Mapping[Axis, Limits],
        period: float,
        delay: float | None,
        gains: Gains,
        priors: Mapping[Axis, Response],
        start: Start = Start(),  # noqa: B008 - immutable
    ) -> None:
        self.estimators = {axis: ResponseEstimator(priors.get(axis), start) for axis in limits}
        self.changed: set[Axis] = set()  # what was known of these no longer held at some time
        self.latest: dict[Axis, tuple[float, float]] = {}  # when a speed was last sent (s), and which (deg/s)
        self._guard = LimitGuard(limits, period, self.estimators)
        self.lines = self._guard.lines  # what there is to say: whoever says it empties the list
        self._correction: PiCorrection | AdaptiveCorrection
        if delay is None:
            self._correction = AdaptiveCorrection(limits, period, self.estimators, gains)
        else:
            self._correction = PiCorrection(limits, delay + period / 2, gains)

    def note(self, tick: Tick) -> None:
        """Remember what this tick commands and reports; call it for every tick."""
        self._correction.note(tick)
        for axis, estimator in self.estimators.items():
            if reading := tick.reported.get(axis):
                estimator.read(reading)
                if estimator.changed:
                    estimator.changed = False
                    self.changed.add(axis)
                    self.lines.append(f"{axis} answers otherwise than before: it is identified anew")

    def foresee(self, foreseen: Foreseen | None) -> None:
        """Look ahead by `foreseen` from now on; None is a hand's doing again."""
        if isinstance(self._correction, AdaptiveCorrection):
            self._correction.foreseen = foreseen

    def speeds(self, tick: Tick) -> dict[Axis, float]:
        """The speed to send now for each axis, in deg/s."""
        return self._guard.speeds(tick, self._correction.speeds(tick))

    def sent(self, now: float, speeds: Mapping[Axis, float]) -> None:
        """These speeds (deg/s) are sent now, 0 for an axis that is not among them."""
        self._correction.sent(now, speeds)
        for axis, estimator in self.estimators.items():
            self.latest[axis] = now, speeds.get(axis, 0.0)
            estimator.sent(*self.latest[axis])

    def rest_needed(self, axes: Collection[Axis]) -> float:
        """How long (s) the axes should rest before a move: meanwhile a drift shows itself, and what rings dies away."""
        if not isinstance(self._correction, AdaptiveCorrection):
            return 0.0
        used = [each for axis, each in self.estimators.items() if axis in axes]
        return max((RINGS * each.response.delay if each.known else UNKNOWN_REST for each in used), default=0.0)

    @property
    def relied_on(self) -> Mapping[Axis, Response]:
        """Those of the responses by which speeds are corrected: none where the profile's delay counts."""
        return self.responses if isinstance(self._correction, AdaptiveCorrection) else {}

    @property
    def responses(self) -> Mapping[Axis, Response]:
        """Of the axes that have moved enough to be sure of them."""
        return {axis: estimator.response for axis, estimator in self.estimators.items() if estimator.sure}

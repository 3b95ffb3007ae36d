"""One axis under a stick: from a deflection to the velocity that is asked of the planner, and how gently.

The low-pass takes out the noise of a hand: 3 % of it doubles the jerk (docs/explanation/planning.md, A). The ramp is
the damping control: gentler limits, with which full speed takes that long. They follow the speed that is to be ramped,
not only the range: a range lowered at full speed, or a preset left at its fastest, stops as soon as any other motion.
"""

from __future__ import annotations

import math

from teleop.core.axes import Limits, State
from teleop.core.setpoints import VelocityTarget

LEVEL = 1.5  # how much higher than on average the acceleration of a ramp is; the jerk then takes a third at either end
NOTHING = 1e-3  # of a deflection, below which the low-pass has nothing left


class VelocityShaping:
    """An axis with these limits; `ramp` and `low_pass` (a time constant) are in s, 0 for none."""

    def __init__(self, limits: Limits, ramp: float, low_pass: float) -> None:
        self._limits, self._ramp, self._low_pass = limits, ramp, low_pass
        self._smooth = self._fastest = 0.0

    def drop(self) -> None:
        """Forget the input, and what the low-pass remembers of it."""
        self._smooth = 0.0

    def setpoint(self, deflection: float, share: float, state: State, seconds: float) -> VelocityTarget | None:
        """What is asked of the axis, `seconds` after the last time; None once it rests and nothing is asked.

        `deflection` is -1..1, `share` what full deflection is of the axis's velocity, `state` what it is commanded now.
        """
        weight = 1.0 if self._low_pass == 0 else -math.expm1(-seconds / self._low_pass)
        self._smooth += weight * (deflection - self._smooth)
        if deflection == 0 and abs(self._smooth) < NOTHING:
            self._smooth = 0.0
        full = share * self._limits.velocity
        rests = state.velocity == 0 and state.acceleration == 0
        self._fastest = max(0.0 if rests else self._fastest, full, abs(state.velocity))
        if rests and self._smooth == 0:
            return None
        return VelocityTarget(self._smooth * full, *self._gentle())

    def _gentle(self) -> tuple[float | None, float | None]:
        if self._ramp == 0:
            return None, None
        acceleration = LEVEL * self._fastest / self._ramp
        jerk = acceleration / (self._ramp * (1 - 1 / LEVEL))
        return min(acceleration, self._limits.acceleration), min(jerk, self._limits.jerk)

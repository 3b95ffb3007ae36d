"""How one axis of a simulated gimbal moves and reports: what `teleop sim` and a profile's `simulated` can set."""

from __future__ import annotations

import math
from dataclasses import dataclass


@dataclass(frozen=True)
class Dynamics:
    """The defaults are those of a simulated gimbal without settings.

    A speed or a deflection of the joystick is reached `dead_time` s after it came, through a first-order `lag` (s),
    times `gain`; as long as it is in force the axis also moves by `drift` (deg/s). A position command has the same
    dead time and a lag of its own, `position_lag` (s), 0 by default. It has neither gain nor drift, because a gimbal
    closes its position loop on the angle itself and leaves no error there. What is behind the motor is the same for
    both: a second-order mode of `natural_frequency` (Hz, 0 for none) and `damping` (share of the critical one), as of a
    payload on a soft plate, and `backlash` (deg, from flank to flank).

    Reports are `report_age` s older than their question or push, have `noise` (deg, standard deviation), and come in
    steps of `resolution` (deg); the wire itself has 0.1.
    """

    lag: float = 0.05
    dead_time: float = 0.0
    gain: float = 1.0
    drift: float = 0.0
    position_lag: float = 0.0
    natural_frequency: float = 0.0
    damping: float = 0.3
    backlash: float = 0.0
    resolution: float = 0.1
    report_age: float = 0.0
    noise: float = 0.0

    @property
    def angular_frequency(self) -> float:
        """Of the second-order mode, in rad/s; 0 for none."""
        return 2 * math.pi * self.natural_frequency

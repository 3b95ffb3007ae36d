"""What can be moved: the axes, their limits, where each is commanded to be and where it was measured.

Everything in `axes`, `setpoints` and `events` is immutable and knows no protocol, file or clock, so that each stage of
the pipeline can be tested with values written by hand. Angles are degrees, focus is 0 (near) .. 1 (far), drone sticks
are -1 .. 1; "unit" below is whichever of these the axis has.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum
from typing import NamedTuple


class Axis(StrEnum):
    """What can be moved. pan + is right, tilt + is up, roll + is clockwise seen from behind the camera."""

    PAN = "pan"
    TILT = "tilt"
    ROLL = "roll"
    FOCUS = "focus"
    STICK_ROLL = "stick_roll"
    STICK_PITCH = "stick_pitch"
    STICK_THROTTLE = "stick_throttle"
    STICK_YAW = "stick_yaw"


STICKS = (Axis.STICK_ROLL, Axis.STICK_PITCH, Axis.STICK_THROTTLE, Axis.STICK_YAW)
"""The axes that have a spring: left alone they go to 0, where every other axis stays where it is."""


@dataclass(frozen=True, slots=True)
class Limits:
    """What an axis may do: soft limits in units, then the magnitudes of unit/s, unit/s2 and unit/s3.

    A continuous axis has soft limits of -inf and inf.
    """

    minimum: float
    maximum: float
    velocity: float
    acceleration: float
    jerk: float

    def scaled(self, share: float) -> Limits:
        """The same soft limits with `share` of the velocity, acceleration and jerk: a gentler axis."""
        return Limits(self.minimum, self.maximum, self.velocity * share, self.acceleration * share, self.jerk * share)

    @property
    def continuous(self) -> bool:
        return math.isinf(self.minimum) and math.isinf(self.maximum)


class State(NamedTuple):
    """Where an axis is commanded to be: unit, unit/s, unit/s2."""

    position: float
    velocity: float = 0.0
    acceleration: float = 0.0


Motion = Mapping[Axis, State]


class Reading(NamedTuple):
    """Where an axis was measured to be, in units, and when, on the loop's clock."""

    position: float
    time: float

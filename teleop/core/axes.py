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

    @property
    def is_angle(self) -> bool:
        """Measured in degrees, so that a whole turn leads back to the same place."""
        return self in _ANGLES

    @property
    def is_stick(self) -> bool:
        """A drone's stick: it has a spring, and goes to 0 when released. Every other axis stays where it is."""
        return self in STICKS

    @property
    def unit(self) -> str:
        """The unit of positions, as shown to people: "deg", or "" for shares of the full range."""
        return "deg" if self.is_angle else ""


_ANGLES = (Axis.PAN, Axis.TILT, Axis.ROLL)
STICKS = (Axis.STICK_ROLL, Axis.STICK_PITCH, Axis.STICK_THROTTLE, Axis.STICK_YAW)
"""The axes of a drone's sticks, in the order of the remote controller's channels."""


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


def moves(motion: Motion) -> bool:
    """Whether an axis is commanded to move. A drone's stick is none: its place is its deflection."""
    return any(state.velocity or state.acceleration for axis, state in motion.items() if not axis.is_stick)


class Reading(NamedTuple):
    """Where an axis was measured to be, in units, and when, on the loop's clock."""

    position: float
    time: float

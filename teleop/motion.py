"""The values that flow from a source, through the planner, to a sink.

Everything here is immutable and knows no protocol, file or clock, so that each stage of the pipeline can be tested
with values written by hand. Angles are degrees, focus is 0 (near) .. 1 (far), drone sticks are -1 .. 1; "unit" below
is whichever of these the axis has.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
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


class Cruise(NamedTuple):
    """Move at this velocity (unit/s) until told otherwise, as a stick asks.

    `acceleration` and `jerk` are an operator's gentler limits; None is the axis's own. They never exceed the axis's.
    """

    velocity: float
    acceleration: float | None = None
    jerk: float | None = None


class Goto(NamedTuple):
    """Be at rest at `position`, `arrive` seconds from now or, when None, as soon as the limits allow.

    `velocity` (unit/s) is the most that an axis on its own, without an `arrive`, may go; None is the axis's own.
    """

    position: float
    arrive: float | None = None
    velocity: float | None = None


class Follow(NamedTuple):
    """Be in this state at the next tick, as a compiled move asks."""

    position: float
    velocity: float
    acceleration: float


class Halt(NamedTuple):
    """Come to rest as fast as the axis's own limits allow, and stay; a stick, in its centre."""


Wish = Cruise | Goto | Follow | Halt
Demand = Mapping[Axis, Wish]  # an axis that is absent: no opinion


class Action(StrEnum):
    """Something done once, by whichever sink knows how."""

    RECORD = "record"
    STOP = "stop"
    SHUTTER = "shutter"
    FOCUS = "focus"  # on the centre, until END_FOCUS
    END_FOCUS = "end_focus"


class Told(NamedTuple):
    """A device's own command in plain words, for whichever sink speaks its language: `gimbal follow lock`."""

    words: str


class Dialled(NamedTuple):
    """How fast a dial is turned, -1..1, for a device that has its own use for it; 0 once when it comes to rest."""

    speed: float


class Step(StrEnum):
    """Of taking one frame of a timelapse, in this order."""

    FOCUS = "prefocus"
    PRESS = "press"
    RELEASE = "release"


class Exposure(NamedTuple):
    """A step of taking the frame with this number, counted from 0, for the sink that shoots."""

    frame: int
    step: Step


class Outcome(NamedTuple):
    """What the camera said to the press for a frame: a return code, 0 for done, None for nothing."""

    frame: int
    code: int | None


Act = Action | Told | Dialled | Exposure


@dataclass(frozen=True, slots=True)
class Tick:
    """One turn of the control loop, as every sink and the recorder see it.

    `time` is the loop's clock in seconds, `motion` where each axis in use is commanded to be at that time, `reported`
    the last reading of each axis that has one.
    """

    time: float
    motion: Motion
    demand: Demand
    actions: Sequence[Act]
    reported: Mapping[Axis, Reading]

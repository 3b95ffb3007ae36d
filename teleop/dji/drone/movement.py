"""Command 01 03, movement: four floats, and a byte that says what they are.

The byte combines a horizontal, a vertical and a yaw control; the appendix lists fourteen of the eighteen combinations
("Combinations"), since thrust goes only with tilt angles. Only those are sent, and only within the ranges listed; what
arrives is decoded whatever it says. Vertical is positive up in every mode, although the ground frame's z is down.

What x and y are depends on the horizontal control: OPENProtocol.md 3.1.9, 01 03, calls offset 1 "Roll or X-axis" and
offset 5 "Pitch or Y-axis", and the maker's attitudeControl(roll, pitch) and OSDK-ROS fly it so:

| horizontal control | x | y |
|---|---|---|
| TILT | roll: right is positive, east in the ground frame | pitch: nose UP is positive, so BACKWARD; south |
| VELOCITY, POSITION | forward, or north | right, or east |

Forward by 10 degrees is x = 0, y = -10. (A Chinese comment in the appendix says otherwise; nothing that flies does.)
"""

from __future__ import annotations

from enum import IntEnum
from typing import Annotated, Final, NamedTuple

from teleop.dji.drone.messages import CONTROL
from teleop.dji.fields import Bits, Flag
from teleop.dji.float_fields import F32, Float
from teleop.dji.message import STREAM, FieldError, Message, message


class Horizontal(IntEnum):
    """Bits 7 and 6."""

    TILT = 0
    VELOCITY = 1
    POSITION = 2


class Vertical(IntEnum):
    """Bits 5 and 4."""

    VELOCITY = 0
    POSITION = 1
    THRUST = 2


class Yaw(IntEnum):
    """Bit 3. An angle is against the ground frame always."""

    ANGLE = 0
    RATE = 1


class ReferenceFrame(IntEnum):
    """Bits 2 and 1, of the horizontal control: north and east, or forward and right of the nose."""

    GROUND = 0
    BODY = 1


HORIZONTAL: Final = {
    Horizontal.TILT: F32(unit="deg", low=-30, high=30),
    Horizontal.VELOCITY: F32(unit="m/s", low=-10, high=10),
    Horizontal.POSITION: F32(unit="m"),
}
VERTICAL: Final = {
    Vertical.VELOCITY: F32(unit="m/s", low=-4, high=4),
    Vertical.POSITION: F32(unit="m", low=0),  # up to the height limit, which is set in the drone
    Vertical.THRUST: F32(unit="%", low=10, high=100),
}
YAW: Final = {
    Yaw.ANGLE: F32(unit="deg", low=-180, high=180),
    Yaw.RATE: F32(unit="deg/s", low=-100, high=100),
}


class Combination(NamedTuple):
    """One of the ways to say how the drone should move."""

    horizontal: Horizontal
    vertical: Vertical
    yaw: Yaw

    @property
    def ranges(self) -> dict[str, Float]:
        """What each of a movement's four numbers must be."""
        across = HORIZONTAL[self.horizontal]
        return {"x": across, "y": across, "z": VERTICAL[self.vertical], "yaw": YAW[self.yaw]}


COMBINATIONS: Final = tuple(
    Combination(horizontal, vertical, yaw)
    for vertical in Vertical
    for horizontal in Horizontal
    for yaw in Yaw
    if vertical != Vertical.THRUST or horizontal == Horizontal.TILT
)
"""The appendix's fourteen, in its order: that of CurrentMode 1 to 14."""


@message("drone.move", CONTROL, 0x03, cmd_type=STREAM)
class Move(Message):
    """Move so, in the combination's units; 50 times a second, in F mode, with control obtained.

    x and y are velocities or offsets, forward (north) and right (east); with `horizontal` tilt they are roll (right)
    and pitch (nose up, so backward), in deg.
    """

    stable: Annotated[bool, Flag(first=0)]
    frame: Annotated[int, Bits(first=1, width=2, words=ReferenceFrame)]
    yaw_control: Annotated[int, Bits(first=3, words=Yaw)]
    vertical: Annotated[int, Bits(first=4, width=2, words=Vertical)]
    horizontal: Annotated[int, Bits(first=6, width=2, words=Horizontal)]
    x: Annotated[float, F32()]
    y: Annotated[float, F32()]
    z: Annotated[float, F32()]
    yaw: Annotated[float, F32()]

    @property
    def combination(self) -> Combination | None:
        """Which of the fourteen this is; None for a byte that the appendix does not list."""
        named = (self.horizontal, self.vertical, self.yaw_control)
        return next((each for each in COMBINATIONS if each == named), None)

    def check(self) -> None:
        Message.check(self)
        combination = self.combination
        if combination is None:
            raise FieldError(f"{self.name}: vertical thrust goes only with horizontal tilt")
        for name, wire in combination.ranges.items():
            if not wire.accepts(getattr(self, name)):
                raise FieldError(f"{self.name}: {name} must be {wire.requirement()}, not {getattr(self, name):g}")

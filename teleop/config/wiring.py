"""Which axis each of a gimbal's three angles is, and which way it counts: the one place where words and signs change.

Operators say pan and tilt where the protocol says yaw and pitch. The profile may wire them otherwise: the document's
second joystick mapping (R SDK V2.5, section 2.3.4.11, figure 20) has the stick's X, an operator's pan, turn the roll.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Annotated, Literal

from teleop.config.documents.base_model import NoTruth
from teleop.core.axes import Axis

Angle = Literal["pan", "tilt", "roll"]  # the axes of a gimbal, as files and commands name them
Sign = Annotated[Literal[1, -1], NoTruth]
AngleOrder = Literal["yaw-roll-pitch", "yaw-pitch-roll", "all-yaw-pitch-roll"]  # in replies of old firmware, or in all
STRAIGHT = (Axis.PAN, Axis.ROLL, Axis.TILT)


@dataclass(frozen=True)
class Wiring:
    """`axes` are those of the gimbal's yaw, roll and pitch, None for one that nothing drives; all signs are 1 or -1.

    `signs` are those of the angles in position commands. Those of speeds and of the angles that the gimbal reports are
    the same unless given: some gimbals count them the other way (docs/protocol-facts.md, "Signs").

    `mount` is the yaw in deg that the gimbal reports where the operator's angle is 0. The protocol's angles are within
    half a turn of that, so their seam lies behind.
    """

    axes: Sequence[Axis | None] = STRAIGHT
    signs: Mapping[Axis, int] = field(default_factory=dict)
    speed_signs: Mapping[Axis, int] = field(default_factory=dict)
    report_signs: Mapping[Axis, int] = field(default_factory=dict)
    mount: float = 0.0

    def to_gimbal(self, angles: Mapping[Axis, float]) -> tuple[float, float, float]:
        """Yaw, roll and pitch for angles by axis; 0 for one that is not among them."""
        yaw, roll, pitch = self._ordered({axis: self.sign(axis) * angle for axis, angle in angles.items()})
        return half_turn(yaw + self.commanded_mount) if self.axes[0] in angles else yaw, roll, pitch

    def speeds_to_gimbal(self, speeds: Mapping[Axis, float]) -> tuple[float, float, float]:
        """The same for speeds, or the deflections of a joystick."""
        return self._ordered({axis: self.speed_sign(axis) * speed for axis, speed in speeds.items()})

    def from_gimbal(self, yaw: float, roll: float, pitch: float) -> dict[Axis, float]:
        """The angles that the gimbal reports, by axis."""
        angles = zip(self.axes, (half_turn(yaw - self.mount), roll, pitch), strict=True)
        return {axis: self.report_sign(axis) * angle for axis, angle in angles if axis is not None}

    def undriven(self, values: Mapping[Axis, float]) -> tuple[bool, bool, bool]:
        """Whether yaw, roll and pitch are without a value."""
        yaw, roll, pitch = (axis not in values for axis in self.axes)
        return yaw, roll, pitch

    @property
    def commanded_mount(self) -> float:
        """`mount` as position commands count it."""
        yaw = self.axes[0]
        return self.mount if yaw is None else self.sign(yaw) * self.report_sign(yaw) * self.mount

    def sign(self, axis: Axis) -> int:
        return self.signs.get(axis, 1)

    def speed_sign(self, axis: Axis) -> int:
        return self.speed_signs.get(axis, self.sign(axis))

    def report_sign(self, axis: Axis) -> int:
        return self.report_signs.get(axis, self.sign(axis))

    def _ordered(self, values: Mapping[Axis, float]) -> tuple[float, float, float]:
        yaw, roll, pitch = (0.0 if axis is None else values.get(axis, 0.0) for axis in self.axes)
        return yaw, roll, pitch


def half_turn(angle: float) -> float:
    """The same direction within -180..180 deg; -180 and 180 stay apart."""
    return angle if -180 <= angle <= 180 else angle - 360 * round(angle / 360)

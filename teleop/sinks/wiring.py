"""Which axis each of a gimbal's three angles is, and which way it counts: the one place where words and signs change.

Operators say pan and tilt where the protocol says yaw and pitch. The profile may wire them otherwise: the document's
second joystick mapping (R SDK V2.5, section 2.3.4.11, figure 20) has the stick's X, an operator's pan, turn the roll.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from teleop.motion import Axis

STRAIGHT = (Axis.PAN, Axis.ROLL, Axis.TILT)


@dataclass(frozen=True)
class Wiring:
    """`axes` are those of the gimbal's yaw, roll and pitch, None for one that nothing drives; `signs` are 1 or -1."""

    axes: Sequence[Axis | None] = STRAIGHT
    signs: Mapping[Axis, int] = field(default_factory=dict)

    def to_gimbal(self, values: Mapping[Axis, float]) -> tuple[float, float, float]:
        """Yaw, roll and pitch for values by axis; 0 for one that is not among them."""
        yaw, roll, pitch = (0.0 if axis is None else self._sign(axis) * values.get(axis, 0.0) for axis in self.axes)
        return yaw, roll, pitch

    def from_gimbal(self, yaw: float, roll: float, pitch: float) -> dict[Axis, float]:
        angles = zip(self.axes, (yaw, roll, pitch), strict=True)
        return {axis: self._sign(axis) * angle for axis, angle in angles if axis is not None}

    def undriven(self, values: Mapping[Axis, float]) -> tuple[bool, bool, bool]:
        """Whether yaw, roll and pitch are without a value."""
        yaw, roll, pitch = (axis not in values for axis in self.axes)
        return yaw, roll, pitch

    def _sign(self, axis: Axis) -> int:
        return self.signs.get(axis, 1)

"""What the modes of a flight section are in the drone's own terms. Only a file that has one loads this."""

from __future__ import annotations

from collections.abc import Mapping

from teleop.dji.drone.movement import COMBINATIONS, Combination, Horizontal, ReferenceFrame, Vertical, Yaw

FLIGHT_MODES: Mapping[str, tuple[Horizontal, ReferenceFrame]] = {
    "velocity-body": (Horizontal.VELOCITY, ReferenceFrame.BODY),
    "velocity-ground": (Horizontal.VELOCITY, ReferenceFrame.GROUND),
    "tilt": (Horizontal.TILT, ReferenceFrame.BODY),
    "tilt-ground": (Horizontal.TILT, ReferenceFrame.GROUND),
    "offset-body": (Horizontal.POSITION, ReferenceFrame.BODY),
    "offset-ground": (Horizontal.POSITION, ReferenceFrame.GROUND),
}
"""What the horizontal sticks are; offsets are for sequences."""


def combination_of(mode: str, vertical: str, yaw: str) -> Combination:
    """The control mode of a flight section with these keys; raises ValueError for one that the drone lacks."""
    up = Vertical.VELOCITY if vertical == "velocity" else Vertical.POSITION
    made = Combination(FLIGHT_MODES[mode][0], up, Yaw.RATE if yaw == "rate" else Yaw.ANGLE)
    if made not in COMBINATIONS:
        raise ValueError(f"the drone has no mode {made}")
    return made

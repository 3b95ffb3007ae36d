"""What flies a simulated drone, and what that says: sticks and switches, as the drone itself knows them."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum, auto

CORNER = 0.95  # of full deflection


class Switch(Enum):
    """A mode switch."""

    P = auto()  # positions held by GPS
    A = auto()  # attitude
    F = auto()  # as P, and onboard computers may have control


class Pilot(Enum):
    RC = "rc"
    VIRTUAL = "virtual rc"
    ONBOARD = "onboard"
    NOBODY = "rc lost"


class Status(Enum):
    STANDBY = 1
    TAKE_OFF = 2
    IN_AIR = 3
    LANDING = 4
    FINISH_LANDING = 5


class TaskState(Enum):
    """Of a take-off, a landing or a return home."""

    NONE = auto()
    RUNNING = auto()
    FAILED = auto()  # something else ended it
    SUCCEEDED = auto()


@dataclass(frozen=True)
class Controls:
    """What a remote control says: sticks -1..1 (right, up, up, right), and its switches."""

    roll: float = 0.0
    pitch: float = 0.0
    throttle: float = 0.0
    yaw: float = 0.0
    switch: Switch = Switch.P
    gear_up: bool = False

    @property
    def in_corners(self) -> bool:
        """Both sticks down and apart, or down and together: what starts and stops the motors."""
        down = self.pitch < -CORNER and self.throttle < -CORNER
        return down and abs(self.roll) > CORNER and abs(self.yaw) > CORNER and self.roll * self.yaw < 0

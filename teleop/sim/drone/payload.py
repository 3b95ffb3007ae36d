"""The gimbal and the camera that hang under a simulated drone.

Ranges are those of OPENProtocol.md 3.1.9, 01 1A and 01 1B. In its follow mode the yaw that is commanded counts from the
drone's nose and the broadcast has it from north; roll and pitch are against the ground. How long a speed is obeyed is
not documented: the maker's samples send one every 100 ms.
"""

from __future__ import annotations

import math
from typing import Final

from teleop.dji.drone import messages as drone
from teleop.dji.drone.broadcast_parts import Gimbal
from teleop.sim.gimbal.motors import Motor

SPEED_HOLDS: Final = 0.5  # s: assumed to be that of the handheld gimbals
LAG: Final = 0.05  # s: time constant of a speed
RANGES: Final = {"yaw": (-320.0, 320.0), "roll": (-35.0, 35.0), "pitch": (-90.0, 30.0)}  # deg


class Payload:
    """`photos` are counted, `recording` is whether a video is being recorded."""

    def __init__(self) -> None:
        self.photos = 0
        self.recording = False
        self._motors = {axis: Motor(0.0, LAG, low, high) for axis, (low, high) in RANGES.items()}

    def turn(self, message: drone.GimbalSpeed, now: float) -> None:
        """Take up speeds in deg/s; without the control bit, come to rest."""
        for axis, motor in self._motors.items():
            motor.cruise(now, getattr(message, axis) if message.control else 0.0, now + SPEED_HOLDS)

    def point(self, message: drone.GimbalAngle, now: float) -> None:
        """Go to angles, or by angles, each axis at constant speed in the message's time."""
        for axis, motor in self._motors.items():
            if not getattr(message, f"{axis}_ignored"):
                start = 0.0 if message.absolute else motor.at(now)[0]
                motor.travel(now, start + getattr(message, axis), message.duration)

    def outside(self, message: drone.GimbalAngle) -> str:
        """What of a message is beyond the documented ranges, in words; nothing of one that counts from here."""
        for axis, (low, high) in RANGES.items():
            angle, ignored = getattr(message, axis), getattr(message, f"{axis}_ignored")
            if message.absolute and not ignored and not low <= angle <= high:
                return f"{axis} must be {low:g}..{high:g} deg, not {angle:g}"
        return ""

    def reported(self, now: float, heading: float) -> Gimbal:
        """As broadcast, under a drone with its nose to `heading` (rad)."""
        at = {axis: motor.at(now)[0] for axis, motor in self._motors.items()}
        limited = {axis: at[axis] in RANGES[axis] for axis in RANGES}
        yaw = math.degrees(math.remainder(heading + math.radians(at["yaw"]), math.tau))
        return Gimbal(at["roll"], at["pitch"], yaw, limited["pitch"], limited["roll"], limited["yaw"])

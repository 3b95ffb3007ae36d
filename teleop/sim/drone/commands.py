"""What the two ways to fly a drone say, in terms of its flight: channels of the virtual RC, and movement commands."""

from __future__ import annotations

import math

from teleop.dji.drone.enums import GearChannel, ModeChannel
from teleop.dji.drone.movement import Horizontal, Move, ReferenceFrame, Vertical, Yaw
from teleop.dji.drone.virtual_rc import CENTER, DEFLECTION, Sticks
from teleop.sim.drone.controls import Controls, Switch
from teleop.sim.drone.flight import Flight

SWITCHES = {ModeChannel.P: Switch.P, ModeChannel.A: Switch.A, ModeChannel.F: Switch.F}
GEARS = {GearChannel.UP: True, GearChannel.DOWN: False}
STICKS = "roll", "pitch", "throttle", "yaw"
HOVER = 50.0  # % of thrust that neither climbs nor sinks


def out_of_range(sticks: Sticks) -> str:
    """Which of the four sticks is beyond its range, in words."""
    for name in STICKS:
        if abs(getattr(sticks, name) - CENTER) > DEFLECTION:
            return f"{name} must be {CENTER - DEFLECTION}..{CENTER + DEFLECTION}, not {getattr(sticks, name)}"
    return ""


def controls(sticks: Sticks, before: Controls) -> Controls:
    """What the channels of the virtual RC say after those `before`: a switch with an unknown value stays as it was."""
    roll, pitch, throttle, yaw = ((getattr(sticks, name) - CENTER) / DEFLECTION for name in STICKS)
    mode, gear = SWITCHES.get(sticks.mode, before.switch), GEARS.get(sticks.gear, before.gear_up)  # type: ignore[call-overload]
    return Controls(roll, pitch, throttle, yaw, mode, gear)


def move(flight: Flight, message: Move) -> None:
    """What a movement command makes the drone do; vertical is positive up.

    Tilt: x is roll, right positive, and y is pitch, nose up positive, so backward; in the ground frame positive roll
    goes east and positive pitch south (OPENProtocol.md 3.1.9, 01 03, offsets 1 and 5; docs/protocol-facts.md).
    Velocity and position: x is forward or north, y is right or east.
    """
    to_north = message.frame == ReferenceFrame.GROUND
    if message.yaw_control == Yaw.RATE:
        flight.turn(math.radians(message.yaw))
    else:
        flight.face(math.radians(message.yaw))
    match message.horizontal:
        case Horizontal.TILT:
            flight.lean(-math.radians(message.y), math.radians(message.x), to_north=to_north)
        case Horizontal.VELOCITY:
            flight.fly(complex(message.x, message.y), to_north=to_north)
        case _:
            flight.seek(complex(message.x, message.y), to_north=to_north)
    match message.vertical:
        case Vertical.VELOCITY:
            flight.climb(message.z)
        case Vertical.POSITION:
            flight.rise_to(message.z)
        case _:
            flight.climb((message.z - HOVER) / 50 * 4)

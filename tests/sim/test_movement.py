"""Which way the simulated drone goes for each of the appendix's combinations, from bytes built by hand.

Sources: the control mode byte and its ranges are osdk-appendix.md "Combinations". In tilt modes the first number is
roll (right positive) and the second pitch (nose up positive, so backward): OPENProtocol.md 3.1.9, 01 03, offsets 1
and 5 ("Roll or X-axis", "Pitch or Y-axis"), and the maker's sample attitudeControl(roll, pitch), which waits for the
broadcast's roll and pitch. Velocity and position: x is forward or north, y is right or east.
"""

from __future__ import annotations

import math
import struct

import pytest
from raw_frames import raw_frame

from teleop.sim.drone.device import SimulatedDrone

NOSE = 90.0  # deg: the nose points east, so that forward is east and right is south
TILT, VELOCITY, POSITION = 0 << 6, 1 << 6, 2 << 6
VERTICAL = {"velocity": (0 << 4, 0.0), "position": (1 << 4, 50.0), "thrust": (2 << 4, 50.0)}  # hovers with these
YAW = {"angle": (0 << 3, NOSE), "rate": (1 << 3, 0.0)}
GROUND, BODY, STABLE = 0 << 1, 1 << 1, 1
WAYS = [  # horizontal, frame, first number, second number, the way it goes
    (TILT, BODY, 0.0, -10.0, "east"),  # nose down: forward
    (TILT, BODY, 0.0, 10.0, "west"),
    (TILT, BODY, 10.0, 0.0, "south"),  # right
    (TILT, BODY, -10.0, 0.0, "north"),
    (TILT, GROUND, 10.0, 0.0, "east"),
    (TILT, GROUND, -10.0, 0.0, "west"),
    (TILT, GROUND, 0.0, 10.0, "south"),
    (TILT, GROUND, 0.0, -10.0, "north"),
    (VELOCITY, BODY, 3.0, 0.0, "east"),
    (VELOCITY, BODY, 0.0, 3.0, "south"),
    (VELOCITY, GROUND, 3.0, 0.0, "north"),
    (VELOCITY, GROUND, 0.0, 3.0, "east"),
    (POSITION, BODY, 4.0, 0.0, "east"),
    (POSITION, BODY, 0.0, 4.0, "south"),
    (POSITION, GROUND, 4.0, 0.0, "north"),
    (POSITION, GROUND, 0.0, 4.0, "east"),
]
COMBINATIONS = [
    (*way, vertical, yaw)
    for vertical in VERTICAL
    for yaw in YAW
    for way in WAYS
    if vertical != "thrust" or way[0] == TILT
]


def flying() -> SimulatedDrone:
    """At 50 m, its nose to the east, controlled by the onboard computer."""
    drone = SimulatedDrone(yaw=NOSE)
    drone.autopilot.flight.hover(50.0)
    drone.receive(raw_frame(b"\x00\x01" + struct.pack("<III32s", 1, 2, 0x03010A00, b"9" * 32), 2, 1), 0.0)
    for sequence in (2, 3):
        drone.receive(raw_frame(b"\x01\x00\x01", 2, sequence), 0.0)
    drone.advance(0.0)
    assert drone.autopilot.obtained
    return drone


def bearing(drone: SimulatedDrone) -> str:
    pose = drone.autopilot.pose
    assert math.hypot(pose.north, pose.east) > 0.5
    assert min(abs(pose.north), abs(pose.east)) < 0.01
    if abs(pose.north) > abs(pose.east):
        return "north" if pose.north > 0 else "south"
    return "east" if pose.east > 0 else "west"


@pytest.mark.parametrize(("horizontal", "frame", "first", "second", "way", "vertical", "yaw"), COMBINATIONS)
def test_every_combination_moves_it_the_documented_way(
    horizontal: int, frame: int, first: float, second: float, way: str, vertical: str, yaw: str
) -> None:
    drone = flying()
    (vertical_bits, z), (yaw_bits, w) = VERTICAL[vertical], YAW[yaw]
    mode = horizontal | vertical_bits | yaw_bits | frame | STABLE
    for step in range(100):
        drone.receive(raw_frame(b"\x01\x03" + struct.pack("<Bffff", mode, first, second, z, w), 0, step), step / 50)
    drone.advance(2.0)
    assert bearing(drone) == way
    pose = drone.autopilot.pose
    assert pose.height == pytest.approx(50.0, abs=0.01)
    if horizontal == TILT:  # what the maker's sample attitudeControl waits for in the broadcast
        roll, pitch = (first, second) if frame == BODY else (second, -first)  # the nose points east
        assert math.degrees(pose.roll) == pytest.approx(roll, abs=0.01)
        assert math.degrees(pose.pitch) == pytest.approx(pitch, abs=0.01)


@pytest.mark.parametrize("vertical", [1.0, -1.0])
def test_the_broadcast_has_a_climb_as_positive(vertical: float) -> None:
    """NEU: takeoffConverged of the 3.1.9 sample waits for v.z > 0.25; OSDK-ROS issue 25."""
    drone, stream = flying(), b""
    for step in range(200):
        drone.receive(raw_frame(b"\x01\x03" + struct.pack("<Bffff", 0x4B, 0, 0, vertical, 0), 0, step), step / 50)
        stream = drone.advance(step / 50)
    at = stream.find(b"\xaa")
    flags, body = struct.unpack_from("<H", stream, at + 14)[0], stream[at + 16 :]
    assert flags & 0xF == 0xF, "time, quaternion, acceleration and velocity come first"
    north, east, up = struct.unpack_from("<3f", body, 9 + 16 + 12)
    assert (north, east) == (pytest.approx(0), pytest.approx(0))
    assert up == pytest.approx(vertical, abs=0.02)

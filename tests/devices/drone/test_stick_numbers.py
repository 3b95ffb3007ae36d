"""Sticks to numbers to the way that the simulated drone goes, for every combination and both frames, its nose turned.

Sources: osdk-appendix.md, Combinations, for the modes and units; OPENProtocol.md 3.1.9, 01 03, offsets 1 ("Roll or
X-axis") and 5 ("Pitch or Y-axis") for what the numbers are. The drone looks east, so that forward is not north.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import pytest

from teleop.core.axes import STICKS, Axis
from teleop.devices.drone.stick_numbers import numbers
from teleop.dji.drone.movement import COMBINATIONS, Combination, Horizontal, Move, ReferenceFrame, Vertical, Yaw
from teleop.sim.drone.commands import move
from teleop.sim.drone.flight import Flight

ROLL, PITCH, THROTTLE, YAW = STICKS
EAST = 90.0  # deg: where the nose points
HEIGHT = 30.0  # m
FULL = {"horizontal": 10.0, "vertical": 2.0, "yaw": 60.0}
STICK_MODES = [each for each in COMBINATIONS if each.vertical is not Vertical.THRUST]


class Way(NamedTuple):
    """A stick, its x and y in each kind of mode, and where the drone goes in each frame."""

    stick: Axis
    deflection: float
    tilt: tuple[float, float]
    place: tuple[float, float]  # velocities and offsets
    body: str
    ground: str


WAYS = [
    Way(PITCH, 1.0, (0, -10), (10, 0), body="east", ground="north"),  # forward
    Way(PITCH, -1.0, (0, 10), (-10, 0), body="west", ground="south"),
    Way(ROLL, 1.0, (10, 0), (0, 10), body="south", ground="east"),  # right
    Way(ROLL, -1.0, (-10, 0), (0, -10), body="north", ground="west"),
]


def sticks(axis: Axis, deflection: float) -> dict[Axis, float]:
    return {**dict.fromkeys(STICKS, 0.0), axis: deflection}


def flown(combination: Combination, frame: ReferenceFrame, held: dict[Axis, float], seconds: float = 1.0) -> Flight:
    """A flight at 30 m, nose to the east, after these sticks."""
    flight = Flight(0.0, math.radians(EAST))
    flight.hover(HEIGHT)
    x, y, z, yaw = numbers(combination, FULL, held, EAST, HEIGHT)
    message = Move(True, frame, combination.yaw, combination.vertical, combination.horizontal, x, y, z, yaw)
    message.check()
    move(flight, message)
    flight.pass_to(seconds)
    return flight


def bearing(flight: Flight) -> str:
    pose = flight.pose()
    assert min(abs(pose.north), abs(pose.east)) < 0.01 < max(abs(pose.north), abs(pose.east))
    if abs(pose.north) > abs(pose.east):
        return "north" if pose.north > 0 else "south"
    return "east" if pose.east > 0 else "west"


@pytest.mark.parametrize("way", WAYS, ids=lambda way: f"{way.stick}{way.deflection:+g}")
@pytest.mark.parametrize("frame", ReferenceFrame)
@pytest.mark.parametrize("combination", STICK_MODES, ids=lambda each: "-".join(part.name for part in each))
def test_across(combination: Combination, frame: ReferenceFrame, way: Way) -> None:
    held = sticks(way.stick, way.deflection)
    made = numbers(combination, FULL, held, EAST, HEIGHT)
    assert (made.x, made.y) == (way.tilt if combination.horizontal is Horizontal.TILT else way.place)
    flight = flown(combination, frame, held)
    assert bearing(flight) == (way.body if frame is ReferenceFrame.BODY else way.ground)
    assert flight.pose().height == pytest.approx(HEIGHT)
    assert math.degrees(flight.pose().yaw) == pytest.approx(EAST)


@pytest.mark.parametrize(("deflection", "sense"), [(1.0, 1), (-1.0, -1)])
@pytest.mark.parametrize("frame", ReferenceFrame)
@pytest.mark.parametrize("combination", STICK_MODES, ids=lambda each: "-".join(part.name for part in each))
def test_up_and_around(combination: Combination, frame: ReferenceFrame, deflection: float, sense: int) -> None:
    held = sticks(THROTTLE, deflection)
    rises = combination.vertical is Vertical.VELOCITY
    assert numbers(combination, FULL, held, EAST, HEIGHT).z == (2 * sense if rises else HEIGHT + 2 * sense)
    assert math.copysign(1, flown(combination, frame, held).pose().climb) == sense
    held = sticks(YAW, deflection)
    turns = combination.yaw is Yaw.RATE
    assert numbers(combination, FULL, held, EAST, HEIGHT).yaw == (60 * sense if turns else EAST + 60 * sense)
    assert math.degrees(flown(combination, frame, held).pose().yaw) == pytest.approx(EAST + 60 * sense, abs=0.5)


def test_forward_by_ten_degrees() -> None:
    tilt = Combination(Horizontal.TILT, Vertical.VELOCITY, Yaw.RATE)
    assert numbers(tilt, FULL, sticks(PITCH, 1.0), 0.0, 0.0) == (0, -10, 0, 0)
    pose = flown(tilt, ReferenceFrame.BODY, sticks(PITCH, 1.0)).pose()
    assert math.degrees(pose.pitch) == pytest.approx(-10), "nose down"


@pytest.mark.parametrize("heading", [170.0, -170.0])
def test_a_heading_goes_the_shorter_way_over_south(heading: float) -> None:
    turn = Combination(Horizontal.VELOCITY, Vertical.VELOCITY, Yaw.ANGLE)
    deflection = math.copysign(0.5, heading)
    assert numbers(turn, FULL, sticks(YAW, deflection), heading, 0.0).yaw == pytest.approx(-math.copysign(160, heading))


def test_thrust_has_no_stick() -> None:
    for combination in COMBINATIONS:
        if combination.vertical is Vertical.THRUST:
            with pytest.raises(ValueError, match="no neutral"):
                numbers(combination, FULL, sticks(PITCH, 0.0), 0.0, 0.0)

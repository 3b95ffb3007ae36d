"""What channels and movement commands make a simulated drone do: docs/protocol-facts.md, 05 01 and 01 03."""

from __future__ import annotations

import math

import pytest

from teleop.dji.drone.movement import Horizontal, Move, ReferenceFrame, Vertical, Yaw
from teleop.dji.drone.virtual_rc import Sticks
from teleop.sim.drone.commands import controls, move, out_of_range
from teleop.sim.drone.controls import Controls, Switch
from teleop.sim.drone.flight import Flight, Pose

EAST = math.radians(90)


def flown(horizontal: Horizontal, x: float, y: float, frame: ReferenceFrame, seconds: float = 2.0) -> Pose:
    """Where a drone with its nose to the east is some seconds after such a command, from 0, 0 and 20 m."""
    flight = Flight(0.0, EAST)
    flight.hover(20.0)
    move(flight, Move(False, frame, Yaw.RATE, Vertical.VELOCITY, horizontal, x, y, 0, 0))
    flight.pass_to(seconds)
    return flight.pose()


def vertical(how: Vertical, z: float) -> Pose:
    flight = Flight(0.0)
    flight.hover(20.0)
    move(flight, Move(False, ReferenceFrame.BODY, Yaw.RATE, how, Horizontal.TILT, 0, 0, z, 0))
    flight.pass_to(30.0)
    return flight.pose()


def test_forward_by_10_degrees_of_tilt_is_a_negative_pitch() -> None:
    pose = flown(Horizontal.TILT, 0, -10, ReferenceFrame.BODY)
    assert math.degrees(pose.pitch) == pytest.approx(-10)
    assert pose.east > 1
    assert pose.north == pytest.approx(0, abs=1e-6)


def test_over_the_ground_positive_roll_goes_east_and_positive_pitch_south() -> None:
    assert flown(Horizontal.TILT, 10, 0, ReferenceFrame.GROUND).east > 1
    assert flown(Horizontal.TILT, 0, 10, ReferenceFrame.GROUND).north < -1


@pytest.mark.parametrize("horizontal", [Horizontal.VELOCITY, Horizontal.POSITION])
def test_velocities_and_offsets_are_forward_and_right_or_north_and_east(horizontal: Horizontal) -> None:
    body = flown(horizontal, 3, 0, ReferenceFrame.BODY)
    assert (body.east > 1, body.north) == (True, pytest.approx(0, abs=1e-6))
    body = flown(horizontal, 0, 3, ReferenceFrame.BODY)
    assert (body.north < -1, body.east) == (True, pytest.approx(0, abs=1e-6)), "right of east is south"
    ground = flown(horizontal, 3, 0, ReferenceFrame.GROUND)
    assert (ground.north > 1, ground.east) == (True, pytest.approx(0, abs=1e-6))


def test_an_offset_is_reached_and_a_velocity_is_held() -> None:
    assert flown(Horizontal.POSITION, 3, 0, ReferenceFrame.GROUND, 60).north == pytest.approx(3, abs=0.01)
    assert flown(Horizontal.VELOCITY, 3, 0, ReferenceFrame.GROUND, 60).velocity_north == pytest.approx(3)


def test_vertical_is_up_and_half_the_thrust_hovers() -> None:
    assert vertical(Vertical.VELOCITY, 2).climb == pytest.approx(2)
    assert vertical(Vertical.POSITION, 15).height == pytest.approx(15, abs=0.01)
    assert vertical(Vertical.THRUST, 50).height == pytest.approx(20)
    assert vertical(Vertical.THRUST, 75).climb > 0


@pytest.mark.parametrize(("how", "degrees"), [(Yaw.RATE, 0.0), (Yaw.ANGLE, 30.0)])
def test_yaw_is_a_rate_or_a_heading_in_degrees(how: Yaw, degrees: float) -> None:
    flight = Flight(0.0)
    flight.hover(20.0)
    move(flight, Move(False, ReferenceFrame.BODY, how, Vertical.VELOCITY, Horizontal.VELOCITY, 0, 0, 0, 30))
    flight.pass_to(12.0)
    assert math.degrees(flight.pose().yaw) == pytest.approx(degrees, abs=1e-6)


def test_channels_are_shares_of_660_and_switches_by_their_values() -> None:
    sticks = Sticks(roll=1684, pitch=364, throttle=1024, yaw=1354, gear=1684, mode=496)
    assert controls(sticks, Controls()) == Controls(1.0, -1.0, 0.0, 0.5, Switch.F, True)


def test_an_unknown_switch_value_is_no_change() -> None:
    before = Controls(switch=Switch.A, gear_up=True)
    assert controls(Sticks(gear=1024, mode=0), before) == before


def test_only_the_four_sticks_have_a_range() -> None:
    assert out_of_range(Sticks(throttle=1684, yaw=364, go_home=0, channel_7=9999)) == ""
    assert out_of_range(Sticks(throttle=1685)) == "throttle must be 364..1684, not 1685"

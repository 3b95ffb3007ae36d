"""Who flies a simulated drone: the rules of virtual RC, of control, of the pilot's switch, and the hazards."""

from __future__ import annotations

import pytest

from teleop.sim.drone.autopilot import Autopilot
from teleop.sim.drone.controls import Controls, Pilot, Status, Switch

CORNERS = Controls(-1, -1, -1, 1)


def fly_up(autopilot: Autopilot, height: float = 10.0) -> None:
    """By the RC in hand, and standing still again."""
    autopilot.flight.start_motors()
    autopilot.flight.rise_to(height)
    autopilot.pass_to(autopilot.time + 60)
    autopilot.flight.climb(0.0)


def stick(autopilot: Autopilot, controls: Controls, seconds: float) -> None:
    """The same sticks 20 times a second."""
    end = autopilot.time + seconds
    while autopilot.time < end - 1e-9:
        autopilot.virtual_sticks(controls)
        autopilot.pass_to(min(end, autopilot.time + 0.05))


def test_virtual_rc_flies_it_and_ends_a_second_after_the_last_stick() -> None:
    autopilot = Autopilot(0.0)
    fly_up(autopilot)
    autopilot.enable_virtual(back_to_rc=True)
    stick(autopilot, Controls(pitch=0.5), 3.0)
    assert autopilot.pilot is Pilot.VIRTUAL
    last = autopilot.time - 0.05
    autopilot.pass_to(last + 0.999)
    assert autopilot.pose.velocity_north == pytest.approx(5, abs=0.05), "it goes on with what it heard last"
    assert autopilot.virtual_on
    autopilot.pass_to(last + 1.001)
    assert autopilot.pilot is Pilot.RC
    autopilot.pass_to(last + 5)
    assert autopilot.pose.velocity_north == pytest.approx(0, abs=0.01), "the RC in hand is centred"


def test_without_the_way_back_it_behaves_as_without_rc() -> None:
    autopilot = Autopilot(0.0)
    fly_up(autopilot)
    autopilot.enable_virtual(back_to_rc=False)
    stick(autopilot, Controls(pitch=0.5), 4.0)
    autopilot.pass_to(autopilot.time + 2)
    assert autopilot.pilot is Pilot.NOBODY
    autopilot.pass_to(autopilot.time + 60)
    assert autopilot.status is Status.STANDBY
    assert abs(complex(autopilot.pose.north, autopilot.pose.east)) < 0.5, "it went home and landed"


def test_a_second_enable_within_two_seconds_locks_it_for_good() -> None:
    autopilot = Autopilot(0.0)
    fly_up(autopilot)
    autopilot.enable_virtual(back_to_rc=True)
    stick(autopilot, Controls(), 1.9)
    autopilot.enable_virtual(back_to_rc=True)
    assert autopilot.locked
    autopilot.disable_virtual(back_to_rc=True)
    autopilot.turn_switch(Switch.P)
    autopilot.pass_to(autopilot.time + 10)
    assert autopilot.pilot is Pilot.VIRTUAL, "neither a disable nor the RC ends it"


def test_enables_that_are_far_enough_apart_do_no_harm() -> None:
    autopilot = Autopilot(0.0)
    autopilot.enable_virtual(back_to_rc=True)
    autopilot.pass_to(2.0)
    autopilot.enable_virtual(back_to_rc=True)
    assert not autopilot.locked


def test_the_pilot_takes_it_back_by_leaving_f() -> None:
    autopilot = Autopilot(0.0)
    fly_up(autopilot)
    autopilot.enable_virtual(back_to_rc=False)
    autopilot.obtain()
    autopilot.turn_switch(Switch.P)
    assert (autopilot.pilot, autopilot.virtual_on, autopilot.obtained, autopilot.control_lost) == (
        Pilot.RC,
        False,
        False,
        1,
    )
    autopilot.pass_to(autopilot.time + 3)
    autopilot.enable_virtual(back_to_rc=True)
    assert not autopilot.virtual_on
    assert not autopilot.obtain()


def test_sticks_in_the_corners_start_the_motors_on_the_ground_and_cut_them_in_the_air() -> None:
    autopilot = Autopilot(0.0)
    autopilot.enable_virtual(back_to_rc=True)
    stick(autopilot, CORNERS, 0.9)
    assert not autopilot.flight.motors, "not at once"
    stick(autopilot, CORNERS, 0.2)
    assert autopilot.flight.motors
    assert autopilot.status is Status.STANDBY
    stick(autopilot, Controls(throttle=0.5), 4.0)
    assert autopilot.status is Status.IN_AIR
    stick(autopilot, CORNERS, 5.0)
    assert autopilot.flight.crashed


def test_the_gesture_takes_its_second_in_one_piece() -> None:
    autopilot = Autopilot(0.0)
    autopilot.enable_virtual(back_to_rc=True)
    for _ in range(4):
        stick(autopilot, CORNERS, 0.8)
        stick(autopilot, Controls(), 0.1)
    assert not autopilot.flight.motors


def test_taking_off_and_landing_by_itself() -> None:
    autopilot = Autopilot(0.0)
    autopilot.take_off()
    assert autopilot.status is Status.TAKE_OFF
    autopilot.pass_to(15)
    assert autopilot.status is Status.IN_AIR
    assert autopilot.pose.height == pytest.approx(1.2, abs=0.01)
    autopilot.land()
    assert autopilot.status is Status.LANDING
    autopilot.pass_to(17)
    assert autopilot.status is Status.FINISH_LANDING
    autopilot.pass_to(20)
    assert autopilot.status is Status.STANDBY
    assert not autopilot.flight.motors


def test_a_movement_is_obeyed_for_half_a_second() -> None:
    autopilot = Autopilot(0.0)
    fly_up(autopilot)
    autopilot.moves(lambda flight: flight.fly(5 + 0j))
    autopilot.pass_to(autopilot.time + 0.4)
    assert autopilot.pose.velocity_north == 0, "nobody gave it control"
    autopilot.obtain()
    autopilot.moves(lambda flight: flight.fly(5 + 0j))
    autopilot.pass_to(autopilot.time + 0.5)
    assert autopilot.pose.velocity_north > 2
    autopilot.pass_to(autopilot.time + 5)
    assert autopilot.pose.velocity_north == pytest.approx(0, abs=0.01)


def test_the_battery_drains_faster_in_the_air() -> None:
    autopilot = Autopilot(0.0)
    autopilot.pass_to(60)
    assert autopilot.battery == 100
    fly_up(autopilot)
    assert 90 < autopilot.battery < 95


def test_looking_often_makes_no_difference() -> None:
    once, often = Autopilot(0.0), Autopilot(0.0)
    for autopilot in (once, often):
        fly_up(autopilot)
        autopilot.enable_virtual(back_to_rc=False)
        autopilot.virtual_sticks(Controls(pitch=1, yaw=0.3, throttle=0.2))
    for step in range(3000):
        often.pass_to(60 + step / 50)
    once.pass_to(120)
    often.pass_to(120)
    assert often.pose == pytest.approx(once.pose, abs=1e-6)
    assert (often.status, often.pilot) == (once.status, once.pilot)
    assert often.battery == pytest.approx(once.battery)

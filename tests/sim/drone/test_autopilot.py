"""Who flies a simulated drone: the rules of virtual RC, of control, of the pilot's switch, and the hazards."""

from __future__ import annotations

import pytest

from teleop.sim.drone.autopilot import Autopilot
from teleop.sim.drone.controls import Controls, Pilot, Status, Switch

CORNERS = Controls(-1, -1, -1, 1)


def fly_up(cockpit: Autopilot, height: float = 10.0) -> None:
    """By the RC in hand, and standing still again."""
    cockpit.flight.start_motors()
    cockpit.flight.rise_to(height)
    cockpit.pass_to(cockpit.time + 60)
    cockpit.flight.climb(0.0)


def stick(cockpit: Autopilot, controls: Controls, seconds: float) -> None:
    """The same sticks 20 times a second."""
    end = cockpit.time + seconds
    while cockpit.time < end - 1e-9:
        cockpit.virtual_sticks(controls)
        cockpit.pass_to(min(end, cockpit.time + 0.05))


def test_virtual_rc_flies_it_and_ends_a_second_after_the_last_stick() -> None:
    cockpit = Autopilot(0.0)
    fly_up(cockpit)
    cockpit.enable_virtual(back_to_rc=True)
    stick(cockpit, Controls(pitch=0.5), 3.0)
    assert cockpit.pilot is Pilot.VIRTUAL
    last = cockpit.time - 0.05
    cockpit.pass_to(last + 0.999)
    assert cockpit.pose.velocity_north == pytest.approx(5, abs=0.05), "it goes on with what it heard last"
    assert cockpit.virtual_on
    cockpit.pass_to(last + 1.001)
    assert cockpit.pilot is Pilot.RC
    cockpit.pass_to(last + 5)
    assert cockpit.pose.velocity_north == pytest.approx(0, abs=0.01), "the RC in hand is centred"


def test_without_the_way_back_it_behaves_as_without_rc() -> None:
    cockpit = Autopilot(0.0)
    fly_up(cockpit)
    cockpit.enable_virtual(back_to_rc=False)
    stick(cockpit, Controls(pitch=0.5), 4.0)
    cockpit.pass_to(cockpit.time + 2)
    assert cockpit.pilot is Pilot.NOBODY
    cockpit.pass_to(cockpit.time + 60)
    assert cockpit.status is Status.STANDBY
    assert abs(complex(cockpit.pose.north, cockpit.pose.east)) < 0.5, "it went home and landed"


def test_a_second_enable_within_two_seconds_locks_it_for_good() -> None:
    cockpit = Autopilot(0.0)
    fly_up(cockpit)
    cockpit.enable_virtual(back_to_rc=True)
    stick(cockpit, Controls(), 1.9)
    cockpit.enable_virtual(back_to_rc=True)
    assert cockpit.locked
    cockpit.disable_virtual(back_to_rc=True)
    cockpit.turn_switch(Switch.P)
    cockpit.pass_to(cockpit.time + 10)
    assert cockpit.pilot is Pilot.VIRTUAL, "neither a disable nor the RC ends it"


def test_enables_that_are_far_enough_apart_do_no_harm() -> None:
    cockpit = Autopilot(0.0)
    cockpit.enable_virtual(back_to_rc=True)
    cockpit.pass_to(2.0)
    cockpit.enable_virtual(back_to_rc=True)
    assert not cockpit.locked


def test_the_pilot_takes_it_back_by_leaving_f() -> None:
    cockpit = Autopilot(0.0)
    fly_up(cockpit)
    cockpit.enable_virtual(back_to_rc=False)
    cockpit.obtain()
    cockpit.turn_switch(Switch.P)
    assert (cockpit.pilot, cockpit.virtual_on, cockpit.obtained, cockpit.control_lost) == (Pilot.RC, False, False, 1)
    cockpit.pass_to(cockpit.time + 3)
    cockpit.enable_virtual(back_to_rc=True)
    assert not cockpit.virtual_on
    assert not cockpit.obtain()


def test_sticks_in_the_corners_start_the_motors_on_the_ground_and_cut_them_in_the_air() -> None:
    cockpit = Autopilot(0.0)
    cockpit.enable_virtual(back_to_rc=True)
    stick(cockpit, CORNERS, 0.9)
    assert not cockpit.flight.motors, "not at once"
    stick(cockpit, CORNERS, 0.2)
    assert cockpit.flight.motors
    assert cockpit.status is Status.STANDBY
    stick(cockpit, Controls(throttle=0.5), 4.0)
    assert cockpit.status is Status.IN_AIR
    stick(cockpit, CORNERS, 5.0)
    assert cockpit.flight.crashed


def test_the_gesture_takes_its_second_in_one_piece() -> None:
    cockpit = Autopilot(0.0)
    cockpit.enable_virtual(back_to_rc=True)
    for _ in range(4):
        stick(cockpit, CORNERS, 0.8)
        stick(cockpit, Controls(), 0.1)
    assert not cockpit.flight.motors


def test_taking_off_and_landing_by_itself() -> None:
    cockpit = Autopilot(0.0)
    cockpit.take_off()
    assert cockpit.status is Status.TAKE_OFF
    cockpit.pass_to(15)
    assert cockpit.status is Status.IN_AIR
    assert cockpit.pose.height == pytest.approx(1.2, abs=0.01)
    cockpit.land()
    assert cockpit.status is Status.LANDING
    cockpit.pass_to(17)
    assert cockpit.status is Status.FINISH_LANDING
    cockpit.pass_to(20)
    assert cockpit.status is Status.STANDBY
    assert not cockpit.flight.motors


def test_a_movement_is_obeyed_for_half_a_second() -> None:
    cockpit = Autopilot(0.0)
    fly_up(cockpit)
    cockpit.moves(lambda flight: flight.fly(5 + 0j))
    cockpit.pass_to(cockpit.time + 0.4)
    assert cockpit.pose.velocity_north == 0, "nobody gave it control"
    cockpit.obtain()
    cockpit.moves(lambda flight: flight.fly(5 + 0j))
    cockpit.pass_to(cockpit.time + 0.5)
    assert cockpit.pose.velocity_north > 2
    cockpit.pass_to(cockpit.time + 5)
    assert cockpit.pose.velocity_north == pytest.approx(0, abs=0.01)


def test_the_battery_drains_faster_in_the_air() -> None:
    cockpit = Autopilot(0.0)
    cockpit.pass_to(60)
    assert cockpit.battery == 100
    fly_up(cockpit)
    assert 90 < cockpit.battery < 95


def test_looking_often_makes_no_difference() -> None:
    once, often = Autopilot(0.0), Autopilot(0.0)
    for cockpit in (once, often):
        fly_up(cockpit)
        cockpit.enable_virtual(back_to_rc=False)
        cockpit.virtual_sticks(Controls(pitch=1, yaw=0.3, throttle=0.2))
    for step in range(3000):
        often.pass_to(60 + step / 50)
    once.pass_to(120)
    often.pass_to(120)
    assert often.pose == pytest.approx(once.pose, abs=1e-6)
    assert (often.status, often.pilot) == (once.status, once.pilot)
    assert often.battery == pytest.approx(once.battery)

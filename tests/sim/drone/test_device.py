"""The simulated drone as seen over the wire: what it refuses, acknowledges and says unasked."""

from __future__ import annotations

import math
from typing import Any

import pytest
from drone_bench import DroneBench

from teleop.dji.drone import messages as drone
from teleop.dji.drone.broadcast import Broadcast
from teleop.dji.drone.enums import (
    ActivationCode,
    ArmCode,
    ArmOrder,
    Code,
    ControlCode,
    ControlDevice,
    ControlOrder,
    FlightStatus,
    ModeChannel,
    Rate,
    RcMode,
    TaskCode,
    TaskKind,
)
from teleop.dji.drone.movement import Horizontal, Move, ReferenceFrame, Vertical, Yaw
from teleop.dji.drone.virtual_rc import Sticks, VirtualRc
from teleop.dji.frame import Frame
from teleop.sim.drone.controls import Pilot, Switch
from teleop.sim.drone.settings import DroneSettings

UP = Sticks(throttle=1684)
CORNERS = Sticks(364, 364, 364, 1684)


@pytest.mark.parametrize("broadcasts", [True, False])
def test_before_activation_it_takes_rates_and_broadcasts_or_not_and_refuses_the_rest(broadcasts: bool) -> None:
    """OSDK issue 145: an M100 broadcasts and takes 00 10 before activation."""
    bench = DroneBench(settings=DroneSettings(broadcasts_before_activation=broadcasts))
    assert bench.ask(drone.Version()).code == Code.NOT_ACTIVATED
    assert bench.ask(drone.Control(ControlOrder.OBTAIN)).code == ControlCode.NOT_ACTIVATED
    bench.tell(VirtualRc(on=True))
    assert bench.ask(drone.Frequency(control=Rate.HZ_50)).code == (Code.OK if broadcasts else Code.NOT_ACTIVATED)
    bench.run(1)
    assert bool(bench.heard) == broadcasts
    assert any(each.control for _, each in bench.heard) == broadcasts
    assert not bench.drone.autopilot.virtual_on
    assert bench.ask(drone.Activate(1)).code == ActivationCode.OK
    assert bench.ask(drone.Version()).code == Code.OK


def test_it_broadcasts_at_the_rates_that_were_set_and_the_control_field_not_at_first() -> None:
    bench = DroneBench.activated()
    bench.run(2.002)
    count = {part: sum(getattr(each, part) is not None for _, each in bench.heard) for part in Broadcast.order}
    assert (count["time"], count["quaternion"]) == (200, 200)
    assert (count["rc"], count["status"], count["battery"], count["control"]) == (100, 20, 2, 0)
    bench.ask(drone.Frequency(control=Rate.HZ_50, time=Rate.OFF, quaternion=Rate.OFF, rc=Rate.HZ_1))
    bench.heard.clear()
    bench.run(2.002)
    count = {part: sum(getattr(each, part) is not None for _, each in bench.heard) for part in Broadcast.order}
    assert (count["control"], count["time"], count["rc"], count["status"]) == (100, 0, 2, 20)


def test_settings_of_the_virtual_rc_of_any_other_length_are_refused() -> None:
    """SDK 3.3.1 to 4.0.1 sent stick data under id 00: docs/protocol-facts.md."""
    bench = DroneBench.activated()
    for value in (b"", b"\x03\x00", bytes.fromhex("03") + bytes(63)):
        bench.send(Frame(b"\x05\x00" + value, 0, 1).encode())
    bench.run(0.1)
    assert not bench.drone.autopilot.virtual_on
    assert bench.drone.counts["refused"] == 3
    bench.send(Frame(b"\x05\x00\x03", 0, 1).encode())
    bench.run(0.1)
    assert bench.drone.autopilot.virtual_on


def test_the_virtual_rc_arms_and_flies_it() -> None:
    bench = DroneBench.activated()
    bench.tell(VirtualRc(on=True))
    bench.hold(CORNERS, 1.2)
    assert bench.drone.autopilot.flight.motors
    bench.hold(UP, 3)
    bench.hold(Sticks(pitch=1024 + 330, mode=ModeChannel.P), 3)
    last = bench.last("velocity")
    assert (last.x, last.y) == (pytest.approx(5, abs=0.1), pytest.approx(0, abs=0.1))
    assert bench.last("status") == FlightStatus.IN_AIR
    assert bench.last("position").height > 8
    assert bench.drone.autopilot.pilot is Pilot.VIRTUAL
    bench.run(1.5)
    assert bench.drone.autopilot.pilot is Pilot.RC


def test_channels_out_of_their_range_are_refused() -> None:
    bench = DroneBench.activated()
    bench.tell(VirtualRc(on=True))
    sent = Sticks(roll=1900)
    bench.send(Frame(sent.data(), 0, 5).encode())
    assert bench.drone.counts["refused"] == 1


def test_it_says_whether_the_virtual_rc_is_on_once_that_was_asked_for() -> None:
    bench = DroneBench.activated()
    bench.ask(drone.Frequency(control=Rate.HZ_50))
    bench.tell(VirtualRc(on=True))
    bench.run(0.05)
    assert bench.last("control").virtual_rc
    assert bench.last("rc").mode == RcMode.F
    bench.tell(VirtualRc(on=False))
    bench.run(0.05)
    assert not bench.last("control").virtual_rc


@pytest.mark.parametrize(("mirrors", "mode"), [(True, RcMode.P), (False, RcMode.F)])
def test_the_rc_that_it_tells_of_may_be_the_virtual_one(mirrors: bool, mode: RcMode) -> None:
    bench = DroneBench.activated(mirrors=mirrors)
    bench.tell(VirtualRc(on=True))
    bench.hold(Sticks(), 0.2)
    assert bench.last("rc").mode == mode


def test_control_is_given_in_f_mode_and_taken_by_the_pilot_who_leaves_it() -> None:
    bench = DroneBench.activated()
    bench.drone.turn_switch(bench.now, Switch.P)
    assert bench.ask(drone.Control(ControlOrder.OBTAIN)).code == ControlCode.NOT_IN_F_MODE
    bench.drone.turn_switch(bench.now, Switch.F)
    bench.obtain()
    bench.ask(drone.Frequency(control=Rate.HZ_50))
    bench.run(0.05)
    assert bench.last("control").device == ControlDevice.ONBOARD_DEVICE
    bench.drone.turn_switch(bench.now, Switch.A)
    bench.run(0.05)
    assert bench.last("control").device == ControlDevice.REMOTE_CONTROLLER
    assert [type(push) for push in bench.pushes] == [drone.Pushed]


def test_motors_obey_whoever_has_control_and_never_stop_in_the_air() -> None:
    bench = DroneBench.activated()
    assert bench.ask(drone.Arm(ArmOrder.ARM)).code == ArmCode.NEED_CONTROL
    bench.obtain()
    assert bench.ask(drone.Arm(ArmOrder.ARM)).code == ArmCode.OK
    assert bench.ask(drone.Arm(ArmOrder.ARM)).code == ArmCode.ALREADY
    assert bench.ask(drone.Task(TaskKind.TAKE_OFF)).code == TaskCode.FAILED, "only with the motors off"
    assert bench.ask(drone.Arm(ArmOrder.DISARM)).code == ArmCode.OK
    assert bench.ask(drone.Task(TaskKind.TAKE_OFF)).code == TaskCode.STARTED
    bench.run(5)
    assert bench.ask(drone.Arm(ArmOrder.DISARM)).code == ArmCode.IN_THE_AIR


def moves(**changes: Any) -> Move:
    plain: dict[str, Any] = {
        "stable": True,
        "frame": ReferenceFrame.BODY,
        "yaw_control": Yaw.RATE,
        "vertical": Vertical.VELOCITY,
        "horizontal": Horizontal.VELOCITY,
        **dict.fromkeys(("x", "y", "z", "yaw"), 0.0),
    }
    return Move(**{**plain, **changes})


def flying() -> DroneBench:
    bench = DroneBench.activated(yaw=90.0)
    bench.obtain()
    bench.ask(drone.Task(TaskKind.TAKE_OFF))
    bench.run(8)
    return bench


def test_velocities_are_along_the_nose_or_north_and_up_is_positive() -> None:
    bench = flying()
    bench.hold(moves(x=2.0, z=1.0), 4, rate=50)
    velocity = bench.last("velocity")
    assert (velocity.x, velocity.y) == (pytest.approx(0, abs=0.01), pytest.approx(2, abs=0.01))
    assert velocity.z == pytest.approx(1, abs=0.01), "the vertical velocity of the broadcast is up"
    bench.hold(moves(x=2.0, frame=ReferenceFrame.GROUND), 4, rate=50)
    assert bench.last("velocity").x == pytest.approx(2, abs=0.01)


def test_a_heading_and_a_height_are_sought() -> None:
    bench = flying()
    bench.hold(moves(yaw_control=Yaw.ANGLE, yaw=-45.0, vertical=Vertical.POSITION, z=7.0), 12, rate=50)
    pose = bench.drone.autopilot.pose
    assert math.degrees(pose.yaw) == pytest.approx(-45, abs=0.1)
    assert pose.height == pytest.approx(7, abs=0.05)


def test_movement_without_control_or_in_no_listed_mode_is_refused() -> None:
    bench = DroneBench.activated()
    bench.tell(moves())
    bench.obtain()
    refused = bench.drone.counts["refused"]
    assert refused == 1
    bench.send(Frame(b"\x01\x03\x6a" + bytes(16), 0, 9).encode())
    assert bench.drone.counts["refused"] == 2


def test_a_request_that_comes_again_is_acknowledged_again_and_obeyed_once() -> None:
    bench = DroneBench.activated()
    bench.obtain()
    bench.drone.acknowledges = False
    frame, _ = bench.session.request(drone.Arm(ArmOrder.ARM), bench.now)
    bench.send(frame)
    bench.drone.acknowledges = True
    bench.send(frame)
    answers = [each.message.code for each in bench.received if isinstance(each.message, drone.ArmAck)]
    assert answers == [ArmCode.OK]


def test_a_reboot_forgets_the_activation() -> None:
    bench = DroneBench.activated()
    bench.ask(drone.Frequency(control=Rate.HZ_50))
    bench.drone.reboot(bench.now, 3.0)
    bench.heard.clear()
    bench.run(3)
    assert bench.heard == []
    bench.run(1)
    assert bench.heard
    assert not any(each.control for _, each in bench.heard)
    assert bench.ask(drone.Version()).code == Code.NOT_ACTIVATED


def test_damage_is_passed_over() -> None:
    bench = DroneBench.activated()
    frame = bytearray(Frame(b"\x05\x00\x03", 0, 1).encode())
    frame[14] ^= 1
    bench.send(bytes(frame) + Frame(b"\x05\x00\x03", 0, 2).encode()[:-3])
    bench.run(1)
    assert not bench.drone.autopilot.virtual_on

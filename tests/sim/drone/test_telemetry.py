"""When which parts of the broadcast come, and in which units and frames: docs/protocol-facts.md, 00 10 and 02 00."""

from __future__ import annotations

import math
from collections.abc import Collection
from typing import Any

import pytest

from teleop.dji.drone.enums import ControlDevice, Rate, RcGear, RcMode
from teleop.dji.drone.messages import Frequency
from teleop.sim.drone.autopilot import Autopilot
from teleop.sim.drone.controls import Controls, Switch
from teleop.sim.drone.payload import Payload
from teleop.sim.drone.telemetry import TelemetrySender, quaternion


def airborne(yaw: float = 0.0) -> Autopilot:
    autopilot = Autopilot(0.0, yaw)
    autopilot.flight.hover(10.0)
    return autopilot


def said_by(sender: TelemetrySender, autopilot: Autopilot, parts: Collection[str]) -> Any:
    """These parts of the broadcast."""
    return sender.notify(autopilot, Payload(), parts)


def times(sender: TelemetrySender, part: str, now: float) -> list[float]:
    return [time for time, parts in sender.due(now) if part in parts]


def test_nothing_comes_before_it_begins_or_after_it_ends() -> None:
    sender = TelemetrySender(False, 5)
    assert sender.due(1.0) == []
    sender.begin(1.0)
    assert sender.due(1.5)
    sender.end()
    assert sender.due(2.0) == []


@pytest.mark.parametrize(("rate", "count"), [(Rate.OFF, 0), (Rate.HZ_1, 1), (Rate.HZ_50, 50), (Rate.HZ_100, 100)])
def test_a_part_comes_as_often_as_it_was_asked_for(rate: Rate, count: int) -> None:
    sender = TelemetrySender(False, 5)
    sender.begin(0.0)
    sender.set(Frequency(control=rate))
    assert len(times(sender, "control", 1.0)) == count


def test_hold_changes_no_rate_and_a_reboot_all_of_them() -> None:
    sender = TelemetrySender(False, 5)
    sender.set(Frequency(status=Rate.HZ_1))
    sender.set(Frequency(control=Rate.HZ_50))
    assert (sender.rates["status"], sender.rates["control"]) == (Rate.HZ_1, Rate.HZ_50)
    sender.end()
    assert (sender.rates["status"], sender.rates["control"]) == (Rate.HZ_10, Rate.OFF)


def test_looking_often_or_once_makes_no_difference() -> None:
    often, once = TelemetrySender(False, 5), TelemetrySender(False, 5)
    for sender in (often, once):
        sender.begin(0.0)
    looked = [time for look in range(1, 301) for time in times(often, "rc", look / 300)]
    assert looked == times(once, "rc", 1.0)


def test_a_hidden_part_does_not_come_and_the_others_do() -> None:
    sender = TelemetrySender(False, 5)
    sender.begin(0.0)
    sender.hidden = ("status",)
    parts = {part for _, each in sender.due(1.0) for part in each}
    assert "status" not in parts
    assert "battery" in parts


def test_vertical_velocity_is_up_and_height_is_above_the_ground() -> None:
    autopilot = airborne()
    autopilot.flight.climb(2.0)
    autopilot.pass_to(10.0)
    said = said_by(TelemetrySender(False, 4), autopilot, ["velocity", "position", "battery"])
    assert said.velocity.z == pytest.approx(2.0)
    assert said.position.height == pytest.approx(autopilot.pose.height)
    assert said.position.height > 20
    assert said.position.health == 4
    assert said.status is None, "only what was asked for"


def test_a_metre_north_is_so_many_radians_of_latitude() -> None:
    autopilot = airborne()
    sender = TelemetrySender(False, 5)
    before = said_by(sender, autopilot, ["position"]).position
    autopilot.flight.fly(10 + 10j, to_north=True)
    autopilot.pass_to(10.0)
    after = said_by(sender, autopilot, ["position"]).position
    earth = 40_007_863 / math.tau  # m: a meridian
    assert (after.latitude - before.latitude) * earth == pytest.approx(autopilot.pose.north, rel=0.01)
    east = (after.longitude - before.longitude) * earth * math.cos(before.latitude)
    assert east == pytest.approx(autopilot.pose.east, rel=0.01)


@pytest.mark.parametrize(
    ("angles", "numbers"),
    [
        ((0, 0, 0), (1, 0, 0, 0)),
        ((90, 0, 0), (math.sqrt(0.5), math.sqrt(0.5), 0, 0)),
        ((0, 90, 0), (math.sqrt(0.5), 0, math.sqrt(0.5), 0)),
        ((0, 0, 90), (math.sqrt(0.5), 0, 0, math.sqrt(0.5))),
        ((90, 0, 90), (0.5, 0.5, 0.5, 0.5)),  # rolled, then turned: the product of the two
    ],
)
def test_a_quaternion_turns_from_north_east_down_to_the_body(angles: tuple, numbers: tuple) -> None:
    attitude = quaternion(*map(math.radians, angles))
    assert (attitude.q0, attitude.q1, attitude.q2, attitude.q3) == pytest.approx(numbers, abs=1e-12)


@pytest.mark.parametrize(("mirrors", "roll"), [(False, 0), (True, 5000)])
def test_the_rc_is_the_real_one_unless_it_mirrors_the_virtual_one(mirrors: bool, roll: int) -> None:
    autopilot = airborne()
    autopilot.enable_virtual(back_to_rc=True)
    autopilot.virtual_sticks(Controls(roll=0.5, switch=Switch.F))
    said = said_by(TelemetrySender(mirrors, 5), autopilot, ["rc", "control"])
    assert (said.rc.roll, said.rc.mode, said.rc.gear) == (roll, RcMode.F, RcGear.DOWN)
    assert (said.control.virtual_rc, said.control.device) == (True, ControlDevice.REMOTE_CONTROLLER)


def test_the_control_part_names_the_onboard_computer_while_that_flies() -> None:
    autopilot = airborne()
    autopilot.obtain()
    said = said_by(TelemetrySender(False, 5), autopilot, ["control"])
    assert (said.control.device, said.control.virtual_rc) == (ControlDevice.ONBOARD_DEVICE, False)

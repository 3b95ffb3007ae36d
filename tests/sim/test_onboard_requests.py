"""What the simulated drone acknowledges, byte for byte, as a real one does: from frames built without the package."""

from __future__ import annotations

import struct

import pytest
from onboard_client import ACTIVATE, GO_HOME, LAND, OBTAIN, RELEASE, TAKE_OFF, Client
from raw_frames import raw_data, raw_frame

from teleop.sim.drone.controls import Switch
from teleop.sim.refusals import Why


def test_control_is_obtained_and_released_at_the_second_time() -> None:
    """OPENProtocol.md 3.1.9, 01 00: "sent twice, the first ACK will be fail"."""
    client = Client()
    client.ask(ACTIVATE)
    assert client.ask(OBTAIN) == "0300"
    assert not client.drone.autopilot.obtained
    assert client.ask(OBTAIN) == "0200"
    assert client.drone.autopilot.obtained
    assert client.ask(RELEASE) == "0400"
    assert client.drone.autopilot.obtained
    assert client.ask(RELEASE) == "0100"
    assert not client.drone.autopilot.obtained
    assert [client.ask(OBTAIN), client.ask(RELEASE), client.ask(OBTAIN)] == ["0300", "0100", "0300"]


def test_a_drone_may_confirm_at_once() -> None:
    client = Client(asks_twice=False)
    client.ask(ACTIVATE)
    assert [client.ask(OBTAIN), client.ask(RELEASE)] == ["0200", "0100"]


def test_a_task_that_starts_is_answered_by_2() -> None:
    """OPENProtocol.md 3.1.9, 01 01; v3.3.1 dji_error.cpp."""
    client = Client.in_control()
    assert client.task(TAKE_OFF) == "0200"
    client.wait(9.0)
    assert client.drone.autopilot.pose.height == pytest.approx(1.2, abs=0.01)
    assert client.task(LAND) == "0200"


def test_a_task_that_cannot_start_is_answered_by_1() -> None:
    """The reasons that the maker's sample LinuxFlight.cpp names, and OSDK-ROS issue 213."""
    client = Client()
    client.ask(ACTIVATE)
    assert client.task(TAKE_OFF) == "0100", "without control"
    client.ask(OBTAIN)
    client.ask(OBTAIN)
    assert [client.task(LAND), client.task(GO_HOME)] == ["0100", "0100"], "on the ground"
    assert client.ask(b"\x01\x05\x01") == "0000"
    assert client.task(TAKE_OFF) == "0100", "with the motors on"
    assert client.ask(b"\x01\x05\x00") == "0000"
    assert client.task(TAKE_OFF) == "0200"
    client.wait(9.0)
    assert client.task(TAKE_OFF) == "0100", "in the air"
    client.task(LAND)
    while client.drone.autopilot.flight.airborne:
        client.wait(0.1)
    assert client.task(TAKE_OFF) == "0100", "within two seconds of a landing"
    client.wait(2.1)
    assert client.task(TAKE_OFF) == "0200"


@pytest.mark.parametrize("task", [LAND, GO_HOME])
def test_a_task_holds_against_the_end_of_movement_commands(task: int) -> None:
    client = Client.in_control()
    client.drone.autopilot.flight.hover(5.5)
    for _ in range(100):
        client.tell(b"\x01\x03" + struct.pack("<Bffff", 0x4B, 2.0, 0, 0, 0))
        client.wait(0.02)
    assert client.task(task) == "0200"
    client.wait(40.0)
    pose = client.drone.autopilot.pose
    assert pose.height == 0.0
    assert client.drone.autopilot.status.value == 1
    assert (abs(pose.north) < 0.1) == (task == GO_HOME)


def test_movement_breaks_a_take_off() -> None:
    """Why nothing may be streamed while a task runs."""
    client = Client.in_control()
    client.task(TAKE_OFF)
    client.wait(0.5)
    client.tell(b"\x01\x03" + struct.pack("<Bffff", 0x4B, 0, 0, 0, 0))
    client.wait(9.0)
    assert client.drone.autopilot.pose.height == 0.0


def test_the_loss_of_control_is_pushed_and_its_acknowledgement_is_no_command() -> None:
    """02 01 with the value 04; acknowledged by 00 00, same session and sequence (docs/protocol-facts.md)."""
    client = Client.in_control()
    client.unasked.clear()
    client.drone.turn_switch(client.now, Switch.P)
    client.wait(0.001)
    [push] = [frame for frame in client.unasked if raw_data(frame)[:2] == b"\x02\x01"]
    assert raw_data(push) == b"\x02\x01\x04"
    assert push[3] >= 2
    client.drone.receive(raw_frame(b"\x00\x00", 0x20 | push[3], push[8] | push[9] << 8), client.now)
    client.wait(1.0)
    assert client.drone.refusals.total == 0
    client.tell(b"\x01\x03" + struct.pack("<Bffff", 0x4B, 2.0, 0, 0, 0))
    assert [refusal.why for refusal in client.drone.refusals.take()] == [Why.NO_CONTROL]

"""What the simulated drone acknowledges, byte for byte, as a real one does: from frames built without the package."""

from __future__ import annotations

import struct
from collections.abc import Iterator

import pytest
from raw_frames import cut, raw_data, raw_frame

from teleop.sim.drone import SimulatedDrone
from teleop.sim.drone_settings import DroneSettings

ACTIVATE = b"\x00\x01" + struct.pack("<III32s", 1030093, 2, 0x03010A00, b"9" * 32)
OBTAIN, RELEASE = b"\x01\x00\x01", b"\x01\x00\x00"
GO_HOME, TAKE_OFF, LAND = 1, 4, 6


class Client:
    """Sends commands in session 2 and reads what acknowledges them."""

    def __init__(self, **settings: object) -> None:
        self.drone = SimulatedDrone(settings=DroneSettings(**settings))  # type: ignore[arg-type]
        self.now = 0.0
        self.tasks = 0
        self._sequences: Iterator[int] = iter(range(1, 60000))
        self.unasked: list[bytes] = []

    def ask(self, data: bytes) -> str:
        """The value of the one acknowledgement, which comes at once; "" for none."""
        sequence = next(self._sequences)
        self.drone.receive(raw_frame(data, 2, sequence), self.now)
        acks = self.listen()
        assert all(frame[8:10] == sequence.to_bytes(2, "little") for frame in acks)
        return "".join(raw_data(frame).hex() for frame in acks)

    def tell(self, data: bytes) -> None:
        self.drone.receive(raw_frame(data, 0, next(self._sequences)), self.now)

    def task(self, kind: int) -> str:
        self.tasks += 1
        return self.ask(bytes((1, 1, self.tasks, kind)))

    def result(self) -> str:
        return self.ask(bytes((1, 2, self.tasks)))

    def wait(self, seconds: float) -> None:
        self.now += seconds
        assert self.listen() == []

    def listen(self) -> list[bytes]:
        frames = cut(self.drone.advance(self.now))
        self.unasked += [frame for frame in frames if not frame[3] & 0x20]
        return [frame for frame in frames if frame[3] & 0x20]

    @classmethod
    def in_control(cls, **settings: object) -> Client:
        client = cls(**settings)
        assert client.ask(ACTIVATE) == "0000"
        client.ask(OBTAIN)
        assert client.ask(OBTAIN) == "0200"
        return client


def test_control_is_obtained_and_released_at_the_second_time() -> None:
    """OPENProtocol.md 3.1.9, 01 00: "sent twice, the first ACK will be fail"."""
    client = Client()
    client.ask(ACTIVATE)
    assert client.ask(OBTAIN) == "0300"
    assert not client.drone.cockpit.obtained
    assert client.ask(OBTAIN) == "0200"
    assert client.drone.cockpit.obtained
    assert client.ask(RELEASE) == "0400"
    assert client.drone.cockpit.obtained
    assert client.ask(RELEASE) == "0100"
    assert not client.drone.cockpit.obtained
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
    assert client.drone.cockpit.pose.height == pytest.approx(1.2, abs=0.01)
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
    while client.drone.cockpit.flight.airborne:
        client.wait(0.1)
    assert client.task(TAKE_OFF) == "0100", "within two seconds of a landing"
    client.wait(2.1)
    assert client.task(TAKE_OFF) == "0200"


@pytest.mark.parametrize("task", [LAND, GO_HOME])
def test_a_task_holds_against_the_end_of_movement_commands(task: int) -> None:
    client = Client.in_control()
    client.drone.cockpit.flight.hover(5.5)
    for _ in range(100):
        client.tell(b"\x01\x03" + struct.pack("<Bffff", 0x4B, 2.0, 0, 0, 0))
        client.wait(0.02)
    assert client.task(task) == "0200"
    client.wait(40.0)
    pose = client.drone.cockpit.pose
    assert pose.height == 0.0
    assert client.drone.cockpit.status.value == 1
    assert (abs(pose.north) < 0.1) == (task == GO_HOME)


def test_movement_breaks_a_take_off() -> None:
    """Why nothing may be streamed while a task runs."""
    client = Client.in_control()
    client.task(TAKE_OFF)
    client.wait(0.5)
    client.tell(b"\x01\x03" + struct.pack("<Bffff", 0x4B, 0, 0, 0, 0))
    client.wait(9.0)
    assert client.drone.cockpit.pose.height == 0.0

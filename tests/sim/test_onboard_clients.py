"""What clients of others send to the simulated drone, byte for byte, and what it answers and notes."""

from __future__ import annotations

import json
import struct
from pathlib import Path

import pytest
from onboard_client import ACTIVATE, KEY, OBTAIN, TAKE_OFF, Client, encrypted
from raw_frames import cut, raw_data, raw_frame

from teleop.dji.drone.encryption import Cipher
from teleop.sim.drone.controls import Switch
from teleop.sim.drone.device import SimulatedDrone
from teleop.sim.drone.settings import DroneSettings
from teleop.sim.refusals import Why

VECTORS = {each["name"]: each for each in json.loads(Path("tests/data/onboard.json").read_text())["vectors"]}
ENABLE = b"\x05\x00\x03"


def frame(name: str) -> bytes:
    """A frame that the maker's library made."""
    return bytes.fromhex(VECTORS[name]["hex"])


def sticks(*channels: int, rest: int = 0) -> bytes:
    return b"\x05\x01" + struct.pack("<16I", *channels, *[rest] * (16 - len(channels)))


def refusals(drone: SimulatedDrone) -> list[tuple[str, Why]]:
    return [(refusal.command, refusal.why) for refusal in drone.refusals.take()]


def test_it_answers_the_version_as_a_real_one_does() -> None:
    """OSDK issue 54."""
    drone = SimulatedDrone()
    drone.receive(frame("get_version"), 0.0)
    [answer] = cut(drone.advance(0.0))
    assert raw_data(answer) == raw_data(frame("ack_version_m100"))
    assert answer[3] == 0x22


def test_arbitrary_bytes_are_arbitrary() -> None:
    """OPENProtocol.md 3.1.9: the one byte of 00 00 and of 01 20 to 22."""
    client = Client()
    assert client.ask(b"\x00\x00\x5a").startswith("01ff")
    client.ask(ACTIVATE)
    for command in (0x20, 0x20, 0x21):
        client.tell(bytes((1, command, 0x77)))
    assert (client.drone.payload.photos, client.drone.payload.recording) == (2, True)
    client.tell(b"\x01\x22\x00")
    assert not client.drone.payload.recording
    assert refusals(client.drone) == []


def test_the_makers_own_virtual_rc_frames_fly_it() -> None:
    """VirtualRC::resetData has gear 1024; other clients leave channel 5 and the rest 0."""
    client = Client()
    client.ask(ACTIVATE)
    client.drone.autopilot.flight.hover(20.0)
    client.tell(ENABLE)
    for number in range(40):
        client.tell(sticks(1024, 1354, 1024, 1024, 1024, 0, 7, rest=0xFFFFFFFF if number % 2 else 0))
        client.wait(0.05)
    controls = client.drone.autopilot.virtual
    assert (controls.pitch, controls.switch.name, controls.gear_up) == (0.5, "P", False)
    assert client.drone.autopilot.pose.velocity_north == pytest.approx(5.0, abs=0.2)
    client.tell(sticks(1024, 1354, 1024, 1024, 1684, 1024, 496))
    client.tell(sticks(1024, 1354, 1024, 1024, 1024, 0, 1))
    controls = client.drone.autopilot.virtual
    assert (controls.switch.name, controls.gear_up) == ("F", True), "an unknown value changes nothing"
    assert refusals(client.drone) == []


def test_the_reserved_bits_of_an_enable_are_not_looked_at() -> None:
    client = Client()
    client.ask(ACTIVATE)
    client.tell(b"\x05\x00\xab")
    assert client.drone.autopilot.virtual_on


def test_a_repetition_is_answered_by_the_same_bytes_and_not_obeyed_again() -> None:
    drone = SimulatedDrone()
    drone.receive(raw_frame(ACTIVATE, 2, 1), 0.0)
    drone.advance(0.0)
    asked = raw_frame(OBTAIN, 2, 9)
    drone.receive(asked, 1.0)
    first = drone.advance(1.0)
    drone.receive(asked, 1.1)
    assert cut(drone.advance(1.1))[-1] == cut(first)[-1]
    assert raw_data(cut(first)[-1]) == b"\x03\x00"
    drone.receive(raw_frame(OBTAIN, 2, 10), 1.2)
    assert raw_data(cut(drone.advance(1.2))[-1]) == b"\x02\x00"
    drone.receive(raw_frame(b"\x01\x05\x01", 2, 10), 1.3)  # the same session and sequence, another command
    assert drone.autopilot.flight.motors


def test_constant_sequence_numbers_do_no_harm() -> None:
    drone = SimulatedDrone()
    answers = []
    for step, data in enumerate((ACTIVATE, OBTAIN, b"\x01\x00\x01", b"\x01\x05\x01")):
        drone.receive(raw_frame(data, 2, 0), 4.0 * step)
        answers += [raw_data(each) for each in cut(drone.advance(4.0 * step)) if each[3] & 0x20]
    assert answers == [b"\x00\x00", b"\x03\x00", b"\x02\x00", b"\x00\x00"]


def test_answers_may_come_late() -> None:
    drone = SimulatedDrone(settings=DroneSettings(answer_delay=0.3, broadcasts_before_activation=False))
    drone.receive(frame("get_version"), 1.0)
    assert drone.advance(1.29) == b""
    assert raw_data(drone.advance(1.3)).startswith(b"\x01\xff")


def test_the_time_outs_are_settings() -> None:
    client = Client(virtual_rc_timeout=0.3)
    client.ask(ACTIVATE)
    client.tell(ENABLE)
    client.wait(0.29)
    assert client.drone.autopilot.virtual_on
    client.wait(0.02)
    assert not client.drone.autopilot.virtual_on


def test_the_result_of_a_task_can_be_asked_for() -> None:
    """OPENProtocol.md 3.1.9, 01 02: 1 wrong number, 3 in progress, 4 failed, 5 succeeded."""
    client = Client.in_control()
    assert client.result() == "0100"
    client.task(TAKE_OFF)
    assert client.result() == "0300"
    client.wait(9.0)
    assert client.result() == "0500"
    client.task(6)
    client.tell(b"\x01\x03" + struct.pack("<Bffff", 0x4B, 0, 0, 0, 0))
    assert client.result() == "0400"
    client.task(6)
    client.wait(9.0)
    assert client.result() == "0500"
    client.tasks += 1
    assert client.result() == "0100"


def gimbal_of(client: Client) -> tuple[float, ...]:
    """Roll, pitch and yaw in deg, and the limit byte, of the last broadcast that has them alone."""
    client.unasked.clear()
    client.wait(0.02)
    for data in (raw_data(each) for each in reversed(client.unasked)):
        if struct.unpack_from("<H", data, 2)[0] == 1 << 8:
            return struct.unpack_from("<3fB", data, 4)
    raise AssertionError("no gimbal in the broadcast")


def test_its_gimbal_shows_in_the_broadcast() -> None:
    client = Client()
    client.ask(ACTIVATE)
    assert client.ask(b"\x00\x10" + bytes((0, 0, 0, 0, 0, 0, 0, 0, 4, 0, 0, 0)) + b"\x09" * 4) == "0000"
    client.drone.receive(frame("gimbal_angle"), client.now)  # yaw -90, pitch -45 degrees in 2 s
    client.wait(1.0)
    assert gimbal_of(client) == (0.0, pytest.approx(-22.5, abs=1), pytest.approx(-45, abs=2), 0)
    client.wait(1.2)
    assert gimbal_of(client) == (0.0, pytest.approx(-45), pytest.approx(-90), 0)
    client.tell(b"\x01\x1a" + struct.pack("<hhhB", 200, 0, 0, 0x85))  # 20 deg/s, for half a second
    client.wait(2.0)
    assert gimbal_of(client)[2] == pytest.approx(-80, abs=0.1)
    client.tell(b"\x01\x1b" + struct.pack("<hhhBB", 0, 0, 3000, 0, 10))  # by 300 degrees: to the stop
    client.wait(1.1)
    assert gimbal_of(client)[1:] == (30.0, pytest.approx(-80, abs=0.1), 1)
    assert refusals(client.drone) == []


@pytest.mark.parametrize(
    ("data", "why"),
    [
        (b"\x05\x07\x00", Why.UNKNOWN),
        (b"\x03\x10" + bytes(20), Why.UNKNOWN),
        (b"\x05\x00" + bytes(64), Why.LENGTH),
        (b"\x05\x01" + bytes(60), Why.LENGTH),
        (b"\x01\x03\x4b" + bytes(8), Why.LENGTH),
        (sticks(1900, 1024, 1024, 1024), Why.RANGE),
        (b"\x01\x03\x6b" + bytes(16), Why.RANGE),
        (b"\x01\x03" + struct.pack("<Bffff", 0x4B, 11.0, 0, 0, 0), Why.RANGE),
        (b"\x01\x1b" + struct.pack("<hhhBB", 3300, 0, 0, 1, 10), Why.RANGE),
        (b"\x01\x1a" + struct.pack("<hhhB", 1900, 0, 0, 0x80), Why.RANGE),
        (sticks(1024, 1024, 1024, 1024), Why.MODE),
        (b"\x01\x03" + struct.pack("<Bffff", 0x4B, 0, 0, 0, 0), Why.NO_CONTROL),
    ],
)
def test_what_it_does_not_obey_it_notes_with_a_reason(data: bytes, why: Why) -> None:
    client = Client()
    client.ask(ACTIVATE)
    client.tell(data)
    client.wait(0.5)
    assert [each for _, each in refusals(client.drone)] == [why]
    assert client.drone.counts["refused"] == 1


def test_before_activation_and_in_another_mode_it_says_so() -> None:
    client = Client()
    client.tell(ENABLE)
    assert client.ask(OBTAIN) == "01ff"
    client.ask(ACTIVATE)
    client.drone.turn_switch(client.now, Switch.P)
    assert client.ask(OBTAIN) == "0000"
    client.tell(ENABLE)
    kinds = [why for _, why in refusals(client.drone)]
    assert kinds == [Why.NOT_ACTIVATED, Why.NOT_ACTIVATED, Why.MODE, Why.MODE]


def test_a_second_enable_within_two_seconds_is_noted() -> None:
    client = Client()
    client.ask(ACTIVATE)
    client.tell(ENABLE)
    client.wait(0.5)
    client.tell(ENABLE)
    [refusal] = client.drone.refusals.take()
    assert (refusal.why, "within 2 s" in refusal.detail) == (Why.STATE, True)
    client.tell(sticks(1024, 1024, 1024, 1024))
    [refusal] = client.drone.refusals.take()
    assert (refusal.why, refusal.detail) == (Why.STATE, "it is locked")


def test_damage_is_noted_with_its_checksum() -> None:
    drone = SimulatedDrone()
    broken = bytearray(frame("get_version"))
    broken[10] ^= 1
    drone.receive(bytes(broken), 0.0)
    drone.receive(b"", 0.2)
    [refusal] = drone.refusals.take()
    assert (refusal.why, refusal.detail.startswith("header CRC-16 is wrong: aa13")) == (Why.DAMAGED, True)


def test_with_a_key_everything_after_activation_is_encrypted() -> None:
    """As the maker's default build does; the frame is one that it made."""
    drone = SimulatedDrone(cipher=Cipher(KEY))
    drone.receive(frame("get_version") + raw_frame(ACTIVATE, 3, 2), 0.1)
    assert all(each[4] == 0 for each in cut(drone.advance(0.1)))
    drone.receive(frame("vrc_enable_backtoreal_enc"), 0.2)
    assert drone.autopilot.virtual_on
    drone.receive(encrypted(OBTAIN, 2, 7), 0.3)
    sent = cut(drone.advance(0.4))
    assert sent
    assert all(each[4] >> 5 == 1 and len(each) % 16 == 0 for each in sent)
    drone.receive(frame("get_version"), 0.5)  # the maker's library asks this in the clear always
    [plain] = [each for each in cut(drone.advance(0.5)) if each[4] == 0]
    assert raw_data(plain)[:2] == b"\x00\x00"
    assert refusals(drone) == []


def test_another_key_is_answered_by_the_key_error() -> None:
    drone = SimulatedDrone(cipher=Cipher(KEY))
    drone.receive(raw_frame(ACTIVATE, 3, 2) + encrypted(OBTAIN, 2, 7, bytes(32)), 0.0)
    assert len(cut(drone.advance(0.0))) == 2
    assert [why for _, why in refusals(drone)] == [Why.KEY]

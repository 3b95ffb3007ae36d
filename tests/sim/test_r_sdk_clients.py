"""What clients of others send to the simulated gimbal, byte for byte, and how real gimbals differ: r-sdk-facts.md."""

from __future__ import annotations

import json
import struct
from pathlib import Path
from typing import Any

import pytest
from raw_frames import REPLY, cut, raw_data, raw_frame

from teleop.sim.gimbal.device import SimulatedGimbal
from teleop.sim.gimbal.firmware import Firmware
from teleop.sim.refusals import Why

VECTORS = json.loads(Path("tests/data/r-sdk.json").read_text())["vectors"]
POSITION, SPEED, ANGLES, PUSH_ON = 0x00, 0x01, b"\x0e\x02\x01", b"\x0e\x07\x01"


class Client:
    """Sends frames with one constant sequence number and reads bytes."""

    def __init__(self, **settings: Any) -> None:
        self.gimbal = SimulatedGimbal(**settings)
        self.now = 0.0

    def ask(self, data: bytes, kind: int = 0x03) -> list[bytes]:
        """The data of what comes back at once."""
        self.gimbal.receive(raw_frame(data, kind, 0x2211), self.now)
        return self.listen()

    def listen(self) -> list[bytes]:
        return [raw_data(frame) for frame in cut(self.gimbal.advance(self.now))]

    def refusals(self) -> list[Why]:
        return [refusal.why for refusal in self.gimbal.refusals.take()]


def position(yaw: int, roll: int = 0, pitch: int = 0, control: int = 1, time: int = 10) -> bytes:
    return b"\x0e\x00" + struct.pack("<3hBB", yaw, roll, pitch, control, time)


def speed(yaw: int, roll: int = 0, pitch: int = 0, control: int = 0x80) -> bytes:
    return b"\x0e\x01" + struct.pack("<3hB", yaw, roll, pitch, control)


@pytest.mark.parametrize("kind", [0x01, 0x02, 0x03, 0x1F])
@pytest.mark.parametrize(
    "data",
    [
        b"\x0e\x12\x01\x00\x02\x00\x08",  # focus position
        b"\x0e\x0a\x01" + struct.pack("<3h", 100, 200, 300),  # joystick
        b"\x0e\x0a\x02\x10\x00",  # dial
        b"\x0e\x0a\x07\x10\x00",  # no such device
        b"\x0e\x0a",
        b"\x0e\x12\x01\x00",  # half a focus position
        b"\x0e\x09\x01\x00\x00\x00\x07\x00\x02\x02",  # version push
    ],
)
def test_what_has_no_reply_has_none_whatever_the_cmd_type_asks(data: bytes, kind: int) -> None:
    """R SDK V2.5, figures 17, 21, 22 and 32."""
    assert Client().ask(data, kind) == []


def test_the_version_is_answered_all_the_same() -> None:
    assert Client().ask(b"\x0e\x09\x01\x00\x00\x00") == [bytes.fromhex("0e09 00 01000000 07000202")]


@pytest.mark.parametrize(
    "data",
    [
        position(1801),
        position(0, 301),
        position(0, 0, 1461),
        position(0, 0, -561),
        position(0, time=0),
        speed(3601),
        speed(0, 0, -3601),
    ],
)
def test_what_is_beyond_the_documents_ranges_is_refused(data: bytes) -> None:
    client = Client()
    assert client.ask(data) == [data[:2] + b"\x01"]
    client.now = 0.4
    client.listen()
    assert client.gimbal.angles == (0.0, 0.0, 0.0)
    assert client.refusals() == [Why.RANGE]


def test_the_ends_of_the_ranges_are_obeyed_and_reserved_bits_not_looked_at() -> None:
    client = Client()
    for data in (
        position(1800, 300, 1460),
        position(-1800, -300, -560),
        position(10, control=0xF1),
        speed(3600, -3600),
    ):
        assert client.ask(data) == [data[:2] + b"\x00"]
    assert client.refusals() == []


def test_questions_without_data_are_answered() -> None:
    """The whole frames have the lengths that were observed: limits 25, user parameters 00, 22 and 23 have 28 bytes."""
    client = Client()
    assert client.ask(b"\x0e\x04") == [bytes.fromhex("0e04 00 91 37 b3 b3 1e 1e")]
    assert client.ask(b"\x0e\x06") == [bytes.fromhex("0e06 00 32 32 32")]
    [parameters] = client.ask(b"\x0e\x0b")
    assert parameters == bytes.fromhex("0e0b 00 000100 220100 230100")
    assert len(parameters) + 16 == 28
    assert client.refusals() == []


def test_a_constant_sequence_number_padding_and_empty_can_frames_do_no_harm() -> None:
    client = Client()
    frame = raw_frame(position(450), 3, 1)
    for _ in range(3):
        padded = frame + bytes(-len(frame) % 8)
        for start in range(0, len(padded), 8):
            client.gimbal.receive(b"", client.now)
            client.gimbal.receive(padded[start : start + 8], client.now)
        assert client.listen() == [b"\x0e\x00\x00"]
        client.now += 1.0
    assert client.ask(ANGLES) == [bytes.fromhex("0e02 00 01 c201 0000 0000")]
    assert client.refusals() == []


@pytest.mark.parametrize(
    ("order", "angles"), [("yaw-roll-pitch", "0a00 1400 1e00"), ("yaw-pitch-roll", "0a00 1e00 1400")]
)
def test_old_firmware_leaves_out_set_id_and_the_type(order: Any, angles: str) -> None:
    client = Client(boot=(1.0, 2.0, 3.0), firmware=Firmware(legacy_replies=True, legacy_order=order))
    assert client.ask(ANGLES) == [bytes.fromhex("00" + angles)]
    assert client.ask(PUSH_ON) == [b"\x00"]


def test_the_sign_of_a_speed_may_differ_from_that_of_the_angle() -> None:
    client = Client(firmware=Firmware(speed_signs=(-1, 1, 1)))
    client.ask(speed(200, 0, 200))
    client.now = 0.4
    client.listen()
    assert client.gimbal.angles.yaw < -5
    assert client.gimbal.angles.pitch > 5
    client.ask(position(100))
    client.now = 1.4
    assert client.ask(ANGLES)[0][4:6] == b"\x64\x00", "the angle has its own sign"
    client.ask(b"\x0e\x0a\x01" + struct.pack("<3h", 0, 0, 15000))
    client.now = 1.8
    client.listen()
    assert client.gimbal.angles.yaw < 5, "so has the joystick"


def test_the_sign_of_a_reported_angle_may_be_another_one() -> None:
    client = Client(boot=(1.0, 2.0, 3.0), firmware=Firmware(report_signs=(-1, 1, 1)))
    assert client.ask(ANGLES) == [bytes.fromhex("0e02 00 01 f6ff 1400 1e00")]
    client.ask(position(100))
    client.now = 1.0
    client.listen()
    assert client.gimbal.angles.yaw == 10.0


@pytest.mark.parametrize(("bit", "short"), [(True, False), (False, True), (True, True)])
def test_pushes_may_have_the_reply_bit_and_be_short(bit: bool, short: bool) -> None:
    client = Client(push_rate=1.0, boot=(1.0, 2.0, 3.0), firmware=Firmware(push_reply_bit=bit, short_push=short))
    client.ask(PUSH_ON)
    client.now = 1.0
    [push] = cut(client.gimbal.advance(client.now))
    assert push[3] == (REPLY if bit else 0)
    assert len(push) == (25 if short else 40)
    assert raw_data(push)[:9] == bytes.fromhex("0e08 07 0a00 1400 1e00")


def test_speeds_may_do_nothing_while_positions_and_the_joystick_work() -> None:
    client = Client(firmware=Firmware(ignores_speed=True))
    assert client.ask(speed(200)) == [b"\x0e\x01\x00"]
    client.now = 0.4
    client.listen()
    assert client.gimbal.angles.yaw == 0.0
    client.ask(b"\x0e\x0a\x01" + struct.pack("<3h", 0, 0, 15000))
    client.now = 0.8
    client.listen()
    assert client.gimbal.angles.yaw > 5


@pytest.mark.parametrize(("state", "answer"), [("absent", "0e12 02"), ("uncalibrated", "0e12 00 15 00 01 00000000")])
def test_a_focus_motor_may_be_missing_or_not_calibrated(state: Any, answer: str) -> None:
    client = Client(firmware=Firmware(focus_motor=state))
    assert client.ask(b"\x0e\x12\x01\x00\x02\x00\x08") == []
    assert client.ask(b"\x0e\x12\x15\x00") == [bytes.fromhex(answer)]
    assert client.refusals()[0] is Why.STATE


def test_a_focus_motor_may_ignore_zero() -> None:
    client = Client(firmware=Firmware(ignores_zero_focus=True), focus_speed=4095.0)
    client.ask(b"\x0e\x12\x01\x00\x02\x00\x08")
    client.now = 1.0
    client.ask(b"\x0e\x12\x01\x00\x02\x00\x00")
    client.now = 2.0
    assert client.ask(b"\x0e\x12\x15\x00") == [bytes.fromhex("0e12 00 15 00 03 00080000")]


def test_roll_may_be_left_off_level_after_speed_control_until_a_position() -> None:
    client = Client(firmware=Firmware(roll_error=1.5))
    client.ask(speed(0, control=0x00))
    assert client.ask(ANGLES)[0][6:8] == b"\x00\x00", "nothing was taken over"
    client.ask(speed(100))
    client.ask(speed(0, control=0x00))
    client.now = 1.0
    assert client.ask(ANGLES)[0][6:8] == b"\x0f\x00"
    client.ask(position(0))
    client.now = 2.0
    assert client.ask(ANGLES)[0][6:8] == b"\x00\x00"


def test_limits_beyond_the_document_may_be_reported() -> None:
    assert Client(firmware=Firmware(pitch_max=155)).ask(b"\x0e\x04\x01")[0][3] == 155


@pytest.mark.parametrize("value", [0x01, 0x03])
def test_both_values_start_the_automatic_tuning(value: int) -> None:
    assert Client().ask(b"\x0e\x0f\x00\x01" + bytes((value,))) == [b"\x0e\x0f\x00"]


@pytest.mark.parametrize(
    ("data", "kind", "why"),
    [
        (b"\x0e\x7f\x01", 3, Why.UNKNOWN),
        (b"\x0e\x00\x20\x00", 3, Why.LENGTH),
        (b"\x0e\x07\x03", 3, Why.RANGE),
        (b"\x0e\x0b\x77", 3, Why.STATE),
        (position(10), REPLY, Why.REPLY),
    ],
)
def test_what_it_does_not_obey_it_notes_with_a_reason(data: bytes, kind: int, why: Why) -> None:
    client = Client()
    client.ask(data, kind)
    assert client.refusals() == [why]


def test_damage_is_noted() -> None:
    client = Client()
    broken = bytearray(raw_frame(ANGLES, 3, 1))
    broken[-1] ^= 1
    client.gimbal.receive(bytes(broken), 0.0)
    client.gimbal.receive(b"", 0.2)
    [refusal] = client.gimbal.refusals.take()
    assert (refusal.why, "frame CRC-32 is wrong" in refusal.detail) == (Why.DAMAGED, True)


def test_every_published_command_is_obeyed_or_refused_for_its_range_alone() -> None:
    for vector in VECTORS:
        frame = bytes.fromhex(vector["hex"])
        if frame[3] & REPLY:
            continue
        gimbal = SimulatedGimbal()
        gimbal.receive(frame, 0.0)
        gimbal.receive(b"", 0.2)
        assert {refusal.why for refusal in gimbal.refusals.take()} <= {Why.RANGE}, vector

"""Orders to a drone, byte by byte as docs/protocol-facts.md has them: widths, order, and what is kept secret."""

from __future__ import annotations

import struct

import pytest

from teleop.dji.drone import messages as drone
from teleop.dji.drone.enums import ArmCode, Rate, ShortArmCode
from teleop.dji.message import FieldError, Opaque

SECRET = 0x0BADCAFE


def test_activation_has_the_version_of_the_m100_and_keeps_the_app_id_out_of_its_text() -> None:
    message = drone.Activate(SECRET)
    assert message.data() == b"\0\1" + struct.pack("<III", SECRET, 2, 0x03010A00) + b"9" * 32
    assert len(message.encode()) == 44
    assert str(SECRET) not in repr(message)


def test_rates_are_sixteen_bytes_of_which_twelve_or_fourteen_are_parts() -> None:
    control = drone.Frequency(control=Rate.HZ_50).encode()
    assert control == bytes([5] * 11 + [3] + [0] * 4), "hold, except index 11"
    assert drone.A3Frequency(control=Rate.HZ_50).encode() == bytes([5] * 13 + [3] + [0] * 2)


def test_a_task_counts_first() -> None:
    assert drone.Task(4, number=7).data() == bytes((1, 1, 7, 4))


@pytest.mark.parametrize("value", ["0200", "0000", "c900", "01ff"])
def test_a_code_of_control_has_two_bytes(value: str) -> None:
    assert drone.ControlAck.decode(bytes.fromhex(value)).encode() == bytes.fromhex(value)
    assert isinstance(drone.ControlAck.decode(bytes.fromhex(value)[:1]), Opaque)


def test_arming_may_be_answered_by_one_byte() -> None:
    assert drone.ArmAck.decode(b"\3\0") == drone.ArmAck(ArmCode.IN_THE_AIR)
    assert isinstance(drone.ArmAck.decode(b"\3"), Opaque)
    assert drone.ShortArmAck.decode(b"\3") == drone.ShortArmAck(ShortArmCode.IN_THE_AIR)


def test_the_gimbal_turns_at_the_named_speeds_and_not_about_the_other_axes() -> None:
    message = drone.GimbalSpeed.from_fields(drone.GimbalSpeed.completed({"yaw": "-12.5"}))
    assert message.data() == b"\1\x1a" + struct.pack("<3hB", -125, 0, 0, 0x80)
    with pytest.raises(FieldError, match=r"pitch must be -180\.\.180 deg/s"):
        drone.GimbalSpeed(0, 0, 180.1).check()


def test_the_gimbal_ignores_the_axes_without_an_angle() -> None:
    fields = drone.GimbalAngle.completed({"roll": "-35", "duration": "2.5"})
    message = drone.GimbalAngle.from_fields(fields)
    assert message.data() == b"\1\x1b" + struct.pack("<3hBB", 0, -350, 0, 0b1011, 25)
    with pytest.raises(FieldError, match=r"duration must be 0\.1\.\.25\.5 s"):
        drone.GimbalAngle(0, 0, 0, duration=0.0).check()


def test_a_lost_control_is_acknowledged_by_two_zeros() -> None:
    assert drone.Pushed().data() == bytes.fromhex("0201 04")
    assert drone.PushedAck().encode() == bytes(2)

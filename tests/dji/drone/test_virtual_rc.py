"""The virtual RC's messages and channels: docs/protocol-facts.md, 05 00 and 05 01."""

from __future__ import annotations

import struct

import pytest

from teleop.dji.drone.enums import GearChannel, ModeChannel, RcGear, RcMode
from teleop.dji.drone.virtual_rc import NEUTRAL, Sticks, VirtualRc, broadcast_value
from teleop.dji.message import FieldError, Opaque


@pytest.mark.parametrize(
    ("message", "byte"),
    [(VirtualRc(on=True), 0x03), (VirtualRc(on=False), 0x02), (VirtualRc(on=True, back_to_rc=False), 0x01)],
)
def test_the_switch_is_one_byte_that_gives_the_drone_back_to_its_rc_unless_told_otherwise(
    message: VirtualRc, byte: int
) -> None:
    assert message.data() == bytes((0x05, 0x00, byte))


def test_neutral_is_every_stick_in_the_middle_in_p_mode_with_the_gear_down() -> None:
    assert NEUTRAL.encode() == struct.pack("<16I", *[1024] * 4, 1324, 1024, 1552, *[1024] * 9)


def test_the_first_four_channels_are_roll_pitch_throttle_and_yaw() -> None:
    assert Sticks(roll=364, pitch=500, throttle=1684, yaw=1100).encode()[:16] == struct.pack(
        "<4I", 364, 500, 1684, 1100
    )


@pytest.mark.parametrize("length", [0, 2, 64])
def test_a_switch_of_another_length_switches_nothing(length: int) -> None:
    """SDK 3.3.1 to 4.0.1 sent sticks under this id."""
    assert isinstance(VirtualRc.decode(b"\x03".ljust(length, b"\0")[:length]), Opaque)


@pytest.mark.parametrize("length", [60, 63, 65])
def test_sticks_of_another_length_are_none(length: int) -> None:
    assert isinstance(Sticks.decode(bytes(length)), Opaque)


@pytest.mark.parametrize("value", [363, 1685])
def test_a_stick_beyond_660_either_way_is_not_sent(value: int) -> None:
    Sticks(throttle=364, yaw=1684).check()
    with pytest.raises(FieldError, match=r"throttle must be 364\.\.1684"):
        Sticks(throttle=value).check()


def test_the_broadcast_has_mode_and_gear_with_the_opposite_sign() -> None:
    assert (broadcast_value(1552), broadcast_value(1324)) == (-8000, -4545)
    for name in ("P", "A", "F"):
        assert broadcast_value(ModeChannel[name]) == RcMode[name]
    for name in ("UP", "DOWN"):
        assert broadcast_value(GearChannel[name]) == RcGear[name]

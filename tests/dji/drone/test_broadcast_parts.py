"""The parts of the broadcast, byte by byte, as docs/protocol-facts.md (02 00) has them."""

from __future__ import annotations

import math
import struct
from typing import TypeVar

import pytest

from teleop.dji.drone import broadcast_parts as parts
from teleop.dji.drone.enums import ControlDevice, CurrentMode, RcGear, RcMode
from teleop.dji.message import FieldError, Message

Kind = TypeVar("Kind", bound=Message)


def decoded(kind: type[Kind], value: bytes) -> Kind:
    message = kind.decode(value)
    assert isinstance(message, kind)
    assert message.encode() == value
    return message


def test_latitude_comes_before_longitude() -> None:
    value = struct.pack("<ddffB", math.radians(52.5), math.radians(13.4), 40.0, 2.5, 4)
    position = decoded(parts.Position, value)
    assert (math.degrees(position.latitude), math.degrees(position.longitude)) == pytest.approx((52.5, 13.4))
    assert (position.altitude, position.height, position.health) == (40.0, 2.5, 4)


def test_of_the_receivers_longitude_comes_first_and_the_gps_counts_in_ten_millionths_of_a_degree() -> None:
    gps = decoded(parts.Gps, struct.pack("<IIiii3f", 261129, 85500, 134_000_000, -525_000_000, 40_000, 1, 2, 3))
    assert (gps.longitude, gps.latitude, gps.above_sea) == (13.4, -52.5, 40_000)
    rtk = decoded(parts.Rtk, struct.pack("<IIddf3fhBB", 261129, 85500, 13.4, -52.5, 40.0, 1, 2, 3, -90, 50, 50))
    assert (rtk.longitude, rtk.latitude, rtk.yaw) == (13.4, -52.5, -90)


def test_of_the_remote_controller_yaw_comes_before_throttle() -> None:
    rc = decoded(parts.Rc, struct.pack("<6h", 1000, 2000, 3000, 4000, 8000, -4545))
    assert rc == parts.Rc(roll=1000, pitch=2000, yaw=3000, throttle=4000, mode=RcMode.F, gear=RcGear.DOWN)


@pytest.mark.parametrize(
    ("byte", "device", "requested", "virtual"),
    [
        (0x00, ControlDevice.REMOTE_CONTROLLER, False, False),
        (0x0A, ControlDevice.ONBOARD_DEVICE, True, False),
        (0x10, ControlDevice.REMOTE_CONTROLLER, False, True),
        (0x07, 7, False, False),
    ],
)
def test_the_device_has_three_bits_and_the_virtual_rc_the_fifth(
    byte: int, device: int, requested: bool, virtual: bool
) -> None:
    control = decoded(parts.ControlSource, bytes((4, byte)))
    assert control.mode == CurrentMode.HORIZ_VEL_VERT_VEL_YAW_RATE
    assert (control.device, control.requested, control.virtual_rc) == (device, requested, virtual)


def test_the_limits_of_the_gimbal_are_pitch_roll_and_yaw_in_this_order() -> None:
    gimbal = decoded(parts.Gimbal, struct.pack("<3fB", 1, 2, 3, 0b001))
    assert (gimbal.roll, gimbal.pitch, gimbal.yaw) == (1, 2, 3)
    assert (gimbal.pitch_limited, gimbal.roll_limited, gimbal.yaw_limited) == (True, False, False)


def test_a_health_beyond_5_is_read_and_not_sent() -> None:
    position = decoded(parts.Position, struct.pack("<ddffB", 0, 0, 0, 0, 6))
    with pytest.raises(FieldError, match=r"health must be 0\.\.5"):
        position.check()

"""Broadcasts of any parts, of either drone: every byte is kept, and no part is shown that was not sent."""

from __future__ import annotations

import json
import math
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from teleop.dji.drone.broadcast import PARTS, A3Broadcast, Broadcast
from teleop.dji.drone.broadcast_parts import ControlSource, Gps, Position, Rc, Time
from teleop.dji.drone.enums import ControlDevice, CurrentMode, FlightStatus, RcGear, RcMode
from teleop.dji.drone.virtual_rc import broadcast_value
from teleop.dji.message import FieldError, Opaque

SIZES = {
    "time": 9,
    "quaternion": 16,
    "acceleration": 12,
    "velocity": 13,
    "angular_rate": 12,
    "position": 25,
    "gps": 32,
    "rtk": 44,
    "magnetometer": 6,
    "rc": 12,
    "gimbal": 13,
    "status": 1,
    "battery": 1,
    "control": 2,
}
both = pytest.mark.parametrize("cls", [Broadcast, A3Broadcast])
RC = Rc(0, 0, 0, 0, RcMode.P, RcGear.DOWN)


def test_sizes_are_those_of_the_tables() -> None:
    assert {name: part.size for name, part in PARTS.items()} == SIZES
    frame = 12 + 2 + 2 + 4  # header, set and id, flags, CRC-32
    assert sum(SIZES[name] for name in Broadcast.order) + frame == 142
    assert sum(SIZES[name] for name in A3Broadcast.order) + frame == 218


@both
@given(flags=st.integers(0, 0xFFFF), data=st.data())
def test_any_parts(cls: type[Broadcast], flags: int, data: st.DataObject) -> None:
    names = [name for bit, name in enumerate(cls.order) if flags >> bit & 1]
    size = sum(SIZES[name] for name in names)
    value = flags.to_bytes(2, "little") + data.draw(st.binary(min_size=size, max_size=size + 3))
    message: Any = cls.decode(value)
    assert message.encode() == value
    if flags >> len(cls.order):
        assert isinstance(message, Opaque)
        return
    assert message.flags == flags
    fields = message.fields()
    assert [name for name in fields if name != "extra"] == names
    assert cls.from_fields(json.loads(json.dumps(fields, allow_nan=False))) == message
    short: Any = cls.decode(value[: 1 + size])
    assert isinstance(short, Opaque)
    assert short.encode() == value[: 1 + size]


@pytest.mark.parametrize(("channel", "value"), [(1552, RcMode.P), (1024, RcMode.A), (496, RcMode.F)])
def test_the_broadcast_mode_has_the_other_sign(channel: int, value: int) -> None:
    assert broadcast_value(channel) == value


@pytest.mark.parametrize(("channel", "value"), [(1684, RcGear.UP), (1324, RcGear.DOWN)])
def test_the_broadcast_gear_has_the_other_sign(channel: int, value: int) -> None:
    assert broadcast_value(channel) == value


def test_latitude_comes_first() -> None:
    position = Position(math.radians(22.5), math.radians(114), 1.0, 2.0, 5)
    assert position.encode()[:8] == bytes.fromhex("182d4454fb21d93f")
    assert position.fields()["latitude"] == math.radians(22.5)


def test_the_gps_of_an_a3_is_in_degrees() -> None:
    assert Gps.decode(bytes(8) + (-1139633450).to_bytes(4, "little", signed=True) + bytes(20)).fields()[
        "longitude"
    ] == pytest.approx(-113.963345)


@pytest.mark.parametrize(
    ("message", "error"),
    [
        (Broadcast(gps=Gps(0, 0, 0, 0, 0, 0, 0, 0)), "drone.broadcast: there is no gps in this drone's layout"),
        (Broadcast(battery=300), "drone.broadcast: battery 300 does not fit its 8 bits"),
        (Broadcast(time=Time(0, 0, 0, extra=b"x")), "drone.broadcast: time has no extra"),
        (Broadcast(rc=Rc(40000, 0, 0, 0, 0, 0)), "rc: roll 40000 does not fit its 16 bits"),
    ],
)
def test_what_does_not_fit_its_bytes(message: Broadcast, error: str) -> None:
    with pytest.raises(FieldError) as raised:
        message.encode()
    assert str(raised.value) == error


@pytest.mark.parametrize(
    ("message", "error"),
    [
        (Broadcast(battery=101), "drone.broadcast: battery must be 0..100 %, not 101"),
        (
            Broadcast(status=9),
            "drone.broadcast: status must be one of standby, take_off, in_air, landing, finish_landing, not 9",
        ),
        (Broadcast(rc=Rc(10001, 0, 0, 0, 0, RcGear.UP)), "rc: roll must be -10000..10000, not 10001"),
        (Broadcast(rc=Rc(0, 0, 0, 0, 1, RcGear.UP)), "rc: mode must be one of p, a, f, not 1"),
    ],
)
def test_what_may_not_be_sent(message: Broadcast, error: str) -> None:
    with pytest.raises(FieldError) as raised:
        message.check()
    assert str(raised.value) == error


@pytest.mark.parametrize(
    ("fields", "error"),
    [
        ({"batery": 3}, "drone.broadcast: no field 'batery', did you mean 'battery'?"),
        ({"battery": "full"}, "drone.broadcast: battery must be 0..100 %, not 'full'"),
        ({"rc": 3}, "drone.broadcast: rc must be an object, not 3"),
        ({"rc": {"roll": 3}}, "rc: pitch, yaw, throttle, mode, gear missing"),
        ({"extra": 3}, "drone.broadcast: extra must be hexadecimal, not 3"),
    ],
)
def test_fields_that_are_none(fields: dict[str, Any], error: str) -> None:
    with pytest.raises(FieldError) as raised:
        Broadcast.from_fields(fields)
    assert str(raised.value) == error


def test_words_and_numbers_that_are_none() -> None:
    source = ControlSource(CurrentMode.ATTI_STOP, ControlDevice.ONBOARD_DEVICE, virtual_rc=True)
    message = Broadcast(rc=RC, status=FlightStatus.STANDBY, battery=87, control=source)
    message.check()
    assert message.fields()["rc"] == {"roll": 0, "pitch": 0, "yaw": 0, "throttle": 0, "mode": "p", "gear": "down"}
    assert (message.fields()["status"], message.fields()["battery"]) == ("standby", 87)
    assert message.fields()["control"] == {
        "mode": "atti_stop",
        "device": "onboard_device",
        "requested": False,
        "virtual_rc": True,
    }
    strange: Any = Broadcast.decode(bytes.fromhex("000a 09 30 1f"))
    assert strange.fields() == {
        "status": 9,
        "control": {
            "mode": 0x30,
            "device": 7,
            "requested": True,
            "virtual_rc": True,
        },
    }

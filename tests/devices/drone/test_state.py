"""The state of a drone from a broadcast of known numbers: its units, and None for what it does not say."""

from __future__ import annotations

import math
from dataclasses import fields
from typing import Any, cast

import pytest

from teleop.devices.drone.engagement import Stage
from teleop.devices.drone.state import DroneState, drone_state
from teleop.devices.drone.telemetry import Telemetry
from teleop.dji.drone.broadcast_parts import ControlSource, Gimbal, Position, Rc, Velocity
from teleop.dji.drone.enums import ControlDevice, CurrentMode, FlightStatus, RcGear, RcMode


class Seen:
    activated = True

    def __init__(self, **parts: Any) -> None:
        self._parts = parts

    def get(self, part: str, _now: float) -> Any:
        return self._parts.get(part)


def state(**parts: Any) -> DroneState:
    return drone_state(cast(Telemetry, Seen(**parts)), 0.0, Stage.IDLE, {})


def test_places_are_degrees_and_sticks_are_shares() -> None:
    known = state(
        position=Position(math.radians(52.5), math.radians(13.4), 40.0, 2.5, 4),
        rc=Rc(roll=1000, pitch=-2000, yaw=10000, throttle=-5000, mode=RcMode.A, gear=RcGear.UP),
        velocity=Velocity(1.0, 2.0, 3.0),
        gimbal=Gimbal(roll=1.0, pitch=2.0, yaw=3.0),
        status=FlightStatus.FINISH_LANDING,
        control=ControlSource(CurrentMode.ATTI_STOP, ControlDevice.ONBOARD_DEVICE, virtual_rc=True),
    )
    assert (known.latitude, known.longitude, known.height, known.gps_health) == (
        *map(pytest.approx, (52.5, 13.4, 2.5)),
        4,
    )
    assert known.rc == (0.1, -0.2, -0.5, 1.0), "roll, pitch, throttle, yaw: not in the order of the broadcast"
    assert (known.velocity, known.gimbal) == ((1.0, 2.0, 3.0), (1.0, 2.0, 3.0))
    assert (known.rc_mode, known.status) == ("A", "finish landing")
    assert (known.device, known.virtual_rc) == ("onboard device", True)


def test_what_the_drone_does_not_say_is_none_and_not_0() -> None:
    silent = state()
    unsaid = {field.name for field in fields(silent)} - {"stage", "sticks", "activated"}
    assert {getattr(silent, name) for name in unsaid} == {None}


def test_a_velocity_that_the_drone_calls_invalid_is_none() -> None:
    assert state(velocity=Velocity(1.0, 2.0, 3.0, valid=False)).velocity is None


def test_a_switch_or_a_device_without_a_word_is_shown_by_its_number() -> None:
    odd = state(rc=Rc(0, 0, 0, 0, 123, RcGear.UP), control=ControlSource(CurrentMode.ATTI_STOP, 7))
    assert (odd.rc_mode, odd.device) == ("123", "7")

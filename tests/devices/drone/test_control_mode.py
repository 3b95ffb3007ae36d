"""When motors may be touched, and an attitude in degrees: Appendix, Flight status and Flight Data."""

from __future__ import annotations

import math
from typing import Any, cast

import pytest

from teleop.devices.drone.control_mode import attitude, not_in_standby, word_of
from teleop.devices.drone.telemetry import Telemetry
from teleop.dji.drone.broadcast_parts import Quaternion
from teleop.dji.drone.enums import FlightStatus


class Seen:
    """A status that came at 10 s."""

    def __init__(self, status: object) -> None:
        self._status = status

    def get(self, part: str, now: float, within: float = 1.0) -> Any:
        return self._status if part == "status" and now - 10.0 <= within else None


def refusal(status: object, now: float = 10.0) -> str:
    return not_in_standby(cast(Telemetry, Seen(status)), now)


def test_motors_are_touched_in_standby_only() -> None:
    assert refusal(FlightStatus.STANDBY) == ""
    for status in set(FlightStatus) - {FlightStatus.STANDBY}:
        assert refusal(status) == f"the drone reports {status.name.lower().replace('_', ' ')}"
    assert refusal(9) == "the drone reports 9"


def test_a_status_older_than_a_fifth_of_a_second_is_none() -> None:
    assert refusal(FlightStatus.STANDBY, 10.15) == ""
    assert refusal(FlightStatus.STANDBY, 10.25) == "the drone does not report its flight status"


def test_a_number_without_a_word_is_shown_as_it_is() -> None:
    assert (word_of(FlightStatus.IN_AIR), word_of(9)) == ("in air", "9")


HALF = math.sqrt(0.5)


@pytest.mark.parametrize(
    ("numbers", "angles"),
    [
        ((1, 0, 0, 0), (0, 0, 0)),
        ((HALF, HALF, 0, 0), (90, 0, 0)),
        ((math.cos(math.radians(15)), 0, math.sin(math.radians(15)), 0), (0, 30, 0)),
        ((HALF, 0, 0, HALF), (0, 0, 90)),
        ((HALF, 0, 0, -HALF), (0, 0, -90)),
        ((0.5, 0.5, 0.5, 0.5), (90, 0, 90)),  # rolled, then turned
    ],
)
def test_a_quaternion_is_roll_right_nose_up_and_yaw_from_north_to_east(numbers: tuple, angles: tuple) -> None:
    assert attitude(Quaternion(*numbers)) == pytest.approx(angles, abs=1e-9)


def test_a_nose_straight_up_that_is_rounded_beyond_1_is_no_error() -> None:
    assert attitude(Quaternion(0.7071069, 0, 0.7071069, 0))[1] == pytest.approx(90)

"""The gimbal under a simulated drone: OPENProtocol 01 1A and 01 1B."""

from __future__ import annotations

import math

import pytest

from teleop.dji.drone.messages import GimbalAngle, GimbalSpeed
from teleop.sim.drone.payload import SPEED_HOLDS, Payload


def at(payload: Payload, now: float, heading: float = 0.0) -> tuple[float, float, float]:
    reported = payload.reported(now, heading)
    return reported.yaw, reported.roll, reported.pitch


def test_it_reaches_its_angles_in_the_time_that_is_given() -> None:
    payload = Payload()
    payload.point(GimbalAngle(90, 0, -60, duration=2.0), 10.0)
    assert at(payload, 11.0) == pytest.approx((45, 0, -30))
    assert at(payload, 12.0) == pytest.approx((90, 0, -60))


def test_an_axis_that_is_ignored_goes_on_and_one_by_an_amount_starts_from_here() -> None:
    payload = Payload()
    payload.point(GimbalAngle(40, 10, 0, duration=1.0), 0.0)
    payload.point(GimbalAngle(20, 5, 0, absolute=False, roll_ignored=True, pitch_ignored=True, duration=1.0), 2.0)
    assert at(payload, 3.0) == pytest.approx((60, 10, 0))


def test_a_speed_ends_with_its_stream_or_without_the_control_bit() -> None:
    payload = Payload()
    payload.turn(GimbalSpeed(20, 0, 0), 0.0)
    assert at(payload, 10.0)[0] == pytest.approx(20 * SPEED_HOLDS, abs=0.1)
    payload.turn(GimbalSpeed(20, 0, 0, control=False), 20.0)
    assert at(payload, 30.0)[0] == pytest.approx(20 * SPEED_HOLDS, abs=0.1)


@pytest.mark.parametrize(
    ("message", "detail"),
    [
        (GimbalAngle(0, 0, 31, duration=1.0), "pitch must be -90..30 deg, not 31"),
        (GimbalAngle(-321, 0, 0, duration=1.0), "yaw must be -320..320 deg, not -321"),
        (GimbalAngle(320, -35, -90, duration=1.0), ""),
        (GimbalAngle(0, 0, 31, pitch_ignored=True, duration=1.0), ""),
        (GimbalAngle(0, 0, 31, absolute=False, duration=1.0), ""),  # it counts from where it is
    ],
)
def test_an_angle_beyond_the_range_is_named(message: GimbalAngle, detail: str) -> None:
    assert Payload().outside(message) == detail


def test_the_broadcast_counts_yaw_from_north_and_says_which_axis_is_at_its_limit() -> None:
    payload = Payload()
    payload.point(GimbalAngle(90, 0, -90, duration=1.0), 0.0)
    assert at(payload, 2.0, math.radians(135))[0] == pytest.approx(-135)
    reported = payload.reported(2.0, 0.0)
    assert (reported.pitch_limited, reported.roll_limited, reported.yaw_limited) == (True, False, False)

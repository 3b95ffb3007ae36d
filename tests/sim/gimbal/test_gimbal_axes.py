"""What a gimbal's commands make of its axes: docs/protocol-facts.md, "The gimbal's commands" and "Signs"."""

from __future__ import annotations

from typing import Any

import pytest

from teleop.dji.gimbal import messages as gimbal
from teleop.dji.gimbal.enums import AngleKind, Operation
from teleop.dji.message import Message, ReturnCode
from teleop.sim.gimbal.firmware import Firmware
from teleop.sim.gimbal.gimbal_axes import Angles, GimbalAxes

LAG = 0.05
STILL = Angles(0.0, 0.0, 0.0)


def axes(signs: tuple[int, int, int] = (1, 1, 1), continuous: bool = False, **firmware: Any) -> GimbalAxes:
    return GimbalAxes(STILL, Angles(*signs), LAG, Angles(120.0, 60.0, 90.0), continuous, Firmware(**firmware))


def obey(gimbal_axes: GimbalAxes, message: Message, now: float = 0.0) -> Any:
    return gimbal_axes.handlers[type(message)](message, now)


def test_a_position_is_reached_at_constant_speed_and_an_ignored_axis_stays() -> None:
    bench = axes()
    obey(bench, gimbal.Position(40, 20, -10, roll_ignored=True, time_for_action=2.0))
    assert bench.angles(1.0) == pytest.approx((20, 0, -5))
    assert bench.rates(1.0) == pytest.approx((20, 0, -5))
    assert bench.angles(9.0) == pytest.approx((40, 0, -10))


def test_a_position_by_an_amount_starts_from_here() -> None:
    bench = axes()
    obey(bench, gimbal.Position(40, 0, 0, time_for_action=1.0))
    obey(bench, gimbal.Position(-10, 0, 5, absolute=False, time_for_action=1.0), 2.0)
    assert bench.angles(9.0) == pytest.approx((30, 0, 5))


def test_a_target_beyond_a_stop_ends_at_the_stop() -> None:
    bench = axes()
    obey(bench, gimbal.Position(0, 90, 170, time_for_action=1.0))
    assert bench.angles(9.0) == pytest.approx((0, 30, 146))


def test_a_speed_holds_half_a_second() -> None:
    bench = axes()
    obey(bench, gimbal.Speed(60, 0, 0))
    assert bench.rates(0.49).yaw == pytest.approx(60, abs=0.1)
    assert bench.angles(9.0).yaw == pytest.approx(60 * 0.5)
    assert bench.controlled


def test_giving_speed_control_back_stops_it_and_may_leave_the_roll_off_level() -> None:
    bench = axes(roll_error=0.5)
    obey(bench, gimbal.Speed(0, 0, 0, take_over=False))
    assert bench.angles(9.0) == STILL, "it was not under speed control"
    obey(bench, gimbal.Speed(60, 0, 0), 10.0)
    obey(bench, gimbal.Speed(60, 60, 60, take_over=False), 10.4)
    assert not bench.controlled
    assert bench.rates(11.5) == pytest.approx((0, 0, 0), abs=1e-3)
    assert bench.angles(11.5).roll == pytest.approx(0.5)


def test_some_firmware_answers_a_speed_and_does_nothing() -> None:
    bench = axes(ignores_speed=True)
    assert obey(bench, gimbal.Speed(60, 0, 0)) == ReturnCode.OK
    assert bench.angles(9.0) == STILL


def test_angles_speeds_and_reports_have_signs_of_their_own() -> None:
    bench = axes((-1, 1, 1), speed_signs=(1, -1, 1), report_signs=(1, 1, -1))
    obey(bench, gimbal.Position(10, 5, 5, time_for_action=1.0))
    assert bench.angles(2.0) == pytest.approx((-10, 5, 5))
    assert bench.reported(2.0) == pytest.approx((-10, 5, -5))
    obey(bench, gimbal.Speed(10, 10, 0), 2.0)
    assert bench.angles(9.0) == pytest.approx((-5, 0, 5))


@pytest.mark.parametrize(("value", "speed"), [(15_000, 120.0), (-7_500, -60.0), (30_000, 120.0)])
def test_full_stick_is_15000_and_the_speed_of_the_gimbals_own_setting(value: int, speed: float) -> None:
    bench = axes()
    obey(bench, gimbal.Joystick(0, 0, value))
    assert bench.rates(0.49).yaw == pytest.approx(speed, rel=1e-3)


def test_new_limits_hold_at_once_and_only_when_they_are_set() -> None:
    bench = axes()
    obey(bench, gimbal.Position(100, 0, 0, time_for_action=1.0))
    obey(bench, gimbal.SetLimits(10, 20, 40, 50, 5, 6, operation=Operation.NOTHING), 0.1)
    assert bench.limits()["yaw_max"] == 179
    obey(bench, gimbal.SetLimits(10, 20, 40, 50, 5, 6), 0.1)
    assert bench.angles(9.0).yaw < 40, "what was under way may lead beyond the new stop"
    reply = obey(bench, gimbal.Limits())
    assert (reply.pitch_max, reply.pitch_min, reply.yaw_max, reply.yaw_min) == (10, 20, 40, 50)
    assert (reply.roll_max, reply.roll_min) == (5, 6)


def test_a_gimbal_may_report_more_than_the_document_has() -> None:
    assert axes().limits()["pitch_max"] == 145
    assert axes(pitch_max=155).limits()["pitch_max"] == 155


def test_an_axis_that_turns_for_ever_goes_the_short_way_and_reports_half_a_turn() -> None:
    bench = axes(continuous=True)
    obey(bench, gimbal.Position(170, 0, 0, time_for_action=1.0))
    obey(bench, gimbal.Position(-170, 0, 0, time_for_action=1.0), 2.0)
    assert bench.angles(9.0).yaw == pytest.approx(190)
    assert bench.reported(9.0).yaw == pytest.approx(-170)


def test_angles_of_no_kind_are_all_0() -> None:
    bench = axes()
    bench.turn(0.0, Angles(10.0, 5.0, 5.0))
    nothing, joint = (obey(bench, gimbal.Angles(kind), 9.0) for kind in (AngleKind.NONE, AngleKind.JOINT))
    assert (nothing.yaw, nothing.roll, nothing.pitch) == (0, 0, 0)
    assert (joint.kind, joint.yaw, joint.roll, joint.pitch) == (AngleKind.JOINT, *map(pytest.approx, (10, 5, 5)))


def test_a_hand_stops_the_axes_it_holds_and_those_only() -> None:
    bench = axes()
    obey(bench, gimbal.Position(40, 0, 40, time_for_action=1.0))
    bench.hold(0.5, Angles(True, False, False))
    obey(bench, gimbal.Position(0, 20, 0, time_for_action=1.0), 0.6)
    assert bench.angles(9.0) == pytest.approx((20, 20, 0))
    bench.hold(9.0, STILL)
    obey(bench, gimbal.Position(0, 0, 0, time_for_action=1.0), 9.0)
    assert bench.angles(11.0) == pytest.approx(STILL)

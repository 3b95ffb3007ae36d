"""A simulated gimbal with dynamics, on the wire: speeds, deflections and positions, reports, a turned mount."""

from __future__ import annotations

from statistics import stdev
from typing import Any

import pytest
from sim_bench import Bench

from teleop.dji.gimbal import messages as gimbal
from teleop.dji.gimbal.enums import AngleKind
from teleop.sim.gimbal.dynamics import Dynamics

ANGLES = gimbal.Angles(AngleKind.ATTITUDE)
TURN = gimbal.Speed(30.0, 0.0, 10.0, take_over=True, ignore_focal_length=True)
STICK = gimbal.Joystick(pitch=2500, roll=0, yaw=7500)  # 10 and 30 deg/s of 60


def reported(bench: Bench) -> tuple[float, float, float]:
    reply = bench.ask(ANGLES)
    assert isinstance(reply, gimbal.AnglesReply)
    return reply.yaw, reply.roll, reply.pitch


@pytest.mark.parametrize("command", [TURN, STICK], ids=["speed", "stick"])
def test_speeds_and_deflections_have_the_same_dynamics(command: gimbal.Message) -> None:
    bench = Bench(dynamics=Dynamics(lag=0.05, dead_time=0.1, gain=0.9, drift=1.0))
    bench.tell(command)
    bench.wait(0.1)
    assert bench.gimbal.rates == (0, 0, 0)
    bench.wait(0.45)
    assert bench.gimbal.rates == pytest.approx((28.0, 1.0, 10.0), abs=0.01)


def test_each_axis_may_have_its_own() -> None:
    bench = Bench(dynamics=[Dynamics(gain=0.5), Dynamics(drift=2.0), Dynamics(dead_time=0.3)])
    bench.tell(TURN)
    bench.wait(0.29)
    assert bench.gimbal.rates == pytest.approx((15.0, 2.0, 0.0), abs=0.2)


def test_giving_speed_control_back_ends_the_drift() -> None:
    bench = Bench(dynamics=Dynamics(lag=0.0, drift=1.0))
    bench.ask(TURN)
    bench.wait(0.2)
    bench.ask(gimbal.Speed(0.0, 0.0, 0.0, take_over=False, ignore_focal_length=True))
    assert bench.gimbal.rates == (0, 0, 0)


def test_reports_are_as_old_as_set_and_in_steps() -> None:
    bench = Bench(dynamics=[Dynamics(lag=0.0, report_age=0.1), Dynamics(), Dynamics(lag=0.0, resolution=1.0)])
    bench.tell(TURN)
    bench.wait(0.2)
    bench.tell(TURN)
    bench.wait(0.25)
    assert bench.gimbal.angles == pytest.approx((13.5, 0.0, 4.5))
    assert reported(bench) == pytest.approx((10.5, 0.0, 4.0))
    bench.ask(gimbal.PushSettings(gimbal.Switch.ON))
    bench.wait(0.1)
    push = bench.unasked[-1]
    assert isinstance(push, gimbal.Push)
    assert (push.yaw, push.pitch) == pytest.approx((13.5, 6.0))


def test_reports_may_be_noisy_and_get_lost() -> None:
    bench = Bench(dynamics=Dynamics(noise=0.5), lost_readings=0.25)
    for _ in range(400):
        bench.tell(ANGLES)
        bench.wait(0.04)
    yaws = [reply.yaw for reply in bench.unasked if isinstance(reply, gimbal.AnglesReply)]
    assert 270 <= len(yaws) <= 330
    assert stdev(yaws) == pytest.approx(0.5, abs=0.1)
    assert bench.gimbal.angles == (0, 0, 0)


@pytest.mark.parametrize("mount", [180.0, -135.0])
def test_a_mount_may_start_turned_with_the_stops_around_it(mount: float) -> None:
    bench = Bench(mount=mount)
    assert reported(bench) == (mount, 0, 0)
    over = mount + 60.0 if mount < 0 else -120.0
    bench.ask(gimbal.Position(over, 0.0, 0.0, absolute=True, time_for_action=1.0))
    bench.wait(0.5)
    assert bench.gimbal.rates.yaw == pytest.approx(60.0), "the short way, through the seam"
    bench.wait(1.0)
    assert bench.gimbal.angles.yaw == mount + 60.0
    limits = bench.ask(gimbal.Limits(gimbal.Operation.EXECUTE))
    assert isinstance(limits, gimbal.LimitsReply)
    assert (limits.yaw_max, limits.yaw_min) == (179, 179)
    bench.ask(gimbal.Mode(action=gimbal.CenterAction.RECENTER))
    bench.wait(5.0)
    assert abs(reported(bench)[0]) == pytest.approx(abs(mount), abs=0.1)
    bench.gimbal.reboot(bench.now, 0.5)
    bench.wait(1.0)
    assert reported(bench) == (mount, 0, 0)


@pytest.mark.parametrize("at_once", [True, False])
def test_the_payload_may_change_under_way(at_once: bool) -> None:
    heavy = Dynamics(lag=0.0, gain=0.5)
    settings: dict[str, Any] = {} if at_once else {"changes": [(0.3, heavy)]}
    bench = Bench(dynamics=Dynamics(lag=0.0), **settings)
    bench.tell(TURN)
    bench.wait(0.3)
    assert bench.gimbal.rates.yaw == 30.0
    if at_once:
        bench.gimbal.change(bench.now, heavy)
    bench.tell(TURN)
    bench.wait(0.1)
    assert bench.gimbal.rates.yaw == 15.0

"""Positions near a soft limit: untouched with a good gimbal, and short of the limit by as much as it is beyond."""

import pytest

from teleop.core.axes import Axis, Limits, Reading, State
from teleop.core.events import Tick
from teleop.core.setpoints import Stop
from teleop.devices.gimbal.aim_guard import AT_MOST, AimGuard

PAN = {Axis.PAN: Limits(-60, 60, 120, 240, 1200)}


def aims(guard: AimGuard, aim: float, off: float, seconds: float, stop: bool = False, begin: float = 1.0) -> float:
    """The last aim of a gimbal that ends `off` deg from where it is sent, read at 25 Hz."""
    sent = aim
    for number in range(round(seconds / 0.04)):
        now = begin + number * 0.04
        demand = {Axis.PAN: Stop()} if stop else {}
        tick = Tick(now, {Axis.PAN: State(aim)}, demand, (), {Axis.PAN: Reading(round(sent + off, 1), now)})
        sent = guard.aim(Axis.PAN, aim, tick)
    return sent


@pytest.mark.parametrize("side", [1, -1])
def test_what_is_measured_beyond_is_aimed_short(side: int) -> None:
    guard = AimGuard(PAN)
    assert aims(guard, side * 60.0, side * 2.0, 5.0) == pytest.approx(side * 58.0, abs=0.2)
    assert len(guard.lines) == 1
    assert aims(guard, side * 60.0, side * 50.0, 20.0) == pytest.approx(side * (60 - AT_MOST))


@pytest.mark.parametrize("off", [0.0, 0.2, -3.0])
def test_a_good_gimbal_goes_where_it_is_sent(off: float) -> None:
    guard = AimGuard(PAN)
    for aim in (60.0, -60.0, 30.0):
        assert aims(guard, aim, off if aim > 0 else -off, 2.0) == aim
    assert guard.lines == []


def test_inside_the_limit_it_is_another_event() -> None:
    guard = AimGuard(PAN)
    aims(guard, 60.0, 2.0, 3.0)
    assert aims(guard, 50.0, 2.0, 0.2, begin=10.0) == 50.0
    aims(guard, 60.0, 2.0, 3.0, begin=20.0)
    assert len(guard.lines) == 2


def test_a_stop_and_a_plan_outside_are_left_alone() -> None:
    guard = AimGuard(PAN)
    assert aims(guard, 60.0, 5.0, 2.0, stop=True) == 60.0
    assert aims(guard, 70.0, 2.0, 2.0) == 70.0
    assert guard.lines == []

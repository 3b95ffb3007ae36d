"""What the guard lets through: by the reading, what is under way, and the stop that is left."""

import math

import pytest

from teleop.core.axes import Axis, Limits, Reading, State
from teleop.core.events import Tick
from teleop.core.setpoints import Stop
from teleop.devices.gimbal.limit_guard import BACK_AT_MOST, BEYOND, LimitGuard
from teleop.identification.estimator import ResponseEstimator

PAN = Limits(-60, 60, 120, 240, 1200)
PERIOD = 0.02


def guarded(
    place: float, speed: float, limits: Limits = PAN, plan: float = 0.0, sent: float = 0.0, stop: bool = False
) -> tuple[float, LimitGuard]:
    """What is sent of `speed` by an axis that is read at `place`, with `sent` (deg/s) under way for 0.1 s."""
    estimator = ResponseEstimator()
    estimator.read(Reading(place, 1.0))
    if sent:
        estimator.sent(1.0, sent)
        estimator.sent(1.1, 0.0)
    guard = LimitGuard({Axis.PAN: limits}, PERIOD, {Axis.PAN: estimator})
    demand = {Axis.PAN: Stop()} if stop else {}
    tick = Tick(1.1, {Axis.PAN: State(plan)}, demand, (), {})
    return guard.speeds(tick, {Axis.PAN: speed})[Axis.PAN], guard


@pytest.mark.parametrize("side", [1, -1])
@pytest.mark.parametrize("room", [0.5, 5.0, 15.0])
def test_a_speed_is_let_through_from_which_it_can_stop(side: int, room: float) -> None:
    allowed, guard = guarded(side * (60 - room), side * 120.0)
    stop = allowed**2 / (2 * PAN.acceleration) + abs(allowed) * PERIOD / 2
    assert 0 < side * allowed < 120
    assert 0.6 * (room + BEYOND) <= stop <= room + BEYOND  # an unknown gain may be higher
    assert len(guard.lines) == 1


def test_far_from_a_limit_and_away_from_one_nothing_is_held_back() -> None:
    for place, speed in ((0.0, 80.0), (59.9, -120.0), (-59.9, 120.0)):
        allowed, guard = guarded(place, speed)
        assert allowed == speed
        assert guard.lines == []


def test_what_is_under_way_counts_as_far_as_the_slowest_gimbal_would_still_go() -> None:
    assert guarded(50.0, 80.0)[0] > guarded(50.0, 80.0, sent=50.0)[0]
    assert guarded(55.0, 80.0, sent=60.0)[0] < 0  # more than is left


def test_beyond_a_limit_it_is_sent_back_gently_and_not_during_a_stop() -> None:
    for place in (61.0, 65.0, 100.0):
        assert -BACK_AT_MOST <= guarded(place, 20.0)[0] < 0
        assert guarded(-place, -20.0)[0] > 0
        assert guarded(place, 20.0, stop=True)[0] == 0


def test_an_axis_that_is_planned_outside_is_left_to_its_plan() -> None:
    allowed, guard = guarded(70.0, 0.0, plan=70.0)
    assert allowed == 0.0
    assert guard.lines == []


def test_an_axis_without_limits_or_readings_is_not_held_back() -> None:
    endless = Limits(-math.inf, math.inf, 120, 240, 1200)
    assert guarded(1e4, 120.0, endless)[0] == 120.0
    guard = LimitGuard({Axis.PAN: PAN}, PERIOD, {Axis.PAN: ResponseEstimator()})
    assert guard.speeds(Tick(1.0, {Axis.PAN: State(0)}, {}, (), {}), {Axis.PAN: 120.0}) == {Axis.PAN: 120.0}

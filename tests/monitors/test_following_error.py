"""The stall guard: what it takes for lag, what for a hand, and what for blindness."""

from __future__ import annotations

import math
from collections.abc import Callable

import pytest
from hypothesis import given
from hypothesis import strategies as st

from teleop.core.axes import Axis, Limits, Reading, State
from teleop.core.errors import DeviceError
from teleop.core.events import Tick
from teleop.monitors.following_error import BLIND, EXCESS_TIMEOUT, GIVEN_UP, OBEYS_FOR, TRAILING, FollowingErrorGuard

BOUNDED, ENDLESS = Limits(-180, 180, 120, 240, 1200), Limits(-math.inf, math.inf, 120, 240, 1200)

Track = Callable[[float], float]


def watch(
    commanded: Track,
    measured: Track,
    seconds: float = 5.0,
    *,
    limits: Limits = BOUNDED,
    delay: float = 0.0,
    rate: float = 25,
) -> float:
    """When the guard stopped the run, in s; inf if it did not. Readings come `rate` times a second."""
    guard = FollowingErrorGuard({Axis.PAN: limits}, {Axis.PAN: 5.0}, {Axis.PAN: delay})
    for number in range(round(seconds * 100)):
        now = number / 100
        at = math.floor(now * rate + 1e-9) / rate
        reported = {Axis.PAN: Reading(measured(at), at)}
        try:
            guard.observe(Tick(now, {Axis.PAN: State(commanded(now))}, {}, (), reported))
        except DeviceError:
            return now
    return math.inf


def test_an_axis_that_stays_behind_is_said_with_both_places() -> None:
    guard = FollowingErrorGuard({Axis.PAN: BOUNDED}, {Axis.PAN: 5.0}, {})
    ticks = [Tick(n / 100, {Axis.PAN: State(12.0)}, {}, (), {Axis.PAN: Reading(3.1, n / 100)}) for n in range(100)]
    said = r"^pan does not follow: commanded 12\.0, measured 3\.1: is it blocked, or held by hand\?$"
    with pytest.raises(DeviceError, match=said):
        list(map(guard.observe, ticks))


@pytest.mark.parametrize("delay", [0.0, 0.3])
def test_lag_is_not_a_stall_whatever_the_speed_and_turning_round_neither(delay: float) -> None:
    def swing(time: float) -> float:
        return 60 * math.sin(2 * time)

    assert watch(swing, lambda t: swing(t - delay - 0.9 * TRAILING), 10, delay=delay) == math.inf
    assert watch(swing, lambda t: swing(t - delay - TRAILING - 0.8), 10, delay=delay) < 10


def test_it_takes_half_a_second_without_a_break() -> None:
    assert watch(lambda _t: 0.0, lambda t: 9.0 if t > 1 else 0.0) == pytest.approx(1 + EXCESS_TIMEOUT, abs=0.1)
    assert watch(lambda _t: 0.0, lambda t: 9.0 if t % 0.5 < 0.4 else 0.0) == math.inf


def test_a_gimbal_that_says_so_once_a_second_is_judged_by_what_it_says() -> None:
    assert watch(lambda t: 60 * t, lambda t: 60 * t, 3, rate=1) == math.inf
    assert watch(lambda t: 20 * t, lambda _t: 0.0, 5, rate=1) == pytest.approx(2.0, abs=0.01)


def test_readings_that_stop_are_blindness_even_at_rest() -> None:
    assert watch(lambda _t: 0.0, lambda _t: 0.0, 10, rate=0.1) == pytest.approx(BLIND, abs=0.02)
    guard = FollowingErrorGuard({Axis.PAN: BOUNDED}, {Axis.PAN: 5.0}, {})
    motion = {Axis.PAN: State(0.0)}
    guard.observe(Tick(100.0, motion, {}, (), {Axis.PAN: Reading(0.0, 1.0)}))  # from before the run
    with pytest.raises(DeviceError, match=r"^pan: no position has been reported for 2\.5 s$"):
        guard.observe(Tick(102.6, motion, {}, (), {Axis.PAN: Reading(0.0, 1.0)}))


@given(st.integers(-5, 5))
def test_a_turn_more_or_less_is_the_same_place_for_an_axis_without_stops(turns: int) -> None:
    def commanded(time: float) -> float:
        return 300 * time

    assert watch(commanded, lambda t: commanded(t) + 360 * turns, 2, limits=ENDLESS) == math.inf
    assert watch(commanded, lambda t: commanded(t) + 360 * turns + 90, 2, limits=ENDLESS) < 2


def test_axes_that_are_not_watched_or_not_in_use_are_left_alone() -> None:
    guard = FollowingErrorGuard({Axis.PAN: BOUNDED}, {Axis.PAN: 5.0}, {})
    for number in range(1000):
        guard.observe(Tick(number / 100, {Axis.FOCUS: State(1.0)}, {}, (), {Axis.FOCUS: Reading(0.0, number / 100)}))


def test_an_axis_that_goes_where_it_is_sent_is_given_longer_and_is_not_said_to_be_held() -> None:
    asked: list[float] = []

    def obeys(_axis: Axis, since: float) -> bool:
        asked.append(since)
        return True

    guard = FollowingErrorGuard({Axis.PAN: BOUNDED}, {Axis.PAN: 5.0}, {}, obeys=obeys)
    ticks = [Tick(n / 100, {Axis.PAN: State(12.0)}, {}, (), {Axis.PAN: Reading(3.1, n / 100)}) for n in range(600)]
    soon = round(100 * GIVEN_UP)
    list(map(guard.observe, ticks[:soon]))
    with pytest.raises(DeviceError, match=r"^pan does not come closer: commanded 12\.0, measured 3\.1$"):
        list(map(guard.observe, ticks[soon : soon + 5]))
    assert asked[0] == pytest.approx(EXCESS_TIMEOUT - OBEYS_FOR, abs=0.02)


@pytest.mark.parametrize("obeyed", [False, None])
def test_an_axis_that_does_not_or_is_unknown_is_stopped_as_soon_as_ever(obeyed: bool | None) -> None:
    guard = FollowingErrorGuard({Axis.PAN: BOUNDED}, {Axis.PAN: 5.0}, {}, obeys=lambda _axis, _since: obeyed)
    ticks = [Tick(n / 100, {Axis.PAN: State(12.0)}, {}, (), {Axis.PAN: Reading(3.1, n / 100)}) for n in range(60)]
    with pytest.raises(DeviceError, match="does not follow"):
        list(map(guard.observe, ticks))

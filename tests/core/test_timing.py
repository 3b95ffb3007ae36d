"""The loop's rate is a whole number for any period it runs at, so that its times stay on a grid."""

from __future__ import annotations

import pytest

from teleop.core.timing import DEFAULTS, RATE, LoopTiming


@pytest.mark.parametrize(
    ("period", "rate"), [(0.01, 100), (0.02, 50), (1 / 30, 30), (1 / 3, 3), (0.007, 142.857142857)]
)
def test_the_rate_is_rid_of_the_rounding_of_the_period(period: float, rate: float):
    assert LoopTiming(period).rate == rate


def test_times_do_not_drift_from_the_grid_in_a_day():
    ticks = 24 * 3600 * 30
    assert ticks / LoopTiming(1 / 30).rate == 24 * 3600


def test_a_run_without_a_timing_of_its_own_ticks_at_the_usual_rate_and_keeps_devices_alive():
    assert DEFAULTS.rate == RATE
    assert DEFAULTS.period < DEFAULTS.keep_alive < 0.5  # s after which a gimbal forgets a speed

"""The score of a run: errors at the time of each reading, counted once, from the begin on."""

import math

import pytest

from teleop.core.axes import Axis, Reading, State
from teleop.core.events import Tick
from teleop.monitors.tracking_error import TrackingErrorMonitor


def tick(time: float, commanded: float, measured: float, measured_at: float) -> Tick:
    return Tick(time, {Axis.PAN: State(commanded)}, {}, (), {Axis.PAN: Reading(measured, measured_at)})


def test_a_reading_is_compared_with_what_was_commanded_at_its_own_time() -> None:
    tally = TrackingErrorMonitor(lambda: 0.0)
    for number in range(20):
        now = number / 10
        tally.observe(tick(now, 10 * now, 10 * (now - 0.25), now - 0.25))  # old, and exactly on course
    assert tally.scores[Axis.PAN].readings == 17
    assert tally.scores[Axis.PAN].peak == pytest.approx(0, abs=1e-9)


def test_rms_and_peak_are_over_readings_not_over_ticks() -> None:
    tally = TrackingErrorMonitor(lambda: 0.0)
    for now, measured, at in ((1.0, -3.0, 1.0), (1.1, -3.0, 1.0), (1.2, -3.0, 1.0), (1.3, 4.0, 1.3)):
        tally.observe(tick(now, 0.0, measured, at))
    score = tally.scores[Axis.PAN]
    assert (score.readings, score.peak) == (2, 4.0)
    assert score.rms == pytest.approx(math.sqrt((9 + 16) / 2))
    assert tally.ends(Axis.PAN) == (0.0, 4.0)


def test_what_was_measured_before_the_begin_does_not_count() -> None:
    tally = TrackingErrorMonitor(lambda: 5.0)
    tally.observe(tick(4.0, 0.0, 90.0, 4.0))
    assert tally.scores == {}
    assert tally.seconds == 0
    tally.observe(tick(6.0, 0.0, 1.0, 6.0))
    assert (tally.scores[Axis.PAN].readings, tally.seconds) == (1, 1.0)

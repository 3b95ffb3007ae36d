"""The delay is found whatever the axis's scale, offset and drift; where nothing tells, the doubt says so."""

from __future__ import annotations

import math

import pytest

from teleop.core.axes import Axis, Reading, State
from teleop.core.events import Tick
from teleop.monitors.delay_estimate import Traces, estimate

COMMANDED = [(number / 100, math.sin(2 * number / 100)) for number in range(-100, 701)]


def measured(delay: float, scale: float = 1.0, offset: float = 0.0, drift: float = 0.0) -> list[tuple[float, float]]:
    times = [number / 25 for number in range(150)]
    return [(time, scale * math.sin(2 * (time - delay)) + offset + drift * time) for time in times]


@pytest.mark.parametrize("delay", [0.0, 0.123, 0.35])
@pytest.mark.parametrize(("scale", "offset", "drift"), [(1.0, 0.0, 0.0), (0.95, 3.0, 0.1)])
def test_a_delay_is_told_from_a_scale_an_offset_and_a_drift(delay: float, scale: float, offset: float, drift: float):
    found = estimate(COMMANDED, measured(delay, scale, offset, drift), 0.0, 6.0)
    assert found is not None
    assert found.seconds == pytest.approx(delay, abs=0.001)
    assert found.scale == pytest.approx(scale, abs=0.001)
    assert found.rms < 1e-3
    assert found.doubt < 0.001


def test_only_readings_of_the_given_time_count():
    late = [(time, place if time < 3 else 99.0) for time, place in measured(0.2)]
    found = estimate(COMMANDED, late, 0.0, 2.9)
    assert found is not None
    assert found.seconds == pytest.approx(0.2, abs=0.001)


def test_too_few_readings_or_an_axis_that_did_not_move_tell_nothing():
    assert estimate(COMMANDED, measured(0.1)[:9], 0.0, 6.0) is None
    assert estimate(COMMANDED, measured(0.1)[:10], 0.0, 6.0) is not None
    assert estimate(COMMANDED, [(time, 5.0) for time, _ in measured(0.1)], 0.0, 6.0) is None


def test_a_steady_speed_leaves_every_doubt():
    line = [(number / 100, number / 100) for number in range(-100, 701)]
    found = estimate(line, [(number / 25, number / 25 - 0.2) for number in range(150)], 0.0, 6.0)
    assert found is not None
    assert math.isinf(found.doubt)


def test_traces_keep_every_command_and_each_reading_once():
    traces = Traces(Axis.PAN)
    for time, reading in (
        (1.0, None),
        (1.01, Reading(0.5, 0.99)),
        (1.02, Reading(0.5, 0.99)),
        (1.03, Reading(0.6, 1.03)),
    ):
        reported = {} if reading is None else {Axis.PAN: reading}
        traces.observe(Tick(time, {Axis.PAN: State(time * 2)}, {}, (), reported))
    assert traces.commanded == [(time, 2 * time) for time in (1.0, 1.01, 1.02, 1.03)]
    assert traces.measured == [(0.99, 0.5), (1.03, 0.6)]

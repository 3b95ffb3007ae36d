"""Rate dividers count ticks: even to one tick and exact in the mean, however long the computer has been up."""

from __future__ import annotations

import math
from itertools import pairwise

import pytest
from fakes import PlacedReporter, RecordingSink, ScriptedSource, cruising

from teleop.core.axes import Axis, Limits, State
from teleop.core.clock import VirtualClock
from teleop.core.control_loop import ControlLoop
from teleop.core.setpoints import VelocityTarget
from teleop.core.timing import PERIOD, RATE
from teleop.devices.rate_divider import RateDivider
from teleop.planner.live import Live

UPTIMES = [0.0, 0.1234567, 1e6, 1e6 + 1 / 3, 1e9]  # s: now, 11.6 days, 31 years
RATES = [25, 50, 100, 3, 7, 30]  # Hz
HOURS = 3 * 3600 * RATE  # ticks
LIMITS = {Axis.PAN: Limits(-1e9, 1e9, 60, 120, 600)}


@pytest.mark.parametrize("uptime", UPTIMES)
@pytest.mark.parametrize("rate", RATES)
def test_hours_of_ticks_are_divided_evenly(rate: int, uptime: float) -> None:
    pace = RateDivider(rate)
    sent = [tick for tick in range(HOURS) if pace.due(uptime + tick / RATE)]
    gaps = {after - before for before, after in pairwise(sent)}
    assert gaps <= {math.floor(RATE / rate), math.ceil(RATE / rate)}
    assert len(sent) == math.ceil(HOURS * rate / RATE)
    for number, tick in enumerate(sent):  # each at the first tick that is not before its moment
        assert tick == -(-number * RATE // rate)


@pytest.mark.parametrize("uptime", UPTIMES)
def test_a_tick_that_was_missed_is_not_made_up_for(uptime: float) -> None:
    pace = RateDivider(50)
    ticks = [*range(100), *range(102, 200), *range(203, 300), *range(350, 500)]
    sent = [tick for tick in ticks if pace.due(uptime + tick / RATE)]
    assert min(after - before for before, after in pairwise(sent)) >= 1
    late = [before for before, after in pairwise(sent) if after - before == 1]
    assert len(late) <= 1, "one that was a tick late is followed in time"


def test_what_begins_to_move_is_sent_at_once_and_the_rhythm_begins_there() -> None:
    pace, still, moving = RateDivider(25), {Axis.PAN: State(0.0)}, {Axis.PAN: State(0.0, 1.0)}
    sent = [tick for tick in range(100) if pace.due(1e6 + tick / RATE, moving if tick >= 41 else still)]
    assert sent == [*range(0, 41, 4), *range(41, 100, 4)]


@pytest.mark.parametrize("uptime", UPTIMES)
def test_the_loop_has_a_tick_each_period_and_its_sinks_their_rates(uptime: float) -> None:
    """Ten minutes of a real loop; its grid is the sinks' clock."""
    clock, sink, seconds = VirtualClock(uptime), RecordingSink(), 600.0
    ControlLoop(
        clock,
        Live(LIMITS, PERIOD),
        LIMITS,
        [cruising(Axis.PAN, 10, seconds)],
        [sink],
        [PlacedReporter({Axis.PAN: 0.0})],
    ).run()
    gaps = [after.time - before.time for before, after in pairwise(sink.ticks)]
    assert max(gaps) == pytest.approx(PERIOD, abs=1e-6)
    assert min(gaps) == pytest.approx(PERIOD, abs=1e-6)
    for rate in RATES:
        pace = RateDivider(rate)
        sent = [tick.time for tick in sink.ticks if pace.due(tick.time)]
        spaces = [after - before for before, after in pairwise(sent)]
        assert max(spaces) - min(spaces) < PERIOD + 1e-6
        assert (sent[-1] - sent[0]) / (len(sent) - 1) == pytest.approx(1 / rate, abs=PERIOD / len(sent) + 1e-9)


@pytest.mark.parametrize("uptime", UPTIMES)
def test_a_loop_that_rests_wakes_at_the_very_tick_of_a_change(uptime: float) -> None:
    """Thousands of changes, each on the grid: none is a tick late."""
    clock, sink, changes = VirtualClock(uptime), RecordingSink(), 2000

    class Blinking(ScriptedSource):
        """Moves for 20 ms every 2.5 s."""

        def next_change(self, now: float) -> float:
            number = math.floor((now - self.begin) / 2.5 + 1e-6)
            if number >= changes - 1:
                return math.inf
            inside = now - self.begin - number * 2.5
            return now if inside < 0.02 - 1e-6 else self.begin + (number + 1) * 2.5

    def demand(elapsed: float):
        return {Axis.PAN: VelocityTarget(1.0)} if math.fmod(elapsed + 1e-6, 2.5) < 0.02 - 1e-6 else {}

    source = Blinking(demand, math.inf)
    ControlLoop(clock, Live(LIMITS, PERIOD), LIMITS, [source], [sink], [PlacedReporter({Axis.PAN: 0.0})]).run()
    before, starts = 0.0, []
    for tick in sink.ticks:
        velocity = tick.motion[Axis.PAN].velocity
        if velocity and not before:
            starts.append(tick.time - source.begin)
        before = velocity
    assert len(starts) == changes
    for number, start in list(enumerate(starts))[1:]:  # the first tick of a run is the one after its start
        assert start == pytest.approx(number * 2.5, abs=PERIOD / 2)

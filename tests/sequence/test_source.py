"""Playing a performance: ease, preroll, the move on its own clock, cues once, and when to be asked again."""

import math
from typing import Any

import pytest
from fakes import NO_FEEDBACK

from teleop.core.axes import Axis, Limits, State
from teleop.core.events import Action
from teleop.core.setpoints import StateTarget
from teleop.planner.keyframes.planner import Key, plan
from teleop.sequence.compile import PREROLL, CompiledSequence, Cue
from teleop.sequence.cycle import Cycle
from teleop.sequence.phases import SequencePhase
from teleop.sequence.source import SequenceSource

LIMITS = {Axis.PAN: Limits(-180, 180, 60, 120, 600), Axis.TILT: Limits(-56, 146, 60, 120, 600)}


def started(here: float = 0.0, cues: list[Cue] | None = None) -> SequenceSource:
    keys = {Axis.PAN: [Key(0, 10), Key(4, 30, hold=100), Key(110, 0)], Axis.TILT: [Key(2, 5)]}
    source = SequenceSource(CompiledSequence("Test", plan(keys, LIMITS), cues or [], [], keys), LIMITS)
    source.start(5.0, {Axis.PAN: State(here), Axis.TILT: State(5.0)})
    return source


def test_it_eases_from_where_the_axes_are_and_waits_the_preroll() -> None:
    source = started(here=-20)
    first = source.read(5.0, NO_FEEDBACK)[0][Axis.PAN]
    assert isinstance(first, StateTarget)
    assert first.position == pytest.approx(-20)
    assert source.next_change(5.0) == 5.0
    assert 5.0 < source.begin < 9.0
    assert source.begin * 100 == pytest.approx(round(source.begin * 100), abs=1e-6)
    waiting = source.begin - PREROLL / 2
    assert source.read(waiting, NO_FEEDBACK)[0][Axis.PAN] == StateTarget(10, 0, 0)
    assert source.next_change(waiting) == source.begin


def test_it_rests_longer_before_the_first_pass_where_that_is_needed() -> None:
    keys, needed = {Axis.PAN: [Key(0, 10), Key(4, 30)]}, [1.5]
    compiled = CompiledSequence("Test", plan(keys, LIMITS), [], [], keys)

    def begun(**cycle: Any) -> SequenceSource:
        source = SequenceSource(compiled, LIMITS, cycle=Cycle(**cycle))
        source.rest_needed = lambda: needed[0]
        source.start(5.0, {Axis.PAN: State(10.0)})
        return source

    assert begun(preroll=0.5).begin == 6.5
    assert begun(preroll=4.0).begin == 9.0
    source = begun(preroll=0.5, passes=2)
    tick, arrival = 500, 0.0
    while source.number == 1 or source.phase is SequencePhase.EASING:
        arrival, tick = source.until, tick + 1
        source.read(tick / 100, NO_FEEDBACK)
    assert source.until - arrival == pytest.approx(0.5), "only before the first"
    needed[0] = 0.0
    known = begun(preroll=0.5)
    assert known.begin == 5.5
    needed[0] = 1.5  # what was thought of the axes turned out wrong on the way there
    known.read(5.0, NO_FEEDBACK)
    assert known.begin == 6.5


def test_the_move_runs_on_its_own_clock_and_rests_are_slept_over() -> None:
    source = started(here=10)
    assert source.begin == 5.0 + PREROLL
    assert source.next_change(source.begin + 1) == source.begin + 1
    assert source.read(source.begin + 4, NO_FEEDBACK)[0][Axis.PAN] == StateTarget(30, 0, 0)
    assert source.next_change(source.begin + 4) == source.begin + 104
    assert source.next_change(source.begin + 105) == source.begin + 105
    source.read(source.begin + 110, NO_FEEDBACK)
    assert math.isinf(source.next_change(source.begin + 110))
    assert source.read(source.begin + 1000, NO_FEEDBACK)[0][Axis.PAN] == StateTarget(0, 0, 0)


def test_cues_are_given_once_and_keep_it_awake() -> None:
    source = started(here=10, cues=[Cue(0, Action.RECORD), Cue(50, Action.SHUTTER), Cue(120, Action.STOP)])
    assert source.read(source.begin - 0.01, NO_FEEDBACK)[1] == []
    assert source.read(source.begin, NO_FEEDBACK)[1] == [Action.RECORD]
    assert source.read(source.begin + 0.01, NO_FEEDBACK)[1] == []
    assert source.next_change(source.begin + 10) == source.begin + 50
    assert source.read(source.begin + 50.02, NO_FEEDBACK)[1] == [Action.SHUTTER]
    assert source.next_change(source.begin + 110) == source.begin + 120
    assert source.read(source.begin + 120, NO_FEEDBACK)[1] == [Action.STOP]
    assert math.isinf(source.next_change(source.begin + 120))


def test_what_it_foresees_is_what_it_demands_later_from_the_ease_to_the_end() -> None:
    source = started(-5.0)
    foreseen: dict[int, float] = {}
    for number in range(1000):
        now = 5.0 + number / 100
        target = source.read(now, NO_FEEDBACK)[0][Axis.PAN]
        assert isinstance(target, StateTarget)
        assert target.position == pytest.approx(foreseen.get(number, target.position), abs=1e-9)
        foreseen[number + 10] = source.foreseen(now + 0.1)[Axis.PAN].position
    assert source.begin < 9.0

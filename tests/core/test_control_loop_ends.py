"""A run can always be ended: whatever raises for ever, or answers nonsense for ever, in whatever place."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any

import pytest
from fakes import PlacedReporter, RecordingSink, cruising
from hypothesis import example, given
from hypothesis import strategies as st

from teleop.core.axes import Axis, Limits, Reading, State
from teleop.core.clock import VirtualClock
from teleop.core.control_loop import AT_ONCE, STALL, ControlLoop
from teleop.core.errors import DeviceError, Interrupted, LeaveAtOnce, LinkError
from teleop.core.run_state import Result, RunState
from teleop.core.timing import PERIOD
from teleop.planner.live import Live

LIMITS = {Axis.PAN: Limits(-180, 180, 60, 120, 600), Axis.TILT: Limits(-56, 146, 60, 120, 600)}
PLACES = {Axis.PAN: 10.0, Axis.TILT: -5.0}
BREAKS = 1.0  # s after which it goes wrong, for ever
ENDS_WITHIN = 16.0  # s of the loop's time: stopping (5 s at most for these axes) and releasing (10 s at most)
NAN, INF = math.nan, math.inf
ERRORS = [
    ZeroDivisionError("a defect"),
    KeyError("pan"),
    LinkError("gone"),
    DeviceError("no"),
    Interrupted("enough"),
    SystemExit(3),
    GeneratorExit(),
    MemoryError(),
    KeyboardInterrupt(),
]


class Stage:
    """A run whose pieces can each be broken from BREAKS on; `turns` counts the sleeps, which bound a run too."""

    def __init__(self) -> None:
        self.clock = VirtualClock()
        self.planner = Live(LIMITS, PERIOD)
        self.source = cruising(Axis.PAN, 50, end=3.0)
        self.sink, self.healthy = RecordingSink(), RecordingSink(steps=3)
        self.reporter = PlacedReporter(PLACES)
        self.loop = ControlLoop(
            self.clock, self.planner, LIMITS, [self.source], [self.sink, self.healthy], [self.reporter]
        )
        self.turns = 0
        turn = self.loop.turn

        def counted() -> None:
            self.turns += 1
            assert self.turns < 10_000, f"it does not end: {self.loop.supervisor}"
            turn()

        self.loop.turn = counted  # type: ignore[method-assign]

    def target(self, place: str) -> tuple[object, str]:
        piece, name = place.split(".")
        return getattr(self, piece), name

    def breaks(self, place: str, what: Callable[..., Any], at: float = BREAKS) -> None:
        piece, name = self.target(place)
        right = getattr(piece, name)

        def call(*arguments: Any) -> Any:
            late = self.loop._time(self.loop._ticks) >= at - 1e-9  # the clock itself may be what is broken
            return what(*arguments) if late else right(*arguments)

        setattr(piece, name, call)

    def run(self) -> None:
        self.loop.run()
        assert self.loop.supervisor.state is RunState.OVER
        assert self.loop._time(self.loop._ticks) < BREAKS + ENDS_WITHIN


def raises(error: BaseException) -> Callable[..., Any]:
    def call(*_arguments: Any) -> Any:
        raise error

    return call


PLACES_OF_CALLS = [
    "clock.now",
    "clock.sleep_until",
    "planner.step",
    "planner.reset",
    "source.read",
    "source.next_change",
    "sink.write",
    "sink.release",
    "reporter.report",
]


def each_place_alone(test: Callable[..., None]) -> Callable[..., None]:
    """A single broken place is drawn too seldom: each is tried in every run."""
    for place in PLACES_OF_CALLS:
        test = example(places={place}, error=ERRORS[0], stalls=False, interrupted=False)(test)
    return test


def nonsense(now: float) -> Sequence[dict[Axis, Reading]]:
    return [
        {},
        {Axis.PAN: Reading(NAN, now)},
        {Axis.PAN: Reading(10.0, NAN)},
        {Axis.PAN: Reading(INF, INF), Axis.TILT: Reading(-INF, now)},
        {Axis.PAN: Reading(1e300, now + 1e9)},
        {Axis.PAN: Reading(math.fmod(now * 1e3, 7.0), BREAKS + 0.5)},  # one moment, many places
        {Axis.PAN: Reading(1e300 * math.sin(now * 1e3), now)},
    ]


@given(
    places=st.sets(st.sampled_from(PLACES_OF_CALLS), min_size=1),
    error=st.sampled_from(ERRORS),
    stalls=st.booleans(),
    interrupted=st.booleans(),
)
@each_place_alone
def test_whatever_raises_for_ever_the_run_ends(
    places: set[str], error: BaseException, stalls: bool, interrupted: bool
) -> None:
    stage = Stage()
    for place in places:
        stage.breaks(place, raises(error))
    if stalls and "clock.sleep_until" not in places:
        _stall_once(stage)
    if interrupted:
        stage.breaks("source.read", lambda _now, _feedback: ({}, stage.loop.interrupt("SIGINT received") or ()))
    stage.run()
    if stalls or interrupted or places != {"planner.reset"}:  # which is asked only at the start and after a stall
        assert stage.loop.supervisor.result is not Result.DONE
    assert stage.healthy.released, "the other device is released all the same"


@given(kind=st.integers(0, 6), stalls=st.booleans())
def test_whatever_is_reported_for_ever_the_run_ends(kind: int, stalls: bool) -> None:
    stage = Stage()
    stage.breaks("reporter.report", lambda now: nonsense(now)[kind])
    if stalls:
        _stall_once(stage)
    stage.breaks("source.read", raises(ZeroDivisionError("a defect")), at=BREAKS + 0.1)
    stage.run()
    assert stage.healthy.released
    for tick in stage.healthy.ticks:
        assert all(math.isfinite(sum(state)) for state in tick.motion.values())
        assert all(abs(state.position) < 1e3 for state in tick.motion.values()) or kind in (4, 6)


@pytest.mark.parametrize("again", [NAN, INF, "soon", object(), -INF, 0.0])
def test_whatever_a_release_answers_the_run_ends(again: object) -> None:
    stage = Stage()
    stage.breaks("sink.release", lambda _now: again)
    stage.breaks("source.read", raises(ZeroDivisionError("a defect")))
    stage.run()
    assert len(stage.healthy.released) == 3


def test_a_computer_that_stalls_in_every_tick_ends_the_run_too() -> None:
    """As with a driver that takes 0.3 s for each call: the search after a stall never ends by itself."""
    stage = Stage()
    sleep = stage.clock.sleep_until
    stage.breaks("clock.sleep_until", lambda time: sleep(time + STALL + 0.1))
    stage.run()
    assert stage.loop.supervisor.reasons[0] == "the computer stalled for 0.35 s"
    assert stage.loop.supervisor.reasons[-1] == "the axes did not come to rest in time: released as they are"
    assert len(stage.healthy.released) == 3


def test_a_planner_that_cannot_be_put_where_the_axes_are_is_not_asked_again() -> None:
    """It would go on from where it was before the stall."""
    stage = Stage()
    _stall_once(stage)
    stage.breaks("planner.reset", raises(ZeroDivisionError("a defect")))
    stage.breaks("reporter.report", lambda now: {Axis.PAN: Reading(33.0 + now, now), Axis.TILT: Reading(-5.0, now)})
    stage.run()
    after = [tick.motion[Axis.PAN] for tick in stage.healthy.ticks if tick.time > BREAKS + STALL]
    assert after
    assert all(34 < state.position < 37 for state in after)
    assert after[-1] == State(after[-1].position)


@pytest.mark.parametrize("hung", ["sink.write", "source.read", "planner.step", "clock.sleep_until", "sink.release"])
def test_leaving_at_once_is_one_attempt_to_release_every_device(hung: str) -> None:
    """What a signal handler raises out of a call that hangs gets past everything, and the devices are released."""
    stage = Stage()
    stage.breaks(hung, raises(LeaveAtOnce("SIGINT")))
    if hung == "sink.release":
        stage.breaks("source.read", raises(ZeroDivisionError("a defect")))
    begun: list[float] = []
    stage.breaks("healthy.write", lambda tick: begun.append(tick.time))
    with pytest.raises(LeaveAtOnce):
        stage.run()
    if hung in ("sink.write", "source.read", "planner.step"):
        assert len(stage.healthy.released) == 3
        assert len(stage.sink.released) == 1
    assert stage.clock.now() < BREAKS + 0.6 + AT_ONCE


def test_what_fails_while_leaving_at_once_is_asked_once_and_keeps_nothing_else() -> None:
    stage, asked = Stage(), []
    stage.breaks("sink.write", raises(LeaveAtOnce("SIGINT")))
    stage.breaks("sink.release", lambda now: asked.append(now) or raises(LinkError("gone"))())
    stage.breaks("reporter.report", raises(LinkError("gone")))
    with pytest.raises(LeaveAtOnce):
        stage.run()
    assert len(asked) == 1
    assert len(stage.healthy.released) == 3


def _stall_once(stage: Stage) -> None:
    sleep, stalled = stage.clock.sleep_until, []

    def once(time: float) -> None:
        sleep(time if stalled else time + STALL + 0.1)
        stalled.append(time)

    stage.breaks("clock.sleep_until", once, at=BREAKS - 0.05)

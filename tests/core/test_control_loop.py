"""The loop: what a run looks like from its sinks, and that every fault ends in rest, release and a reason."""

import math
import random
from collections.abc import Callable
from itertools import pairwise

import pytest
from fakes import PlacedReporter, RecordingObserver, RecordingSink, ScriptedSource, StallingClock, cruising

from teleop.core.axes import Axis, Limits, Reading, State
from teleop.core.clock import VirtualClock
from teleop.core.control_loop import LEAD, STALL, ControlLoop
from teleop.core.errors import Interrupted, LinkError
from teleop.core.events import Action
from teleop.core.interfaces import Clock, Feedback
from teleop.core.run_state import Result, RunState
from teleop.core.setpoints import Stop, VelocityTarget
from teleop.core.shutdown import RELEASE_LONGEST, RELEASE_PATIENCE
from teleop.core.stall_recovery import READINGS_TIMEOUT
from teleop.core.timing import FIRST_REPORT, KEEP_ALIVE, PERIOD, LoopTiming
from teleop.planner.live import Live

LIMITS = {Axis.PAN: Limits(-180, 180, 60, 120, 600), Axis.TILT: Limits(-56, 146, 60, 120, 600)}
ASLEEP = 0.005  # s before a tick, while nothing is prepared for it yet
PLACES = {Axis.PAN: 10.0, Axis.TILT: -5.0}


def loop_of(sources, sinks, reporters=None, clock: Clock | None = None, planner=None, observers=()) -> ControlLoop:
    reporters = [PlacedReporter(PLACES)] if reporters is None else reporters
    planner = planner or Live(LIMITS, PERIOD)
    return ControlLoop(clock or VirtualClock(), planner, LIMITS, sources, sinks, reporters, observers)


def assert_smooth_to_rest(sink: RecordingSink, axis: Axis = Axis.PAN) -> None:
    """From its first to its last tick the axis moved within its limits, and it ended at rest."""
    limits = LIMITS[axis]
    states = [(tick.time, tick.motion[axis]) for tick in sink.ticks]
    for (before, one), (after, other) in pairwise(states):
        dt = after - before
        assert abs(other.velocity) <= limits.velocity + 1e-6
        assert abs(other.velocity - one.velocity) <= limits.acceleration * dt + 1e-6
        assert abs(other.acceleration - one.acceleration) <= limits.jerk * dt + 1e-6
        assert abs(other.position - one.position) <= limits.velocity * dt + 1e-6
    assert states[-1][1].velocity == states[-1][1].acceleration == 0


def test_a_run_starts_where_the_axes_are_and_ends_at_rest() -> None:
    sink = RecordingSink()
    ended = loop_of([cruising(Axis.PAN, 30, end=1.0)], [sink]).run()
    assert (ended.state, ended.result, ended.reasons) == (RunState.OVER, Result.DONE, [])
    assert sink.ticks[0].motion[Axis.PAN].position == pytest.approx(10.0, abs=0.01)
    assert max(tick.motion[Axis.PAN].velocity for tick in sink.ticks) == pytest.approx(30)
    assert all(tick.motion[Axis.TILT] == State(-5.0) for tick in sink.ticks)
    assert len(sink.released) == 1
    assert_smooth_to_rest(sink)


def test_the_first_source_with_an_opinion_drives() -> None:
    sink = RecordingSink()
    above = ScriptedSource(lambda elapsed: {Axis.PAN: VelocityTarget(-20)} if 1 <= elapsed < 2 else {}, 3)
    below = ScriptedSource(lambda _elapsed: {Axis.PAN: VelocityTarget(20), Axis.TILT: VelocityTarget(5)}, 3)
    loop_of([above, below], [sink]).run()
    velocity = {round(tick.time, 2): tick.motion[Axis.PAN].velocity for tick in sink.ticks}
    assert velocity[0.9] == pytest.approx(20)
    assert velocity[1.9] == pytest.approx(-20)
    assert velocity[2.9] == pytest.approx(20)
    assert max(tick.motion[Axis.TILT].velocity for tick in sink.ticks) == pytest.approx(5)
    assert_smooth_to_rest(sink)


def test_a_source_that_fails_costs_no_tick() -> None:
    """The ramp to rest begins in the tick in which it failed."""
    clock, sink, source = VirtualClock(), RecordingSink(), cruising(Axis.PAN, 50, end=60.0)
    source.read = failing(1.0, clock, source.read, Interrupted("stopped by keys"))  # type: ignore[method-assign]
    loop_of([source], [sink], clock=clock).run()
    assert max(after.time - before.time for before, after in pairwise(sink.ticks)) == pytest.approx(PERIOD)
    first = next(tick for tick in sink.ticks if tick.time > 1.0)
    assert first.demand == dict.fromkeys(LIMITS, Stop())
    assert_smooth_to_rest(sink)


def test_a_source_sees_the_motion_commanded_before_and_the_last_readings() -> None:
    sink, source, seen = RecordingSink(), cruising(Axis.PAN, 50, end=0.5), []
    read = source.read
    source.read = lambda now, feedback: (seen.append(feedback), read(now, feedback))[1]  # type: ignore[method-assign]
    loop_of([source], [sink]).run()
    assert seen[0].motion == {axis: State(place) for axis, place in PLACES.items()}
    running = sink.ticks[: len(seen) - 1]
    assert [feedback.motion for feedback in seen[1:]] == [tick.motion for tick in running]
    assert [feedback.readings for feedback in seen[1:]] == [tick.reported for tick in running]


def test_an_observer_sees_every_tick_after_the_sinks_and_releases_nothing() -> None:
    calls: list[str] = []
    sink, observer = RecordingSink(), RecordingObserver()
    write, observe = sink.write, observer.observe
    sink.write = lambda tick: (calls.append("sink"), write(tick))[1]  # type: ignore[method-assign]
    observer.observe = lambda tick: (calls.append("observer"), observe(tick))[1]  # type: ignore[method-assign]
    loop_of([cruising(Axis.PAN, 30, end=0.5)], [sink], observers=[observer]).run()
    assert calls == ["sink", "observer"] * len(sink.ticks)
    assert observer.ticks == sink.ticks


@pytest.mark.parametrize("period", [0.005, 0.02])
def test_a_loop_turns_at_the_period_that_it_is_given(period: float) -> None:
    clock, sink = VirtualClock(), RecordingSink()
    planner, timing = Live(LIMITS, period), LoopTiming(period)
    reporters = [PlacedReporter(PLACES)]
    ControlLoop(clock, planner, LIMITS, [cruising(Axis.PAN, 50, 1.0)], [sink], reporters, timing=timing).run()
    assert {round(after.time - before.time, 9) for before, after in pairwise(sink.ticks)} == {period}
    assert max(tick.motion[Axis.PAN].velocity for tick in sink.ticks) == pytest.approx(50)
    assert_smooth_to_rest(sink)


def test_actions_ride_the_tick_once() -> None:
    sink = RecordingSink()
    loop_of([ScriptedSource(lambda _elapsed: {}, 2, [(0.5, Action.RECORD), (1.5, Action.STOP)])], [sink]).run()
    actions = [(round(tick.time, 2), *tick.actions) for tick in sink.ticks if tick.actions]
    assert [action for _, action in actions] == [Action.RECORD, Action.STOP]


def test_a_resting_loop_sleeps_but_not_past_the_keep_alive_nor_a_change() -> None:
    class Sleeper(ScriptedSource):
        def next_change(self, now: float) -> float:
            return self.begin + 3.0 if now < self.begin + 3.0 - 1e-9 else super().next_change(now)

    sink = RecordingSink()
    source = Sleeper(lambda elapsed: {Axis.PAN: VelocityTarget(10)} if elapsed >= 3.0 - 1e-9 else {}, 4)
    loop_of([source], [sink]).run()
    waiting = [tick.time for tick in sink.ticks if tick.time < source.begin + 3.0]
    assert len(waiting) < 20
    assert max(after - before for before, after in pairwise(waiting)) <= KEEP_ALIVE + 1e-9
    first = next(tick for tick in sink.ticks if tick.motion[Axis.PAN].velocity)
    assert first.time == pytest.approx(source.begin + 3.0, abs=1e-6)
    assert first.motion[Axis.PAN].velocity < 1, "waking must not make up for the time slept"
    assert_smooth_to_rest(sink)


def failing(after: float, clock: VirtualClock, what: Callable, error: Exception | None = None) -> Callable:
    """`what`, until `after`; from then on it always raises."""

    def call(*arguments):
        if clock.now() >= after - 1e-9:
            raise error or ZeroDivisionError("a defect")
        return what(*arguments)

    return call


@pytest.mark.parametrize("culprit", ["source", "planner", "sink", "reporter", "next_change"])
def test_an_exception_anywhere_ramps_to_rest_and_releases_everything(culprit: str) -> None:
    clock = VirtualClock()
    source, sink, bad_sink = cruising(Axis.PAN, 50, end=60.0), RecordingSink(steps=3), RecordingSink()
    reporter, planner = PlacedReporter(PLACES), Live(LIMITS, PERIOD)
    target, name = {
        "source": (source, "read"),
        "next_change": (source, "next_change"),
        "planner": (planner, "step"),
        "sink": (bad_sink, "write"),
        "reporter": (reporter, "report"),
    }[culprit]
    setattr(target, name, failing(1.0, clock, getattr(target, name)))
    ended = loop_of([source], [bad_sink, sink], [reporter], clock, planner).run()
    assert ended.result is Result.FAILED
    assert ended.reasons == ["ZeroDivisionError: a defect"]
    assert clock.now() < 1.0 + 2.0
    assert len(sink.released) == 3
    assert len(bad_sink.released) == 1
    assert max(tick.motion[Axis.PAN].velocity for tick in sink.ticks) == pytest.approx(50)
    assert_smooth_to_rest(sink)


def test_a_planner_that_fails_while_stopping_and_recovers_does_not_jump() -> None:
    class Flaky(Live):
        halts = 0

        def step(self, demand, dt_steps: int = 1):
            self.halts += isinstance(demand.get(Axis.PAN), Stop)
            if 3 <= self.halts < 12:
                raise ZeroDivisionError("a defect")
            return super().step(demand, dt_steps)

    sink, clock = RecordingSink(), VirtualClock()
    source = cruising(Axis.PAN, 50, end=60.0)
    source.read = failing(1.0, clock, source.read)
    ended = loop_of([source], [sink], clock=clock, planner=Flaky(LIMITS, PERIOD)).run()
    assert ended.result is Result.FAILED
    assert_smooth_to_rest(sink)


def test_an_interrupt_ramps_to_rest_however_often_it_comes() -> None:
    clock, sink = VirtualClock(), RecordingSink()
    loop = loop_of([cruising(Axis.PAN, 50, end=60.0)], [sink], clock=clock)
    write = sink.write

    def interrupting(tick) -> None:
        write(tick)
        if tick.time > 1:
            loop.interrupt("SIGINT received")

    sink.write = interrupting
    ended = loop.run()
    assert (ended.result, ended.reasons) == (Result.INTERRUPTED, ["SIGINT received"])
    assert clock.now() < 3
    assert_smooth_to_rest(sink)


def test_an_operator_who_has_had_enough_ends_it_as_an_interrupt() -> None:
    clock, sink = VirtualClock(), RecordingSink()
    observer = RecordingObserver()
    observer.observe = failing(1.0, clock, observer.observe, Interrupted("stopped by keys"))
    ended = loop_of([cruising(Axis.PAN, 30, 60)], [sink], clock=clock, observers=[observer]).run()
    assert (ended.result, ended.reasons) == (Result.INTERRUPTED, ["stopped by keys"])
    assert_smooth_to_rest(sink)


def test_ctrl_c_without_a_handler_is_an_interrupt_too() -> None:
    pressed = []

    class Interrupted(VirtualClock):
        def sleep_until(self, time: float) -> None:
            super().sleep_until(time)
            if self.now() >= 1 and not pressed:
                pressed.append(True)
                raise KeyboardInterrupt

    sink = RecordingSink()
    ended = loop_of([cruising(Axis.PAN, 50, end=60.0)], [sink], clock=Interrupted()).run()
    assert (ended.result, ended.reasons) == (Result.INTERRUPTED, ["Ctrl-C"])
    assert_smooth_to_rest(sink)


def test_lateness_is_made_up_in_one_legal_step() -> None:
    sink = RecordingSink()
    ended = loop_of([cruising(Axis.PAN, 50, end=2.0)], [sink], clock=StallingClock(0.3 - ASLEEP, 0.1)).run()
    assert ended.result is Result.DONE
    assert max(after.time - before.time for before, after in pairwise(sink.ticks)) == pytest.approx(0.11)
    assert sink.ticks[-1].time - sink.ticks[0].time > 2.0
    assert_smooth_to_rest(sink)


def test_commands_leave_on_the_grid_however_long_they_took_to_make() -> None:
    clock, sink, source = VirtualClock(), RecordingSink(), cruising(Axis.PAN, 50, end=1.0)
    write, read, off, dice = sink.write, source.read, [], random.Random(1)

    def slow(now: float, feedback: Feedback):
        clock.sleep_until(clock.now() + dice.uniform(0, LEAD))
        return read(now, feedback)

    source.read = slow  # type: ignore[method-assign]
    sink.write = lambda tick: (off.append(clock.now() - tick.time), write(tick))  # type: ignore[method-assign]
    loop_of([source], [sink], clock=clock).run()
    assert len(off) > 100
    assert max(map(abs, off)) < 1e-9


class Measured:
    """Says where pan is, by a function of time, and answers 40 ms late and ten times a second, as devices do."""

    def __init__(self, position: Callable[[float], float]) -> None:
        self._position = position

    def report(self, now: float):
        asked = math.floor((now - 0.04) * 10) / 10
        return {Axis.PAN: Reading(self._position(asked), asked), Axis.TILT: Reading(-5.0, asked)}


@pytest.mark.parametrize(
    ("measured", "velocity"),
    [(lambda t: 50 * t, 50.0), (lambda t: 20 * t, 20.0), (lambda _t: 60.0, 0.0), (lambda t: 90 * t, 50.0)],
)
def test_after_a_stall_it_stops_from_where_the_axes_are_found_and_says_why(
    measured: Callable[[float], float], velocity: float
) -> None:
    """Never faster than it was commanded, and nothing is sent before it is known."""
    sink, clock = RecordingSink(), StallingClock(1.0 - ASLEEP, STALL + 0.05)
    ended = loop_of([cruising(Axis.PAN, 50, end=60.0)], [sink], [Measured(measured)], clock).run()
    assert ended.result is Result.FAILED
    assert ended.reasons == ["the computer stalled for 0.30 s"]
    after = next(i for i, tick in enumerate(sink.ticks) if tick.time > 1.2)
    found, at = sink.ticks[after].motion[Axis.PAN], sink.ticks[after].time
    assert found.velocity == pytest.approx(velocity, abs=3)
    assert found.position == pytest.approx(measured(at), abs=8)
    assert at - sink.ticks[after - 1].time > STALL + 0.1
    sink.ticks = sink.ticks[after:]
    assert_smooth_to_rest(sink)


def test_what_was_prepared_before_a_stall_is_not_sent_after_it() -> None:
    sink, clock, old = RecordingSink(), StallingClock(1.0, STALL + 0.05), []
    write = sink.write
    sink.write = lambda tick: (old.append(clock.now() - tick.time), write(tick))  # type: ignore[method-assign]
    ended = loop_of([cruising(Axis.PAN, 50, end=60.0)], [sink], [Measured(lambda t: 50 * t)], clock).run()
    assert ended.reasons == ["the computer stalled for 0.29 s"]
    assert max(old) < PERIOD
    assert 1.0 not in [round(tick.time, 3) for tick in sink.ticks]


def test_an_axis_that_is_not_found_after_a_stall_is_released_without_a_command() -> None:
    """Any position for it would be made up, and by then every device has stopped by itself."""
    sink, clock = RecordingSink(), StallingClock(1.0 - ASLEEP, STALL + 0.05)
    old = Measured(lambda t: 50 * min(t, 1.0))
    report = old.report
    old.report = lambda now: report(min(now, 1.0))  # type: ignore[method-assign]  # it falls silent
    ended = loop_of([cruising(Axis.PAN, 50, end=60.0)], [sink], [old], clock).run()
    assert ended.reasons == [
        "the computer stalled for 0.30 s",
        "no position of pan since the stall: released without a ramp",
    ]
    assert sink.ticks[-1].time < 1.01, "nothing was sent after the stall"
    assert sink.released == [pytest.approx(1.0 + STALL + 0.05 + READINGS_TIMEOUT, abs=3 * PERIOD)]


def test_an_axis_that_is_read_once_after_a_stall_is_held_where_it_was_read() -> None:
    sink, clock = RecordingSink(), StallingClock(1.0 - ASLEEP, STALL + 0.05)
    once = Measured(lambda t: 50 * t)
    report = once.report
    once.report = lambda now: report(now if now < 1 else min(now, 1.39))  # type: ignore[method-assign]
    ended = loop_of([cruising(Axis.PAN, 50, end=60.0)], [sink], [once], clock).run()
    assert ended.reasons[1:] == ["pan was measured only once since the stall: held there"]
    after = [tick.motion[Axis.PAN] for tick in sink.ticks if tick.time > 1.2]
    assert after
    assert set(after) == {State(once.report(1.39)[Axis.PAN].position)}


def test_two_readings_of_one_moment_end_the_search_like_any_other() -> None:
    """As a device with a coarse clock gives them: the same time, another place, in every tick."""
    sink, clock = RecordingSink(), StallingClock(1.0 - ASLEEP, STALL + 0.05)
    turned = iter(range(1 << 30))

    class Coarse:
        def report(self, now: float):
            return {
                Axis.PAN: Reading(50 * now if now < 1 else 60 + next(turned) / 1000, now if now < 1 else 1.35),
                Axis.TILT: Reading(-5.0, now),
            }

    ended = loop_of([cruising(Axis.PAN, 50, end=60.0)], [sink], [Coarse()], clock).run()
    assert ended.reasons[1:] == ["pan was measured only once since the stall: held there"]
    assert clock.now() < 1.0 + STALL + 0.05 + READINGS_TIMEOUT + 0.1
    assert sink.released


def test_a_stall_of_a_resting_loop_needs_no_search() -> None:
    sink, clock = RecordingSink(), StallingClock(1.0 - ASLEEP, STALL + 0.05)
    ended = loop_of([cruising(Axis.PAN, 0, end=60.0)], [sink], clock=clock).run()
    assert ended.reasons == ["the computer stalled for 0.30 s"]
    assert clock.now() < 1.0 + STALL + 0.05 + KEEP_ALIVE + 3 * PERIOD


@pytest.mark.parametrize("kind", [SystemExit, GeneratorExit, MemoryError, RecursionError])
@pytest.mark.parametrize("culprit", ["source", "sink", "clock"])
def test_nothing_that_is_raised_gets_past_the_loop(kind: type[BaseException], culprit: str) -> None:
    clock, source, sink, bad = VirtualClock(), cruising(Axis.PAN, 50, end=60.0), RecordingSink(steps=3), RecordingSink()
    target, name = {"source": (source, "read"), "sink": (bad, "write"), "clock": (clock, "sleep_until")}[culprit]
    call = getattr(target, name)

    def fails(*arguments):
        if clock.now() > 1.0:
            raise kind("a defect")  # made here: one that pytest keeps would keep the whole loop, solvers and all
        return call(*arguments)

    setattr(target, name, fails)
    ended = loop_of([source], [bad, sink], clock=clock).run()
    assert ended.result is Result.FAILED
    assert ended.reasons[0].startswith(kind.__name__)
    assert len(sink.released) == 3
    assert_smooth_to_rest(sink)


def test_an_error_that_cannot_say_what_it_is_ends_the_run_too() -> None:
    class MuteError(Exception):
        def __str__(self) -> str:
            raise ValueError

    source, sink = cruising(Axis.PAN, 50, end=60.0), RecordingSink()
    source.read = failing(1.0, clock := VirtualClock(), source.read, MuteError())
    ended = loop_of([source], [sink], clock=clock).run()
    assert ended.reasons == ["MuteError"]
    assert_smooth_to_rest(sink)


@pytest.mark.parametrize("bad", [math.nan, math.inf])
def test_a_planner_without_numbers_is_not_believed(bad: float) -> None:
    planner, clock, sink = Live(LIMITS, PERIOD), VirtualClock(), RecordingSink()
    step = planner.step

    def mad(demand, dt_steps: int = 1):
        motion = step(demand, dt_steps)
        return motion if clock.now() < 1.0 else {axis: State(bad, *state[1:]) for axis, state in motion.items()}

    planner.step = mad
    ended = loop_of([cruising(Axis.PAN, 50, end=60.0)], [sink], clock=clock, planner=planner).run()
    assert ended.reasons[0].startswith("ArithmeticError: the planner has pan at ")
    assert_smooth_to_rest(sink)


def test_a_planner_that_never_comes_to_rest_is_relieved() -> None:
    planner, clock, sink = Live(LIMITS, PERIOD), VirtualClock(), RecordingSink()
    step = planner.step
    planner.step = lambda demand, dt_steps=1: step({Axis.PAN: VelocityTarget(30)}, dt_steps)  # type: ignore[method-assign]
    loop = loop_of([cruising(Axis.PAN, 30, end=60.0)], [sink], clock=clock, planner=planner)
    sink.write = lambda tick: (sink.ticks.append(tick), tick.time > 1 and loop.interrupt("enough"))[0]  # type: ignore[method-assign]
    ended = loop.run()
    assert ended.result is Result.INTERRUPTED
    assert clock.now() < 5
    assert_smooth_to_rest(sink)


def test_a_sink_that_never_ends_its_release_is_left_behind() -> None:
    clock, sink, endless = VirtualClock(), RecordingSink(steps=3), RecordingSink(steps=1_000_000)
    ended = loop_of([cruising(Axis.PAN, 10, 0.5)], [endless, sink], clock=clock).run()
    assert ended.result is Result.FAILED
    assert ended.reasons == [f"shutdown timed out after {RELEASE_LONGEST:g} s: some devices were not released"]
    assert len(sink.released) == 3
    assert clock.now() < RELEASE_LONGEST + 3


def test_links_are_heard_while_devices_are_given_back() -> None:
    """What they hold back must still leave, and a release may wait for an answer."""
    sink, reporter = RecordingSink(steps=5), PlacedReporter(PLACES)
    heard, report = [], reporter.report
    reporter.report = lambda now: (heard.append(now), report(now))[1]  # type: ignore[method-assign]
    loop_of([cruising(Axis.PAN, 10, 0.5)], [sink], [reporter]).run()
    assert sum(sink.released[0] <= now <= sink.released[-1] for now in heard) >= 20


def test_without_a_report_nothing_moves() -> None:
    clock, sink = VirtualClock(), RecordingSink()
    ended = loop_of([cruising(Axis.PAN, 50, 1.0)], [sink], [PlacedReporter({Axis.PAN: 0.0})], clock).run()
    assert ended.result is Result.FAILED
    assert ended.reasons == [f"no position of tilt was reported within {FIRST_REPORT:g} s"]
    assert sink.ticks == []
    assert clock.now() < FIRST_REPORT + 1


def test_a_link_lost_before_the_start_is_said_and_ends_it() -> None:
    class Dead:
        def report(self, now: float):
            raise LinkError("the gimbal does not answer")

    ended = loop_of([cruising(Axis.PAN, 50, 1.0)], [RecordingSink()], [Dead()]).run()
    assert (ended.result, ended.reasons) == (Result.FAILED, ["the gimbal does not answer"])


@pytest.mark.parametrize("failures", [1, 3, math.inf])
def test_release_is_tried_again_while_the_link_fails_but_not_for_ever(failures: float) -> None:
    clock, sink, other = VirtualClock(), RecordingSink(), RecordingSink(steps=3)
    attempts = []

    def release(now: float) -> float | None:
        attempts.append(now)
        if len(attempts) <= failures:
            raise LinkError("the bus is full")
        return None

    sink.release = release
    ended = loop_of([cruising(Axis.PAN, 10, 0.5)], [sink, other], clock=clock).run()
    assert ended.result is Result.FAILED
    assert ended.reasons == ["the bus is full"]
    assert len(attempts) == failures + 1 or attempts[-1] - attempts[0] >= RELEASE_PATIENCE - PERIOD
    assert len(other.released) == 3

"""What stands around a move: a start in mid move, passes, a loop, the way back, and the trigger it waits for."""

import math
from contextlib import ExitStack
from datetime import datetime

import pytest
from at_once import AtOnce
from fakes import NO_FEEDBACK

from teleop.core.axes import Axis, Limits, State
from teleop.core.events import Action, DeviceCommand, SourceEvent
from teleop.core.setpoints import StateTarget
from teleop.core.timing import KEEP_ALIVE
from teleop.planner.keyframes.planner import Key, plan
from teleop.planner.live import Live
from teleop.sequence.compile import CompiledSequence
from teleop.sequence.cues import Cue
from teleop.sequence.cycle import Cycle
from teleop.sequence.phases import SequencePhase
from teleop.sequence.progress import progress_text
from teleop.sequence.source import SequenceSource
from teleop.sequence.triggers.time_of_day import ClockTrigger

PAN = Axis.PAN
LIMITS = {PAN: Limits(-180, 180, 60, 120, 600)}
THERE = [Key(0, 0), Key(2, 20), Key(4, 40)]
AND_BACK = [*THERE, Key(8, 0)]
CUES = [Cue(0, Action.RECORD), Cue(1, Action.SHUTTER), Cue(3, Action.SHUTTER), Cue(4, Action.STOP)]
DT = 0.01


class Button:
    """A trigger that is pulled by the test."""

    def __init__(self, again: bool = True) -> None:
        self.again, self.pulled, self.armed = again, False, 0

    def open(self, stack: ExitStack) -> None: ...

    def arm(self, now: float) -> None:
        self.armed += 1
        self.pulled = False

    def fired(self, now: float) -> bool:
        return self.pulled

    def waits_for(self, now: float) -> str:
        return "the button"


class Stage:
    """A sequence and the live planner that makes each of its states a legal step, tick by tick, sleeping over none."""

    def __init__(self, keys: list[Key], staging: Cycle, cues: list[Cue] | None = None, here: float = 0.0) -> None:
        self.move = plan({PAN: keys}, LIMITS)
        performance = CompiledSequence("Test", self.move, cues or [], [], {PAN: keys})
        self.source = SequenceSource(performance, LIMITS, executor=AtOnce(), cycle=staging)
        self.now = 100.0
        self.source.start(self.now, {PAN: State(here)})
        self.live = Live(LIMITS, DT)
        self.live.reset({PAN: State(here)})
        self.acts: list[tuple[float, SourceEvent]] = []
        self.pan = State(here)

    def step(self) -> None:
        self.now += DT
        demand, acts = self.source.read(self.now, NO_FEEDBACK)
        wish = demand[PAN]
        assert isinstance(wish, StateTarget)
        self.pan = self.live.step(demand)[PAN]
        assert self.pan == pytest.approx(State(*wish), abs=1e-7)  # a legal step led exactly there
        self.acts += [(round(self.now - self.source.begin, 6), act) for act in acts]

    def until(self, phase: SequencePhase, seconds: float = 100.0) -> None:
        end = self.now + seconds
        while self.source.phase is not phase:
            assert self.now < end
            self.step()

    def play(self) -> list[SequencePhase]:
        """To the end; the phases that were gone through."""
        phases = [self.source.phase]
        while self.source.phase is not SequencePhase.OVER:
            self.step()
            if self.source.phase is not phases[-1]:
                phases.append(self.source.phase)
        assert math.isinf(self.source.next_change(self.now))
        return phases


def test_at_the_end_it_goes_back_to_one_when_asked():
    stage = Stage(THERE, Cycle(back_to_one=True))
    assert stage.play() == [SequencePhase.EASING, SequencePhase.PLAYING, SequencePhase.RETURNING, SequencePhase.OVER]
    assert stage.pan == State(0.0)


def test_the_preroll_is_counted_down_in_place():
    stage = Stage(THERE, Cycle(preroll=3), here=-10)
    stage.until(SequencePhase.PREROLL)
    assert stage.pan == State(0.0)
    assert progress_text(stage.source, stage.now) == "starts in  3.0 s"
    assert stage.source.next_change(stage.now) == stage.source.begin == pytest.approx(stage.now + 3)
    stage.until(SequencePhase.PLAYING)
    assert stage.now == pytest.approx(stage.source.begin)


def test_started_in_mid_move_it_is_there_at_the_speed_that_the_move_has_there():
    stage = Stage(THERE, Cycle(start_at=2.5), here=-10)
    stage.until(SequencePhase.PLAYING)
    assert progress_text(stage.source, stage.now) == "run-up to 2.5 s"
    while stage.source.playback.time(stage.now) < 2.5 - 1e-6:
        assert stage.pan.position < stage.move.at(2.5)[PAN].position
        stage.step()
    assert stage.source.playback.time(stage.now) == pytest.approx(2.5, abs=1e-9)
    assert stage.pan == pytest.approx(stage.move.at(2.5)[PAN], abs=1e-6)
    assert stage.pan.velocity > 10


def test_cues_before_a_start_in_mid_move_are_left_out_but_the_camera_is_recording():
    stage = Stage(THERE, Cycle(start_at=2.5), CUES)
    stage.play()
    assert [act for _, act in stage.acts] == [Action.RECORD, Action.SHUTTER, Action.STOP]
    assert stage.acts[0][0] == 0.0  # as the run-up begins
    after = Stage(THERE, Cycle(start_at=2.5), [Cue(0, Action.RECORD), Cue(1, Action.STOP), Cue(3, Action.SHUTTER)])
    after.play()
    assert [act for _, act in after.acts] == [Action.SHUTTER]


def test_a_start_in_mid_move_finds_the_gimbal_told_how_to_follow_and_the_camera_focusing():
    lock, pan = DeviceCommand("gimbal", "follow lock"), DeviceCommand("gimbal", "follow yaw")
    cues = [
        Cue(0, lock),
        Cue(0, Action.FOCUS),
        Cue(1, pan),
        Cue(1, DeviceCommand("gimbal", "version")),
        Cue(4, Action.END_FOCUS),
    ]
    stage = Stage(THERE, Cycle(preroll=1, start_at=2.5), cues)
    stage.until(SequencePhase.PREROLL)
    assert [act for _, act in stage.acts] == [pan]
    stage.play()
    assert [act for _, act in stage.acts] == [pan, Action.FOCUS, Action.END_FOCUS]


def test_every_pass_eases_back_and_has_its_cues():
    stage = Stage(THERE, Cycle(preroll=0.5, passes=3), CUES)
    phases = stage.play()
    assert phases == [*[SequencePhase.EASING, SequencePhase.PREROLL, SequencePhase.PLAYING] * 3, SequencePhase.OVER]
    assert [act for _, act in stage.acts].count(Action.RECORD) == 3
    assert stage.source.number == 3


def test_a_loop_that_ends_where_it_begins_goes_on_without_a_tick_between():
    stage = Stage(AND_BACK, Cycle(preroll=1, passes=math.inf))
    stage.until(SequencePhase.PLAYING)
    for number in range(1, 4):
        for tick in range(1, 801):
            assert stage.source.number == number
            stage.step()
            assert stage.source.playback.time(stage.now) == pytest.approx(tick * DT, abs=1e-9)


def test_a_loop_that_does_not_is_eased_back_and_keeps_the_speed_chosen_meanwhile():
    stage = Stage(THERE, Cycle(passes=math.inf, start_at=1.0))
    stage.until(SequencePhase.PLAYING)
    stage.source.playback.speed(0.5, stage.now)
    stage.until(SequencePhase.EASING)
    stage.until(SequencePhase.PLAYING)
    for _ in range(300):
        stage.step()
    assert stage.source.playback.rate(stage.now) == 0.5


def test_before_a_pass_that_is_compared_there_is_a_hush():
    source = Stage(THERE, Cycle(passes=2, compared=True)).source
    source.read(100.0, NO_FEEDBACK)
    assert source.phase is SequencePhase.PREROLL
    assert source.next_change(100.0) == source.begin == 100.0 + KEEP_ALIVE
    long = Stage(THERE, Cycle(preroll=5, passes=2, compared=True)).source
    long.read(100.0, NO_FEEDBACK)
    assert long.next_change(100.0) == pytest.approx(105 - KEEP_ALIVE)
    assert long.next_change(105 - KEEP_ALIVE) == 105


def test_a_trigger_starts_the_move_once_the_rig_is_in_place_and_not_before():
    button = Button()
    stage = Stage(THERE, Cycle(preroll=0.5, trigger=button), CUES, here=-10)
    button.pulled = True  # while it is still on its way
    stage.until(SequencePhase.ARMED)
    assert math.isinf(stage.source.begin)
    for _ in range(200):
        stage.step()
    assert stage.pan == State(0.0)
    assert progress_text(stage.source, stage.now) == "waiting for the button"
    assert stage.source.next_change(stage.now) == stage.now
    button.pulled = True
    stage.step()
    assert stage.source.begin == stage.now
    assert stage.acts == [(0.0, Action.RECORD)]


def test_each_pass_waits_for_its_trigger_unless_that_comes_only_once():
    for again, armed in ((True, 3), (False, 1)):
        button = Button(again)
        stage = Stage(THERE, Cycle(passes=3, trigger=button))
        while stage.source.phase is not SequencePhase.OVER:
            button.pulled = stage.source.phase is SequencePhase.ARMED
            stage.step()
        assert button.armed == armed


def test_the_operators_go_starts_what_waits_for_a_trigger_and_is_not_remembered():
    stage = Stage(THERE, Cycle(trigger=Button()), here=-10)
    stage.source.go()
    stage.until(SequencePhase.ARMED)
    stage.step()
    assert stage.source.phase is SequencePhase.ARMED
    stage.source.go()
    stage.step()
    assert stage.source.phase is SequencePhase.PLAYING


def test_paused_at_its_end_it_is_not_over():
    stage = Stage(THERE, Cycle())
    stage.until(SequencePhase.PLAYING)
    stage.source.playback.pause(stage.now)
    for _ in range(200):
        stage.step()
    for _ in range(3):
        stage.source.playback.step(1, stage.now)
        for _ in range(600):
            stage.step()
    assert stage.source.playback.time(stage.now) == pytest.approx(4.0)
    assert stage.source.phase is SequencePhase.PLAYING
    assert stage.source.next_change(stage.now) < stage.now + 1
    stage.source.playback.resume(stage.now)
    stage.play()


def test_a_time_that_passed_while_the_run_was_stopped_comes_again_when_the_clock_is_set_back():
    wall = [datetime.fromisoformat("2026-11-25T18:29:55").timestamp()]
    trigger = ClockTrigger("18:30", lambda: wall[0])
    stage = Stage(THERE, Cycle(0.5, trigger=trigger))
    stage.source.suspend(stage.now)
    wall[0] += 60
    stage.source.resume(stage.now, {PAN: stage.pan})
    for _ in range(100):
        stage.step()
    assert (stage.source.phase, stage.source.missed[:12]) == (SequencePhase.ARMED, "18:30:00 was")
    wall[0] -= 120
    stage.step()
    assert (stage.source.phase, stage.source.missed) == (SequencePhase.ARMED, "")
    assert trigger.waits_for(stage.now) == "18:30:00, in 1 min 5 s"
    wall[0] += 65
    stage.step()
    assert stage.source.phase is SequencePhase.PLAYING

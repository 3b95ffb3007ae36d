"""A run that moves by itself under STOP: halted at once, latched, cleared, and gone on with from rest, nothing lost."""

from __future__ import annotations

import math
from collections.abc import Sequence

import pytest
from at_once import AtOnce
from hands import FakeInput
from hypothesis import given, settings
from hypothesis import strategies as st

from teleop.app.calibration.calibration_move import CalibrationMove
from teleop.core.axes import Axis, Limits, Motion, State
from teleop.core.errors import DeviceError, Interrupted
from teleop.core.events import Action, DeviceCommand, SourceEvent
from teleop.core.guard_stop import stop_phases, stop_state
from teleop.core.interfaces import Feedback
from teleop.core.operator_input import Command
from teleop.core.setpoints import Demand, Stop
from teleop.inputs.recorded_sticks import Sticks, SticksSource
from teleop.manual.stop_guard import Relay, StopGuard, Together
from teleop.planner.keyframes.planner import Key, plan
from teleop.planner.live import Live
from teleop.sequence.compile import CompiledSequence
from teleop.sequence.cues import Cue, Wait
from teleop.sequence.cycle import Cycle
from teleop.sequence.phases import SequencePhase
from teleop.sequence.playback_controls import PlaybackControls
from teleop.sequence.source import SequenceSource

PAN, TILT = Axis.PAN, Axis.TILT
LIMITS = {PAN: Limits(-180, 180, 60, 120, 600), TILT: Limits(-50, 50, 40, 90, 480)}
KEYS = {PAN: [Key(0, 0), Key(2, 30), Key(4, 60, stop=True), Key(8, -30)], TILT: [Key(0, 0), Key(3, 25), Key(8, -20)]}
CUES = [
    Cue(0, Action.RECORD),
    Cue(1, DeviceCommand("gimbal", "follow lock")),
    Cue(1.5, Action.SHUTTER),
    Cue(6, DeviceCommand("gimbal", "follow yaw")),
    Cue(8, Action.STOP),
]
DT = 0.01
STOP, CLEAR, PAUSE, GO, QUIT = Command.STOP, Command.CLEAR, Command.PAUSE, Command.GO, Command.QUIT


class Trigger:
    """Fires when `fires` is set; what came before it was armed does not count."""

    again = True

    def __init__(self) -> None:
        self.fires = False
        self.late = ""

    def open(self, stack: object) -> None: ...

    def arm(self, now: float) -> None:
        self.fires = False
        if self.late:
            raise DeviceError(self.late)

    def fired(self, now: float) -> bool:
        return self.fires

    def waits_for(self, now: float) -> str:
        return "a test"


class Run:
    """A sequence under the guard with keys and a pad, carried out by the live planner, as the loop does."""

    def __init__(self, staging: Cycle | None = None, cues: Sequence[Cue] = CUES, start: float = 0.0) -> None:
        self.keys, self.pad = FakeInput("keys"), FakeInput("pad")
        performance = CompiledSequence("Test", plan(KEYS, LIMITS), list(cues), [], KEYS)
        self.sequence = SequenceSource(performance, LIMITS, 1.0, AtOnce(), staging or Cycle(0.3))
        relays = [Relay(self.pad), Relay(self.keys)]
        self.controls = PlaybackControls(self.sequence, Together(relays))
        self.said: list[str] = []
        self.guard = StopGuard(self.controls, relays, self.said.append)
        self.planner = Live(LIMITS, DT)
        self.motion: Motion = {PAN: State(start), TILT: State(0.0)}
        self.planner.reset(self.motion)
        self.now = 0.0
        self.acts: list[SourceEvent] = []
        self.demand: Demand = {}
        self.ended: BaseException | None = None
        self.guard.start(self.now, self.motion)

    def tick(self) -> None:
        self.now += DT
        try:
            self.demand, acts = self.guard.read(self.now, Feedback(self.motion, {}))
        except Interrupted as ended:
            self.ended = ended
            self.demand, acts = dict.fromkeys(self.motion, Stop()), ()  # as the loop does in the same tick
        self.acts += acts
        before, self.motion = self.motion, self.planner.step(self.demand)
        check_legal(before, self.motion)

    def run(self, seconds: float) -> None:
        for _ in range(round(seconds / DT)):
            self.tick()

    def press(self, *commands: Command) -> None:
        for command in commands:
            self.keys.press(command)
        self.tick()

    def until(self, phase: SequencePhase) -> None:
        for _ in range(2000):
            if self.sequence.phase is phase:
                return
            self.tick()
        raise AssertionError(f"{phase} never came")

    @property
    def rests(self) -> bool:
        return all(state.velocity == 0 and state.acceleration == 0 for state in self.motion.values())

    @property
    def over(self) -> bool:
        return math.isinf(self.guard.next_change(self.now)) and self.rests


def check_legal(before: Motion, after: Motion) -> None:
    for axis, of in LIMITS.items():
        position, velocity, acceleration = after[axis]
        assert of.minimum - 1e-6 <= position <= of.maximum + 1e-6
        assert abs(velocity) <= of.velocity * (1 + 1e-6)
        assert abs(acceleration) <= of.acceleration * (1 + 1e-6)
        assert abs(acceleration - before[axis].acceleration) <= of.jerk * DT * (1 + 1e-6)


def test_stop_takes_the_fastest_legal_stop_and_latches() -> None:
    run = Run()
    run.until(SequencePhase.PLAYING)
    run.run(1.2)
    moving = dict(run.motion)
    assert abs(moving[PAN].velocity) > 10
    run.press(STOP)
    assert run.demand == {PAN: Stop(), TILT: Stop()}
    assert run.guard.stop == "stopping"
    assert run.guard.note == "stopping: all axes slow down to rest"
    assert run.said == ["STOP by keys. A recording camera keeps recording."]
    ticks = 1
    while not run.rests:
        run.tick()
        ticks += 1
    fastest = {
        axis: stop_phases(s.velocity, s.acceleration, LIMITS[axis].acceleration, LIMITS[axis].jerk)
        for axis, s in moving.items()
    }
    assert ticks <= math.ceil(max(sum(seconds for seconds, _ in each) for each in fastest.values()) / DT) + 1
    for axis, state in moving.items():
        end = stop_state(state, LIMITS[axis].acceleration, LIMITS[axis].jerk, math.inf).position
        assert run.motion[axis].position == pytest.approx(end, abs=1e-6)
    run.tick()  # whose feedback is that they rest
    assert run.guard.stop == "stopped"
    assert run.guard.note == "STOPPED. Press c to clear, q to end."
    there = dict(run.motion)
    run.press(STOP)  # a second one does nothing
    run.press(PAUSE, GO)  # and nothing goes on before it is cleared
    run.run(3)
    assert run.motion == there
    assert run.guard.over(run.controls.status(run.now)).stop == "stopped"


@pytest.mark.parametrize("go", [PAUSE, GO])
def test_after_clear_the_run_goes_on_from_where_it_was_left_and_no_cue_is_lost_or_repeated(go: Command) -> None:
    run = Run()
    run.until(SequencePhase.PLAYING)
    run.run(1.2)
    left = run.sequence.playback.time(run.now)
    run.press(STOP)
    run.run(4)
    assert run.acts == [Action.RECORD, DeviceCommand("gimbal", "follow lock")]
    run.press(CLEAR)
    assert run.guard.note == "STOP cleared. Press p or Enter to continue, q to end."
    rest = dict(run.motion)
    run.run(2)
    assert run.motion == rest
    run.press(go)
    run.until(SequencePhase.REJOINING)
    run.until(SequencePhase.PLAYING)
    path = run.sequence.playback.at(run.now)[1]
    assert run.sequence.playback.time(run.now) == pytest.approx(left, abs=2 * DT)
    assert run.motion[PAN].position == pytest.approx(path[PAN].position, abs=1e-4)
    while not run.over:
        run.tick()
    assert run.acts == [cue.action for cue in CUES]
    assert run.motion[PAN].position == pytest.approx(-30, abs=1e-4)


@pytest.mark.parametrize(
    "phase",
    [
        SequencePhase.EASING,
        SequencePhase.PREROLL,
        SequencePhase.ARMED,
        SequencePhase.RETURNING,
        SequencePhase.REJOINING,
    ],
)
def test_stop_counts_in_every_phase_and_the_run_comes_to_its_end_all_the_same(phase: SequencePhase) -> None:
    trigger = Trigger()
    waits = phase is SequencePhase.ARMED
    run = Run(Cycle(1.0, back_to_one=True, trigger=trigger if waits else None), start=-40)
    if phase is SequencePhase.REJOINING:
        run.until(SequencePhase.PLAYING)
        run.run(1)
        run.press(STOP, CLEAR)
        assert run.guard.stop  # in the same tick the STOP has the last word
        run.press(CLEAR, GO)
    elif phase is SequencePhase.RETURNING:
        run.until(SequencePhase.PLAYING)
    run.until(phase)
    run.run(0.2)
    assert run.sequence.phase is phase
    run.press(STOP)
    run.run(1)
    there = dict(run.motion)
    trigger.fires = True
    run.run(5)
    assert (run.motion, run.rests, run.guard.stop) == (there, True, "stopped")
    run.press(CLEAR, GO)
    if waits:
        run.run(3)
        assert run.sequence.phase is SequencePhase.ARMED, "a trigger that fired during the STOP starts nothing"
        trigger.fires = True
    for _ in range(6000):
        if run.over:
            break
        run.tick()
    assert run.over
    assert run.acts == [cue.action for cue in CUES]
    assert run.motion[PAN].position == pytest.approx(0, abs=1e-4)


def test_a_trigger_that_went_by_during_a_stop_leaves_the_start_to_the_operator() -> None:
    trigger = Trigger()
    run = Run(Cycle(0.2, trigger=trigger))
    run.until(SequencePhase.ARMED)
    run.press(STOP)
    trigger.late = "18:30:00 was 5.0 s before the rig reached the start"
    run.run(1)
    run.press(CLEAR, GO)
    run.until(SequencePhase.ARMED)
    trigger.fires = True
    run.run(2)
    assert run.sequence.phase is SequencePhase.ARMED
    assert run.controls.note.startswith("18:30:00 was 5.0 s before the rig reached the start: enter start ")
    run.press(GO)
    run.run(1)
    assert run.sequence.phase is SequencePhase.PLAYING


def test_stop_while_it_waits_for_the_operator_and_it_waits_again_afterwards() -> None:
    run = Run(cues=[Cue(4, Wait()), Cue(4, Action.SHUTTER)])
    run.until(SequencePhase.PLAYING)
    run.run(5)
    assert run.sequence.waiting
    run.press(STOP)
    run.run(0.5)
    run.press(CLEAR, GO)
    run.run(3)
    assert run.sequence.waiting
    assert run.acts == []
    run.press(GO)
    run.run(6)
    assert run.acts == [Action.SHUTTER]
    assert run.over


@pytest.mark.parametrize("phase", [SequencePhase.EASING, SequencePhase.PREROLL, SequencePhase.RETURNING])
def test_p_pauses_on_the_ways_to_the_move_and_from_it_too(phase: SequencePhase) -> None:
    run = Run(Cycle(1.0, back_to_one=True), start=-40)
    run.until(phase)
    run.run(0.2)
    run.press(PAUSE)
    run.run(1)
    there = dict(run.motion)
    run.run(5)
    assert (run.motion, run.sequence.phase) == (there, phase)
    assert run.guard.note == "paused. Press p or Enter to continue, q to end."
    assert run.guard.reason == ""
    run.press(PAUSE)
    while not run.over:
        run.tick()
    assert run.acts == [cue.action for cue in CUES]


def test_a_pause_stays_on_the_path_and_a_stop_during_it_is_latched() -> None:
    run = Run()
    run.until(SequencePhase.PLAYING)
    run.run(1)
    run.press(PAUSE)
    run.run(2)
    path = run.sequence.playback.at(run.now)[1]
    assert run.motion[PAN].position == pytest.approx(path[PAN].position, abs=1e-9)
    there = dict(run.motion)
    run.press(STOP)
    run.press(PAUSE)
    run.run(1)
    assert run.motion == there
    run.press(CLEAR, PAUSE)
    while not run.over:
        run.tick()
    assert run.acts == [cue.action for cue in CUES]


def test_a_pad_stops_what_the_keys_began_and_says_so() -> None:
    run = Run()
    run.until(SequencePhase.PLAYING)
    run.pad.press(STOP)
    run.tick()
    assert run.said == ["STOP by pad. A recording camera keeps recording."]
    assert run.guard.stopped_by == "pad"


def test_q_ends_a_stopped_run_and_the_reasons_say_that_it_was_stopped() -> None:
    run = Run()
    run.until(SequencePhase.PLAYING)
    run.press(STOP)
    run.press(QUIT)
    assert str(run.ended) == "stopped by keys"
    assert run.guard.reason == "ended while stopped: STOP by keys"


@pytest.mark.parametrize("phase", [SequencePhase.EASING, SequencePhase.PLAYING])
def test_an_input_whose_stop_is_lost_pauses_the_run(phase: SequencePhase) -> None:
    run = Run(start=-40)
    run.pad.stop = ""
    run.until(phase)
    run.run(0.5)
    run.pad.stop = "pad: unplugged"
    run.run(1.5)
    there = dict(run.motion)
    run.run(3)
    assert (run.motion, run.rests) == (there, True)
    assert run.said == ["pad: unplugged: STOP lost, the run pauses"]
    run.press(PAUSE)
    run.pad.stop = ""
    run.tick()
    assert run.said[1:] == ["pad: its STOP works again"]
    while not run.over:
        run.tick()
    assert run.acts == [cue.action for cue in CUES]


def test_an_input_that_is_absent_from_the_start_blocks_nothing() -> None:
    run = Run()
    run.pad.stop = "pad: cannot be opened"
    while not run.over:
        run.tick()
    assert run.said == ["pad: cannot be opened: its STOP does not work"]
    assert run.acts == [cue.action for cue in CUES]


def test_a_calibration_move_that_was_stopped_begins_anew_where_the_axis_rests() -> None:
    keys = FakeInput("keys")
    swing = CalibrationMove(PAN, LIMITS[PAN], 6, 2)
    guard = StopGuard(swing, [Relay(keys)])
    planner = Live({PAN: LIMITS[PAN]}, DT)
    motion = {PAN: State(0.0)}
    planner.reset(motion)
    guard.start(0.0, motion)
    now = rest = 0.0
    script = {300: STOP, 500: CLEAR, 600: GO}
    for tick in range(3000):
        now += DT
        if tick in script:
            keys.press(script[tick])
        demand, _ = guard.read(now, Feedback(motion, {}))
        motion = planner.step(demand)
        if tick == 450:
            assert motion[PAN].velocity == 0
            rest = motion[PAN].position
            assert rest > 0.5
        if math.isinf(guard.next_change(now)):
            break
    assert swing.begin == pytest.approx(6.01 + 1, abs=2 * DT)
    assert motion[PAN].position == pytest.approx(rest)


def test_recorded_sticks_stand_still_during_a_stop_and_go_on_where_they_were() -> None:
    pad = FakeInput("pad")
    sticks = SticksSource(Sticks([PAN], [0.0, 2.0, 3.0], [[0.5], [0.0], [0.0]]), lambda _axis, share: 60 * share)
    guard = StopGuard(sticks, [Relay(pad)])
    planner, motion, now = Live({PAN: LIMITS[PAN]}, DT), {PAN: State(0.0)}, 0.0
    planner.reset(motion)
    guard.start(now, motion)
    for tick in range(3000):
        now += DT
        for at, command in ((100, STOP), (400, CLEAR), (500, GO)):
            if tick == at:
                pad.press(command)
        demand, _ = guard.read(now, Feedback(motion, {}))
        motion = planner.step(demand)
        assert not 200 < tick < 500 or motion[PAN].velocity == 0
        if math.isinf(guard.next_change(now)):
            break
    assert now == pytest.approx(3 + 4, abs=2 * DT)
    assert motion[PAN].velocity == 0


PRESSES = st.sampled_from(
    [STOP, STOP, CLEAR, PAUSE, GO, Command.FASTER, Command.SLOWER, Command.NEXT, Command.PREVIOUS]
)


@settings(max_examples=60, deadline=None)
@given(
    script=st.lists(st.tuples(st.integers(1, 120), PRESSES), max_size=25),
    start=st.sampled_from([0.0, -40.0]),
    passes=st.sampled_from([1, 2]),
)
def test_whatever_is_pressed_nothing_moves_while_stopped_and_each_cue_comes_once_and_in_order(
    script: list, start: float, passes: int
) -> None:
    run = Run(Cycle(0.3, passes=passes, back_to_one=True), start=start)
    stopped_for = 0
    for ticks, command in script:
        run.keys.press(command)
        for _ in range(ticks):
            run.tick()
            stopped_for = stopped_for + 1 if run.guard.stop else 0
            if stopped_for > 80:  # the fastest stop takes 0.7 s
                assert run.rests
            if run.over:
                break
    expected = [cue.action for cue in CUES] * passes
    assert run.acts == expected[: len(run.acts)]
    # And whatever it was left in, it can be ended: by going on to its end, or with q.
    for _ in range(40):
        if run.over:
            break
        run.press(CLEAR, GO)
        if run.sequence.playback.paused and not run.guard.halted and not run.sequence.playback.changing(run.now):
            run.press(PAUSE)
        run.run(3)
    else:
        run.press(QUIT)
        assert run.ended or run.controls._stopped
        return
    assert run.acts == expected

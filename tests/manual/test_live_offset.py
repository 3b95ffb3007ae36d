"""A hand on a running sequence: whatever both do the sum is legal; an offset is held, let go, as safe as any hand."""

import math

import pytest
from at_once import AtOnce
from fakes import NO_FEEDBACK
from hands import FakeInput
from hypothesis import given, settings
from hypothesis import strategies as st

from teleop.config.operator_settings import SticksSection
from teleop.core.axes import Axis, Limits, State
from teleop.core.interfaces import Feedback
from teleop.core.operator_input import Command
from teleop.core.setpoints import StateTarget, Stop
from teleop.manual.live_offset import LiveOffset
from teleop.manual.stop_guard import Relay, StopGuard
from teleop.planner.keyframes.planner import Key, plan
from teleop.planner.live import Live
from teleop.planner.offset_limits import sequence_limits, trim_limits
from teleop.sequence.compile import CompiledSequence
from teleop.sequence.cycle import Cycle
from teleop.sequence.phases import SequencePhase
from teleop.sequence.playback_controls import PlaybackControls
from teleop.sequence.source import SequenceSource

PAN, TILT = Axis.PAN, Axis.TILT
LIMITS = {PAN: Limits(-170, 170, 60, 120, 600), TILT: Limits(-30, 40, 40, 90, 480)}
KEYS = {
    PAN: [Key(0, 0), Key(2, 30), Key(4, 60, hold=1), Key(9, -30)],
    TILT: [Key(0, 0), Key(3, 25), Key(9, -20)],
}
SHARE = 0.75
MOVE = plan(KEYS, sequence_limits(LIMITS, SHARE))
DT = 0.01
FAST = SticksSection(start_range=3, low_pass=0.02, ramp=0.1)


class Set:
    """A sequence under a controls with a pad and keys, and the live planner of all limits that carries the sum out."""

    def __init__(self, passes: float = 1) -> None:
        self.pad, self.keys = FakeInput("pad"), FakeInput("keys")
        performance = CompiledSequence("Test", MOVE, [], [], KEYS)
        staging = Cycle(0.5, passes=passes)
        limits = sequence_limits(LIMITS, SHARE)
        self.sequence = SequenceSource(performance, limits, 1.0, AtOnce(), staging)
        self.trimming = LiveOffset(trim_limits(MOVE, LIMITS, SHARE), [self.pad, self.keys], FAST)
        self.kept: list[dict] = []
        self.controls = PlaybackControls(self.sequence, self.keys, self.trimming, self._keep)
        self.now, self.ticks = 50.0, 0
        here = {PAN: State(-20.0), TILT: State(3.0)}
        self.live = Live(LIMITS, DT)
        self.live.reset(here)
        self.controls.start(self.now, here)

    def guard(self) -> StopGuard:
        """The same under a guard, which from then on is to be used in its place."""
        relays = [Relay(self.pad), Relay(self.keys)]
        trimming = LiveOffset(trim_limits(MOVE, LIMITS, SHARE), relays, FAST)
        self.trimming, self.controls = trimming, PlaybackControls(self.sequence, relays[1], trimming)
        guard = StopGuard(self.controls, relays)
        guard.start(self.now, self.live.motion)
        return guard

    def _keep(self) -> str:
        self.kept.append(dict(self.trimming.offsets))
        return "kept"

    def step(self, ticks: int = 1) -> dict[Axis, State]:
        """One tick, late ones too; asserts that the sum is legal and met."""
        self.now += ticks * DT
        self.ticks += 1
        demand, _ = self.controls.read(self.now, NO_FEEDBACK)
        before = self.live.motion
        after = self.live.step(demand, ticks)
        for axis, limits in LIMITS.items():
            wish = demand[axis]
            assert isinstance(wish, StateTarget)
            position, velocity, acceleration = after[axis]
            assert abs(position - wish.position) < 1e-6
            assert limits.minimum - 1e-6 <= position <= limits.maximum + 1e-6
            assert abs(velocity) <= limits.velocity + 1e-6
            assert abs(acceleration) <= limits.acceleration + 1e-6
            assert abs(acceleration - before[axis].acceleration) / (ticks * DT) <= limits.jerk + 1e-6
        return after

    def run(self, seconds: float) -> dict[Axis, State]:
        for _ in range(round(seconds / DT) - 1):
            self.step()
        return self.step()

    def until(self, phase: SequencePhase) -> None:
        while self.sequence.phase is not phase:
            self.step()

    def offset(self, axis: Axis = PAN) -> State:
        return self.trimming.offsets[axis]


ASKS = [*[Command.PAUSE] * 3, Command.FASTER, Command.SLOWER, Command.NEXT, Command.PREVIOUS, Command.RECENTER]
phases = st.lists(
    st.tuples(
        st.sampled_from([250, 300, 900]),
        st.floats(-1, 1),
        st.sampled_from([-1.0, 0.0, 1.0]),
        st.sampled_from([*[None] * 16, *ASKS]),
        st.sampled_from(["", "silent for 0.2 s"]),
        st.sampled_from([1, 1, 1, 4]),
    ),
    min_size=25,
    max_size=25,
)


@settings(max_examples=16, deadline=None)
@given(phases)
def test_whatever_sequence_and_hands_do_the_sum_keeps_every_limit_and_is_met_exactly(script):
    """At least 1e5 ticks in all: each example plays 6250 or more."""
    scene = Set(passes=float("inf"))
    scene.until(SequencePhase.PLAYING)
    for ticks, pan, tilt, command, trouble, late in script:
        scene.pad.hold(pan=pan, tilt=tilt)
        scene.pad.trouble = trouble
        if command:
            scene.keys.press(command)
        scene.step(late)
        for _ in range(ticks):
            scene.step()
        scene.pad.hold()
    assert scene.ticks >= 6250


def test_an_offset_is_held_by_itself_and_goes_back_to_nothing_when_let_go():
    scene = Set()
    scene.until(SequencePhase.PLAYING)
    scene.pad.hold(pan=0.5)
    scene.run(1)
    scene.pad.hold()
    scene.run(1)
    held = scene.offset()
    assert held.position > 3
    assert held[1:] == (0.0, 0.0)
    scene.run(1)
    assert scene.offset() == held
    scene.keys.press(Command.RECENTER)
    scene.run(1)
    assert 0 < scene.offset().position < held.position
    scene.run(3)
    assert scene.offset() == State(0.0)


def test_a_stick_takes_a_release_over_and_keys_move_on_by_steps():
    scene = Set()
    scene.until(SequencePhase.PLAYING)
    scene.keys.turn(PAN, 4.0)
    scene.run(2)
    assert scene.offset().position == pytest.approx(4.0)
    scene.pad.press(Command.RECENTER)
    scene.run(0.3)
    scene.pad.hold(pan=1.0)
    scene.run(0.5)
    scene.pad.hold()
    scene.run(2)
    assert scene.offset().position > 4.0


def test_a_hand_is_to_be_centred_first_and_stale_it_rests():
    scene = Set()
    scene.pad.hold(pan=1.0)
    scene.until(SequencePhase.PLAYING)
    scene.run(1)
    assert scene.offset() == State(0.0)
    scene.pad.hold()
    scene.run(0.1)
    scene.pad.hold(pan=1.0)
    scene.run(1)
    assert scene.offset().velocity > 1
    scene.pad.trouble = "pad: silent for 0.2 s"
    scene.run(1)
    rests = scene.offset()
    assert rests[1:] == (0.0, 0.0)
    scene.pad.trouble = ""
    scene.run(0.5)
    assert scene.offset() == rests  # held over all the time: not trusted until it was let go
    assert "pad: silent for 0.2 s: pan stopped" in [said.text for said in scene.trimming.messages]


def test_on_the_way_to_the_start_and_after_the_end_nothing_is_trimmed():
    scene = Set()
    scene.step()
    scene.pad.hold(pan=1.0)
    while scene.sequence.phase is SequencePhase.EASING:
        scene.step()
        assert scene.offset() == State(0.0) or scene.sequence.phase is not SequencePhase.EASING
    scene.until(SequencePhase.OVER)
    scene.run(1.5)
    assert scene.offset()[1:] == (0.0, 0.0)
    assert scene.controls.next_change(scene.now) == float("inf")


def test_a_stop_halts_sequence_and_trim_and_both_are_met_again_afterwards():
    scene = Set()
    guard = scene.guard()
    taken = []

    def run(seconds: float) -> None:
        for _ in range(round(seconds / DT)):
            scene.now += DT
            demand, _ = guard.read(scene.now, Feedback(scene.live.motion, {}))
            before, after = scene.live.motion, scene.live.step(demand)
            for axis, limits in LIMITS.items():
                assert abs(after[axis].velocity) <= limits.velocity + 1e-6
                assert abs(after[axis].acceleration) <= limits.acceleration + 1e-6
                assert abs(after[axis].acceleration - before[axis].acceleration) / DT <= limits.jerk + 1e-6
            taken.append((demand, after))

    run(5)
    assert scene.sequence.phase is SequencePhase.PLAYING
    scene.pad.hold(pan=0.6)
    run(1)
    scene.pad.press(Command.STOP)
    run(DT)
    assert taken[-1][0] == {PAN: Stop(), TILT: Stop()}
    run(2)
    offset = scene.offset()
    assert offset.velocity == 0
    assert offset.position > 1
    there = taken[-1][1]
    scene.keys.turn(PAN, 5.0)  # what is asked for meanwhile moves nothing, then or later
    run(1)
    scene.keys.press(Command.CLEAR)
    run(1)
    assert taken[-1][1] == there
    scene.keys.press(Command.GO)
    run(DT)
    scene.pad.hold(pan=0.9)  # and a stick that was held over all along moves nothing before it was let go
    while scene.sequence.phase is not SequencePhase.PLAYING:
        run(DT)
    run(0.5)
    assert scene.offset() == offset
    bare = scene.sequence.playback.at(scene.now)[1][PAN].position
    assert taken[-1][1][PAN].position == pytest.approx(bare + offset.position, abs=1e-6)
    while not math.isinf(guard.next_change(scene.now)):
        run(DT)
    assert taken[-1][1][PAN].position == pytest.approx(-30 + offset.position, abs=1e-5)


def test_a_pads_buttons_change_the_trims_speed_and_the_keys_that_of_the_move():
    scene = Set()
    scene.until(SequencePhase.PLAYING)
    scene.pad.press(Command.SLOWER)
    scene.run(0.5)
    assert scene.trimming.share == 0.35
    assert scene.sequence.playback.chosen == 1.0
    scene.keys.press(Command.SLOWER)
    scene.run(0.5)
    assert scene.trimming.share == 0.35
    assert scene.sequence.playback.chosen == pytest.approx(0.9)
    scene.keys.press(Command.RANGE)
    scene.run(0.1)
    assert scene.trimming.share == 1.0
    scene.pad.press(Command.STORE, 3)
    scene.run(0.1)
    assert "store: not available while a sequence plays" in scene.controls.note


def test_the_trim_is_kept_when_the_key_says_so_and_shown():
    scene = Set()
    scene.until(SequencePhase.PLAYING)
    scene.keys.turn(TILT, -2.0)
    scene.run(2)
    scene.keys.press(Command.KEEP)
    scene.step()
    assert scene.kept[0][TILT].position == pytest.approx(-2.0)
    assert "kept" in scene.controls.note
    assert "tilt -2.000" in scene.controls.note


def test_paused_the_move_stands_and_the_trim_goes_on():
    scene = Set()
    scene.until(SequencePhase.PLAYING)
    scene.run(1)
    scene.keys.press(Command.PAUSE)
    scene.run(2)
    before = scene.live.motion[PAN].position
    scene.keys.turn(PAN, -5.0)
    scene.run(3)
    assert scene.live.motion[PAN].position == pytest.approx(before - 5.0)

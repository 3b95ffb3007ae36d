"""A sequence under an operator's keys: they pause, step and change the speed, and say why not."""

import math

import pytest
from at_once import AtOnce
from fakes import NO_FEEDBACK

from teleop.core.axes import Axis, Limits, State
from teleop.core.errors import Interrupted
from teleop.core.events import Action
from teleop.core.operator_input import Command, Held, Press
from teleop.core.setpoints import StateTarget
from teleop.planner.keyframes.planner import Key, plan
from teleop.planner.live import Live
from teleop.sequence.compile import CompiledSequence
from teleop.sequence.cues import Cue, Wait
from teleop.sequence.playback_controls import HELP, PlaybackControls
from teleop.sequence.progress import progress_text
from teleop.sequence.source import SequenceSource

LIMITS = {Axis.PAN: Limits(-180, 180, 60, 120, 600)}
KEYS = {Axis.PAN: [Key(0, 0), Key(4, 30), Key(10, 60)]}
DT = 0.01
PAUSE, FASTER, SLOWER, NEXT, PREVIOUS, QUIT, GO = (
    Press(each)
    for each in (
        Command.PAUSE,
        Command.FASTER,
        Command.SLOWER,
        Command.NEXT,
        Command.PREVIOUS,
        Command.QUIT,
        Command.GO,
    )
)


class Keys:
    """What was pressed since the last look."""

    name = "keys"

    def __init__(self) -> None:
        self.pressed: list = []

    def read(self, now: float) -> Held:
        pressed, self.pressed = self.pressed, []
        return Held(presses=pressed)


class Show:
    def __init__(self) -> None:
        self.keys = Keys()
        self.sequence = SequenceSource(
            CompiledSequence("Test", plan(KEYS, LIMITS), [], [], KEYS), LIMITS, executor=AtOnce()
        )
        self.controls = PlaybackControls(self.sequence, self.keys)
        self.controls.start(0.0, {Axis.PAN: State(0.0)})
        self.now = 0.0
        self.run(self.sequence.begin)

    def press(self, *keys) -> None:
        """Press them at the next tick; then as long as their change is searched for and made."""
        self.keys.pressed += keys
        self.run(DT)
        while self.sequence.playback.changing(self.now):
            self.run(DT)

    def run(self, seconds: float) -> float:
        """On for so long; where the pan is then."""
        demand = {}
        for _ in range(round(seconds / DT)):
            self.now += DT
            demand, _ = self.controls.read(self.now, NO_FEEDBACK)
        wish = demand[Axis.PAN]
        assert isinstance(wish, StateTarget)
        return wish.position


def test_p_pauses_and_goes_on():
    show = Show()
    show.run(2)
    show.press(PAUSE)
    here = show.run(1)
    assert show.run(5) == here
    assert show.controls.note == f"paused  {HELP}"
    assert show.controls.next_change(show.now) <= show.now + 0.05
    show.press(SLOWER)
    assert show.controls.note == f"paused, continues at 90%  {HELP}"
    show.press(FASTER)
    show.press(PAUSE)
    assert show.run(1) > here
    assert show.controls.note == f"100%  {HELP}"


def test_arrows_go_to_the_keys_while_it_is_paused_and_are_refused_while_it_plays():
    show = Show()
    show.run(5)
    show.press(NEXT)
    assert show.controls.note == "the move is running: pause it before stepping to a key"
    show.press(PAUSE)
    show.press(PREVIOUS)
    assert show.run(1) == pytest.approx(30)
    show.press(NEXT)
    assert show.run(1) == pytest.approx(60)


def test_the_speed_goes_up_to_what_the_move_allows_and_down_to_a_tenth():
    show = Show()
    show.run(1)
    show.press(*[FASTER] * 30)
    most = show.sequence.playback.at_most
    assert show.sequence.playback.chosen == most
    assert show.sequence.playback.rate(show.now) == pytest.approx(most)
    show.press(*[SLOWER] * 40)
    assert show.controls.note.startswith("10%")


def test_before_the_move_begins_keys_are_answered_and_do_nothing():
    show = Show()
    early = PlaybackControls(show.sequence, show.keys)
    early.start(0.0, {Axis.PAN: State(-40.0)})
    show.keys.pressed.append(PAUSE)
    early.read(0.01, NO_FEEDBACK)
    assert early.note == "the move has not begun"
    assert not show.sequence.playback.changing(show.sequence.begin)


def test_what_was_said_before_the_move_is_not_said_while_it_plays():
    show = Show()
    again = PlaybackControls(show.sequence, show.keys)
    again.start(0.0, {Axis.PAN: State(20.0)})
    show.keys.pressed += [PAUSE]
    again.read(DT, NO_FEEDBACK)
    assert again.note == "the move has not begun"
    again.read(show.sequence.begin, NO_FEEDBACK)
    assert again.note == f"100%  {HELP}"


def test_it_is_over_when_the_sequence_is():
    show = Show()
    show.run(12)
    assert show.controls.next_change(show.now) == float("inf")


def test_an_end_by_the_operator_ends_the_run_at_once():
    show = Show()
    show.run(2)
    show.keys.pressed.append(QUIT)
    show.now += DT
    with pytest.raises(Interrupted, match="stopped by keys"):
        show.controls.read(show.now, NO_FEEDBACK)


def test_go_is_for_a_move_that_waits_and_means_nothing_else():
    show = Show()
    show.run(1)
    show.press(GO)
    assert show.controls.note == f"100%  {HELP}"


WAITING = {Axis.PAN: [Key(0, 0), Key(4, 30, stop=True), Key(10, 60)]}


class WaitingShow(Show):
    """A move that waits in its middle, at 4 s, and shoots before and after that."""

    def __init__(self, speed: float = 1.0) -> None:
        self.keys = Keys()
        cues = [Cue(4, Action.STOP), Cue(4, Wait()), Cue(4, Action.RECORD), Cue(7, Action.SHUTTER)]
        performance = CompiledSequence("Test", plan(WAITING, LIMITS), cues, [], WAITING)
        self.sequence = SequenceSource(performance, LIMITS, speed, executor=AtOnce())
        self.controls = PlaybackControls(self.sequence, self.keys)
        self.controls.start(0.0, {Axis.PAN: State(0.0)})
        self.now = 0.0
        self.acts: list = []
        self.motion: list[tuple[float, StateTarget]] = []
        self.watch(self.sequence.begin)

    def watch(self, seconds: float) -> None:
        for _ in range(round(seconds / DT)):
            self.now += DT
            demand, acts = self.controls.read(self.now, NO_FEEDBACK)
            self.acts += [(self.now, act) for act in acts]
            follow = demand[Axis.PAN]
            assert isinstance(follow, StateTarget)
            self.motion.append((self.now, follow))


@pytest.mark.parametrize("speed", [1.0, 1.37])
@pytest.mark.parametrize("key", [GO, PAUSE])
def test_a_wait_holds_for_the_operator_and_no_cue_drifts(speed: float, key: Press) -> None:
    show = WaitingShow(speed)
    begin = show.sequence.begin
    show.watch(60)
    held = [follow for now, follow in show.motion if now > begin + 4 / speed + DT]
    assert len(held) > 3000
    assert all(follow == pytest.approx((30, 0, 0), abs=1e-5) for follow in held)
    assert [act for _, act in show.acts] == [Action.STOP]
    assert "waiting for you" in progress_text(show.sequence, show.now)
    assert "enter continue" in show.controls.note
    assert show.now < show.controls.next_change(show.now) <= show.now + 0.06
    went = show.now
    show.keys.pressed.append(key)
    show.watch(8)
    (_, stop), (recorded, record), (shot, shutter) = show.acts
    assert (stop, record, shutter) == (Action.STOP, Action.RECORD, Action.SHUTTER)
    assert recorded == pytest.approx(went + DT)
    assert shot == pytest.approx(went + 3 / speed, abs=2 * DT)
    assert show.motion[-1][1].position == pytest.approx(60)
    assert math.isinf(show.controls.next_change(show.now))


@pytest.mark.parametrize("speed", [1.0, 1.37])
def test_the_stream_around_a_wait_is_legal_step_by_step(speed: float) -> None:
    show = WaitingShow(speed)
    show.watch(10)
    show.keys.pressed.append(GO)
    show.watch(8)
    live = Live(LIMITS, DT)
    live.reset({Axis.PAN: State(0.0)})
    for _, follow in show.motion:
        state = live.step({Axis.PAN: follow})[Axis.PAN]
        assert state.position == pytest.approx(follow.position, abs=1e-6)


def test_while_it_waits_it_cannot_be_stepped_and_the_speed_counts_afterwards() -> None:
    show = WaitingShow()
    show.watch(6)
    show.keys.pressed += [NEXT, SLOWER]
    show.watch(1)
    assert show.sequence.waiting
    show.keys.pressed.append(NEXT)
    show.watch(DT)
    assert "the move is waiting" in show.controls.note
    show.keys.pressed.append(GO)
    went = show.now
    show.watch(8)
    assert show.acts[-1][0] == pytest.approx(went + 3 / 0.9, abs=2 * DT)


def test_a_stop_ends_it_while_it_waits() -> None:
    show = WaitingShow()
    show.watch(6)
    show.keys.pressed.append(QUIT)
    with pytest.raises(Interrupted):
        show.controls.read(show.now + DT, NO_FEEDBACK)


def test_a_drone_is_not_paused() -> None:
    limits = {Axis.STICK_YAW: Limits(-1, 1, 2, 8, 40)}
    keys = {Axis.STICK_YAW: [Key(0, 0), Key(4, 0.5), Key(8, 0)]}
    pressed = Keys()
    sequence = SequenceSource(CompiledSequence("Fly", plan(keys, limits), [], [], keys), limits, executor=AtOnce())
    controls = PlaybackControls(sequence, pressed)
    controls.start(0.0, {Axis.STICK_YAW: State(0.0)})
    controls.read(sequence.begin + 1, NO_FEEDBACK)
    pressed.pressed.append(PAUSE)
    controls.read(sequence.begin + 1.01, NO_FEEDBACK)
    assert "a drone keeps flying" in controls.note
    assert not sequence.playback.changing(sequence.begin + 1.01)

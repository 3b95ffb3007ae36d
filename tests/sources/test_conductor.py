"""A sequence under an operator's keys: they pause, step and change the speed, and say why not."""

import pytest
from at_once import AtOnce

from teleop.motion import Axis, Follow, Halt, Limits, State, Tick
from teleop.planner.keyframes import Key, plan
from teleop.ports import Interrupted
from teleop.sources.conductor import HELP, Conductor
from teleop.sources.inputs import Command, Held, Press
from teleop.sources.sequence import SequenceSource
from teleop.sources.sequence_file import Performance

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
        self.sequence = SequenceSource(Performance("Test", plan(KEYS, LIMITS), [], [], KEYS), LIMITS, executor=AtOnce())
        self.conductor = Conductor(self.sequence, self.keys)
        self.conductor.start(0.0, {Axis.PAN: State(0.0)})
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
            demand, _ = self.conductor.read(self.now)
        wish = demand[Axis.PAN]
        assert isinstance(wish, Follow)
        return wish.position


def test_space_pauses_and_goes_on():
    show = Show()
    show.run(2)
    show.press(PAUSE)
    here = show.run(1)
    assert show.run(5) == here
    assert show.conductor.note == f"paused  {HELP}"
    assert show.conductor.next_change(show.now) <= show.now + 0.05
    show.press(PAUSE)
    assert show.run(1) > here
    assert show.conductor.note == f"100%  {HELP}"


def test_arrows_go_to_the_keys_while_it_is_paused_and_are_refused_while_it_plays():
    show = Show()
    show.run(5)
    show.press(NEXT)
    assert show.conductor.note == "the move is running: pause it before stepping to a key"
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
    assert show.conductor.note.startswith("10%")


def test_before_the_move_begins_keys_are_answered_and_do_nothing():
    show = Show()
    early = Conductor(show.sequence, show.keys)
    early.start(0.0, {Axis.PAN: State(-40.0)})
    show.keys.pressed.append(PAUSE)
    early.read(0.01)
    assert early.note == "the move has not begun"
    assert not show.sequence.playback.changing(show.sequence.begin)


def test_it_is_over_when_the_sequence_is():
    show = Show()
    show.run(12)
    assert show.conductor.next_change(show.now) == float("inf")


def test_stop_halts_at_once_and_ends_the_run_without_losing_a_tick():
    show = Show()
    show.run(2)
    show.keys.pressed.append(QUIT)
    show.now += DT
    demand, acts = show.conductor.read(show.now)
    assert (demand, acts) == ({Axis.PAN: Halt()}, ())
    with pytest.raises(Interrupted, match="stopped by keys"):
        show.conductor.write(Tick(show.now, {}, demand, (), {}))


def test_go_is_for_a_move_that_waits_and_means_nothing_else():
    show = Show()
    show.run(1)
    show.press(GO)
    assert show.conductor.note == f"100%  {HELP}"

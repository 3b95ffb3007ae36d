"""What is said of a sequence while it plays: phase, times, next key and cue, passes."""

from __future__ import annotations

import math

import pytest
from at_once import AtOnce
from fakes import NO_FEEDBACK

from teleop.core.axes import Axis, Limits, State
from teleop.core.events import Action
from teleop.core.run_status import NextCue, NextKey, RunStatus
from teleop.planner.keyframes.planner import Key, plan
from teleop.sequence.compile import CompiledSequence
from teleop.sequence.cues import Cue
from teleop.sequence.cycle import Cycle
from teleop.sequence.phases import SequencePhase
from teleop.sequence.progress import progress_text, run_status
from teleop.sequence.source import SequenceSource

PAN = Axis.PAN
LIMITS = {PAN: Limits(-180, 180, 60, 120, 600)}
KEYS = [Key(0, 0), Key(2, 20), Key(4, 40)]
CUES = [Cue(0, Action.RECORD), Cue(3, Action.SHUTTER)]
START = 100.0  # s


class Playing:
    """A sequence that is read tick by tick on a clock of the test's."""

    def __init__(self, cycle: Cycle, here: float = 0.0, speed: float = 1.0) -> None:
        compiled = CompiledSequence("Test", plan({PAN: KEYS}, LIMITS), CUES, [], {PAN: KEYS})
        self.source = SequenceSource(compiled, LIMITS, speed, AtOnce(), cycle)
        self.now = START
        self.source.start(self.now, {PAN: State(here)})
        self.source.read(self.now, NO_FEEDBACK)

    def until(self, phase: SequencePhase, seconds: float = 0.0) -> RunStatus:
        """The status so many seconds after this phase began."""
        while self.source.phase is not phase:
            assert self.now < START + 60
            self._tick()
        for _ in range(round(seconds * 100)):
            self._tick()
        return run_status(self.source, self.now)

    def _tick(self) -> None:
        self.now = round(self.now + 0.01, 6)
        self.source.read(self.now, NO_FEEDBACK)


def test_before_the_move_nothing_has_elapsed_and_its_first_key_and_cue_come() -> None:
    playing = Playing(Cycle(preroll=3), here=-10)
    status = run_status(playing.source, playing.now)
    assert status.phase.startswith("to the start ")
    assert (status.elapsed, status.left) == (None, 4)
    assert status.cue == NextCue(0, "record")
    status = playing.until(SequencePhase.PREROLL, 1)
    assert status.phase == "starts in  2.0 s"
    assert status.key == NextKey(2, 2)


def test_in_the_move_a_key_that_is_reached_is_behind() -> None:
    playing = Playing(Cycle())
    status = playing.until(SequencePhase.PLAYING, 1.99)
    assert (status.phase, status.key, status.cue) == ("playing", NextKey(2, 2), NextCue(3, "shutter"))
    status = playing.until(SequencePhase.PLAYING, 0.01)
    assert (status.key, status.elapsed, status.left) == (NextKey(3, 4), pytest.approx(2), pytest.approx(2))
    status = playing.until(SequencePhase.PLAYING, 1.5)
    assert status.cue is None


def test_what_is_left_is_told_at_the_speed_that_was_chosen() -> None:
    playing = Playing(Cycle(), speed=0.5)
    status = playing.until(SequencePhase.PLAYING, 2)
    assert (status.elapsed, status.left) == (pytest.approx(1), pytest.approx(6))
    assert status.speed == 0.5


def test_at_the_end_all_of_it_has_elapsed_and_nothing_comes() -> None:
    playing = Playing(Cycle(back_to_one=True))
    status = playing.until(SequencePhase.RETURNING)
    assert status.phase.startswith("back to one ")
    assert (status.elapsed, status.left, status.key, status.cue) == (4, 0, None, None)
    assert playing.until(SequencePhase.OVER).phase == "done"


def test_a_pause_is_said_to_be_one() -> None:
    playing = Playing(Cycle())
    playing.until(SequencePhase.PLAYING, 1)
    playing.source.playback.pause(playing.now)
    status = playing.until(SequencePhase.PLAYING, 2)
    assert (status.phase, status.paused) == ("paused", True)


@pytest.mark.parametrize(("passes", "said"), [(1, ""), (3, "  pass 1 of 3"), (math.inf, "  pass 1")])
def test_passes_are_counted_where_there_are_several(passes: float, said: str) -> None:
    playing = Playing(Cycle(passes=passes))
    status = playing.until(SequencePhase.PLAYING, 1)
    assert progress_text(playing.source, playing.now).strip() == f"1.0 / 4.0 s{said}"
    assert (status.number, status.passes) == (1, passes)

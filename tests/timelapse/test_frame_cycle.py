"""What a frame goes through, and what becomes of one that comes too late."""

from __future__ import annotations

import math
from pathlib import Path

import pytest
from timelapse_bench import Book, timelapse

from teleop.core.axes import Axis, State
from teleop.core.events import ShutterResult
from teleop.timelapse.frame_cycle import LATE_SHARE, LEAD, RETRY, FrameCycle
from teleop.timelapse.journal import FrameState
from teleop.timelapse.movers import StepMover
from teleop.timelapse.phases import TimelapsePhase
from teleop.timelapse.progress import Progress

SLOT, INTERVAL, EXPOSURE = 20.0, 4.0, 0.5  # s
GRACE = LATE_SHARE * INTERVAL


class Bench:
    """A shoot in steps whose frame 0 is due at `SLOT`, looked at whenever the test likes."""

    def __init__(self, folder: Path, options: str = "settle: 0.3s", first: int = 0) -> None:
        shoot = timelapse(folder, f"mode: shoot-move-shoot, {options}")
        self.mover, self.book = StepMover(shoot), Book()
        self.progress = Progress(shoot.slots, shoot.fps, frame=first)
        self.cycle = FrameCycle(shoot, self.mover, self.book, first, self.progress)
        self.mover.approach(0.0, {Axis.PAN: State(0.0)}, first)
        self.mover.begin(SLOT, shoot.slots.at(first))

    def at(self, now: float) -> TimelapsePhase:
        self.cycle.advance(now)
        return self.cycle.phase

    def shoot(self, now: float, code: int | None = 0) -> None:
        """The frame that waits, and the camera's answer."""
        assert self.at(now) is TimelapsePhase.EXPOSE
        self.cycle.shutter.on_result(ShutterResult(self.cycle.frame, code))


def test_each_phase_says_when_it_ends_and_ends_then(tmp_path: Path) -> None:
    bench = Bench(tmp_path)
    arrival = bench.mover.arrival
    ends = {
        arrival: TimelapsePhase.SETTLE,
        arrival + 0.3: TimelapsePhase.WAIT,
        SLOT - LEAD: TimelapsePhase.PREFOCUS,
        SLOT: TimelapsePhase.EXPOSE,
        SLOT + EXPOSURE: TimelapsePhase.POST,
    }
    for end, phase in ends.items():
        before = bench.cycle.phase
        assert bench.at(end - 0.01) is before
        assert bench.cycle.next_event(end - 0.01) == (math.inf if end == arrival else pytest.approx(end))
        assert bench.at(end) is phase
        assert bench.progress.phase == phase.name.lower()


def test_one_look_may_end_several_phases_up_to_the_one_that_is_named(tmp_path: Path) -> None:
    bench = Bench(tmp_path, "settle: 0s")
    bench.cycle.advance(SLOT, but=TimelapsePhase.WAIT)
    assert bench.cycle.phase is TimelapsePhase.WAIT
    assert bench.at(SLOT) is TimelapsePhase.EXPOSE


def test_a_frame_that_is_a_little_late_is_shot_and_counted(tmp_path: Path) -> None:
    bench = Bench(tmp_path, "settle: 0s")
    bench.shoot(SLOT + GRACE - 0.01)
    assert (bench.progress.late, bench.progress.missed) == (1, 0)
    assert bench.progress.latest == pytest.approx(GRACE - 0.01)


def test_a_frame_that_is_too_late_waits_for_the_next_slot(tmp_path: Path) -> None:
    bench = Bench(tmp_path, "settle: 0s")
    assert bench.at(SLOT + GRACE + 0.01) is TimelapsePhase.WAIT
    assert (bench.progress.late, bench.progress.missed, bench.cycle.frame) == (0, 1, 0)
    assert bench.cycle.next_event(SLOT + GRACE + 0.01) == pytest.approx(SLOT + INTERVAL - LEAD)
    assert bench.book.states(0) == []
    bench.shoot(SLOT + INTERVAL)


def test_a_frame_that_is_not_on_the_disk_in_time_is_not_shot(tmp_path: Path) -> None:
    bench = Bench(tmp_path, "settle: 0s")
    bench.book.writes = False
    assert bench.at(SLOT) is TimelapsePhase.PREFOCUS
    assert bench.at(SLOT + GRACE + 0.01) is TimelapsePhase.WAIT
    assert bench.book.states(0) == [FrameState.BEGUN, FrameState.UNSHOT]
    assert bench.progress.missed == 1


def test_a_pause_waits_for_the_frame_that_was_begun_and_then_holds_the_slot(tmp_path: Path) -> None:
    bench = Bench(tmp_path, "settle: 0s")
    assert bench.at(SLOT - LEAD) is TimelapsePhase.PREFOCUS
    bench.cycle.asked_to_pause = True
    bench.shoot(SLOT)
    bench.at(SLOT + EXPOSURE)
    assert bench.at(bench.mover.arrival) is TimelapsePhase.PAUSED
    assert bench.progress.shot == 1
    assert bench.at(SLOT + 100) is TimelapsePhase.PAUSED
    bench.cycle.asked_to_pause = False
    assert bench.at(SLOT + 100) is TimelapsePhase.PREFOCUS
    bench.shoot(SLOT + 100 + LEAD)
    assert (bench.cycle.frame, bench.progress.missed, bench.progress.late) == (1, 0, 0)


def test_halted_it_ends_its_frame_and_goes_to_no_other(tmp_path: Path) -> None:
    bench = Bench(tmp_path, "settle: 0s")
    bench.shoot(SLOT)
    bench.cycle.halted = True
    assert bench.at(SLOT + EXPOSURE) is TimelapsePhase.STOPPED
    assert (bench.cycle.frame, bench.progress.frame, bench.progress.shot) == (1, 1, 1)
    assert bench.at(SLOT + 100) is TimelapsePhase.STOPPED


def test_after_the_last_frame_it_is_over_once_the_journal_says_so(tmp_path: Path) -> None:
    bench = Bench(tmp_path, "settle: 0s", first=4)
    bench.shoot(SLOT)
    bench.book.writes = False
    assert bench.at(SLOT + EXPOSURE) is TimelapsePhase.FINISH
    assert bench.at(SLOT + 1) is TimelapsePhase.FINISH
    assert bench.book.states(4) == [FrameState.BEGUN, FrameState.DONE]
    [end] = [note for note in bench.book.notes if note.frame is None]
    end.safe = True
    assert bench.at(SLOT + 1.01) is TimelapsePhase.OVER


def test_a_journal_that_could_not_be_written_pauses_the_shoot_and_is_tried_again(tmp_path: Path) -> None:
    bench = Bench(tmp_path, "settle: 0s")
    assert bench.at(SLOT - LEAD) is TimelapsePhase.PREFOCUS
    note = bench.book.notes[-1]
    note.safe, note.failed = False, True
    assert bench.at(SLOT) is TimelapsePhase.PAUSED
    assert bench.progress.problem == "the journal could not be written: trying again"
    assert bench.cycle.next_event(SLOT) == SLOT + RETRY
    assert bench.at(SLOT + RETRY - 0.01) is TimelapsePhase.PAUSED
    assert bench.at(SLOT + RETRY) is not TimelapsePhase.PAUSED
    assert bench.progress.problem == ""
    again = SLOT + RETRY
    while bench.at(again) is not TimelapsePhase.EXPOSE and again < SLOT + 3 * INTERVAL:
        again += 0.01
    assert bench.cycle.phase is TimelapsePhase.EXPOSE
    assert (bench.cycle.frame, bench.progress.lost) == (0, [])

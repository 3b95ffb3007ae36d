"""Whether an interval can hold its frame; `test_compile` has what a user reads of it."""

from __future__ import annotations

from pathlib import Path

import pytest
from timelapse_bench import LIMITS, timelapse

from teleop.timelapse.budget import Phases, budget
from teleop.timelapse.schedule import Schedule


def judged(folder: Path, interval: float, mode: str = "shoot-move-shoot") -> tuple[list[str], list[str]]:
    found = timelapse(folder, f"mode: {mode}")
    phases = Phases(prefocus=0, exposure=0.5, post=0, settle=0.3, below=None)
    slots = Schedule(interval, interval, found.frames)
    return budget(phases, slots, found.path, LIMITS, mode == "continuous")


@pytest.mark.parametrize("mode", ["shoot-move-shoot", "continuous"])
def test_an_interval_is_enough_or_tight_or_refused_with_what_would_be_enough(tmp_path: Path, mode: str) -> None:
    assert judged(tmp_path, 10, mode) == ([], [])
    problems, _ = judged(tmp_path, 0.2, mode)
    assert problems[0].startswith("must be at least ")
    least = float(problems[0].split()[4])
    assert not judged(tmp_path, least, mode)[0]
    assert judged(tmp_path, least, mode)[1], "and that is tight"


def test_one_frame_always_fits(tmp_path: Path) -> None:
    found = timelapse(tmp_path)
    assert budget(found.phases, Schedule(0.01, 0.01, 1), found.path, LIMITS, False) == ([], [])


def test_a_ramp_of_intervals_must_not_pass_zero(tmp_path: Path) -> None:
    found = timelapse(tmp_path)
    problems, _ = budget(found.phases, Schedule(0.1, 10, 5), found.path, LIMITS, False)
    assert problems == ["changes by 3.3 s per frame, too much for its shortest interval"]


def test_a_frame_names_only_the_phases_that_take_time() -> None:
    phases = Phases(prefocus=0, exposure=0.5, post=0, settle=0.3, below=None)
    assert phases.text(move=0.0, settle=0.3) == "exposure 0.5 s + settle 0.3 s"
    assert Phases(0, 0, 0, 0, None).text() == "nothing"

"""What is said of a shoot: how far it is, what it waits for, what went wrong."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from teleop.cli.screens.shoot_view import EVERY, HINTS, RESUMES, ShootView, shoot_status
from teleop.core.axes import Axis, Limits, State
from teleop.core.events import Tick
from teleop.core.setpoints import StateTarget
from teleop.timelapse.progress import Progress
from teleop.timelapse.schedule import Schedule

LIMITS = {Axis.PAN: Limits(-180, 180, 120, 240, 1200)}
SLOTS = Schedule(5.0, 5.0, 1000)
MOTION = {Axis.PAN: State(10.0)}
TICK = Tick(0.0, MOTION, {Axis.PAN: StateTarget(*MOTION[Axis.PAN])}, (), {})


def shooting(folder: Path, progress: Progress) -> ShootView:
    return ShootView("Dusk", LIMITS, folder, progress, silent=False, keys=False)


def test_a_line_comes_with_each_hundredth_and_else_once_a_minute(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    progress = Progress(SLOTS, 24.0, due=5.0)
    with shooting(tmp_path, progress) as view:
        for shot, time in [(0, 0), (9, 1), (10, 2), (11, 3), (19, 2 + EVERY - 1), (19, 2 + EVERY), (19, 3 + EVERY)]:
            progress.shot = shot
            view.observe(replace(TICK, time=float(time)))
    title, *lines = capsys.readouterr().err.splitlines()
    assert title == "Dusk"
    assert [line.partition(" ")[0] for line in lines] == ["0", "10", "19"]


def test_a_line_has_the_frames_the_time_the_clip_and_only_the_troubles_there_are(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    with shooting(tmp_path, Progress(SLOTS, 25.0, shot=50, frame=51, due=2.0, late=3)) as view:
        view.observe(TICK)
    line = capsys.readouterr().err.splitlines()[-1]
    assert line.startswith("50 of 1000 frames  1 h 19 min left  clip 2.00 of 40.00 s  0 missed slots  3 late  ")
    assert line.endswith(" GB free")


def test_it_says_which_frame_it_waits_for_and_for_how_long() -> None:
    progress = Progress(SLOTS, None, frame=7, due=65.0, phase="wait")
    assert shoot_status(progress, 3.0, keys=True).phase == "wait, frame 7 in 1 min 2 s"
    assert shoot_status(progress, 66.0, keys=True).phase == "wait", "it is late"
    progress.phase = "expose"
    assert shoot_status(progress, 3.0, keys=True).phase == "expose"


def test_a_pause_is_announced_until_it_is_there_and_p_then_continues() -> None:
    progress = Progress(SLOTS, None, due=5.0, phase="expose")
    assert shoot_status(progress, 1.0, keys=True).hints == HINTS
    progress.pausing = True
    status = shoot_status(progress, 1.0, keys=True)
    assert (status.phase, status.paused, status.hints) == ("pausing after this frame", False, RESUMES)
    progress.phase = "paused"
    status = shoot_status(progress, 1.0, keys=True)
    assert (status.phase, status.paused) == ("paused", True)
    assert [hint.key for hint in shoot_status(progress, 1.0, keys=False).hints] == ["Ctrl-C"], "nobody reads keys"


def test_before_a_slot_is_known_nothing_is_said_to_be_left() -> None:
    status = shoot_status(Progress(SLOTS, None), 1.0, keys=True)
    assert (status.left, status.phase, status.total, status.done) == (None, "approach", "0 of 1000 frames", 0)
    assert shoot_status(Progress(SLOTS, None, due=5.0), 1.0, keys=True).left == 4 + 999 * 5

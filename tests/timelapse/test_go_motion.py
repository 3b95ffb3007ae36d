"""A go-motion shoot whose journal fails in a run-up: the axes never jump, and the frame is shot after all."""

from __future__ import annotations

from pathlib import Path

from timelapse_bench import LIMITS, Shoot, timelapse

from teleop.core.axes import Axis
from teleop.core.events import ShutterStep
from teleop.core.timing import PERIOD
from teleop.timelapse.phases import TimelapsePhase


def test_a_journal_that_fails_in_a_run_up_pauses_without_a_jump_and_the_frame_is_shot_later(tmp_path: Path) -> None:
    shoot = Shoot(timelapse(tmp_path, "blur: 0.2"))
    while shoot.progress.frame < 2 or shoot.source.phase is not TimelapsePhase.PREFOCUS:
        shoot.book.writes = shoot.progress.frame < 2
        shoot.tick()
    shoot.run(0.8)
    assert shoot.live.motion[Axis.PAN].velocity > 1, "it runs up"
    shoot.book.notes[-1].failed = shoot.book.writes = True
    before = shoot.live.motion[Axis.PAN].velocity
    for _ in range(1500):
        shoot.tick()
        target = shoot.mover.at(shoot.now)[Axis.PAN]
        assert abs(target.velocity - before) <= LIMITS[Axis.PAN].acceleration * PERIOD
        before = target.velocity
    shoot.run()
    presses = [event.frame for _, event in shoot.steps if event.step is ShutterStep.PRESS]
    assert presses == [0, 1, 2, 3, 4]

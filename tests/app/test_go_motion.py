"""Go-motion as the gimbal and its camera see it, on virtual time: where the axes are while each frame exposes."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from shoot_bench import Keys, Shot, SlowBook, Stage

from teleop.core.axes import Axis
from teleop.core.operator_input import Command as Key
from teleop.core.operator_input import Press
from teleop.core.run_state import Result
from teleop.core.timing import PERIOD

FRAMES, EXPOSURE, BLUR, INTERVAL = 4, 1.6, 0.5, 6.0
NEAR = 0.25  # deg: the gimbal is told where to be fifty times a second, and is then up to 25 deg/s away
STOP, CLEAR, GO, PAUSE = (Press(key) for key in (Key.STOP, Key.CLEAR, Key.GO, Key.PAUSE))


@pytest.fixture
def stage(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Stage:
    made = Stage(tmp_path, monkeypatch)
    made.write(FRAMES, f"{INTERVAL}s", f"  blur: {BLUR}\n  prefocus: 0.3s\n  post: 0.1s\n", exposure=f"{EXPOSURE}s")
    return made


def measured(stage: Stage, shot: Shot, later: float) -> list[float]:
    """Pan and tilt, so many s after a shutter, in deg."""
    places = np.array([place for each in stage.gimbals for place in each.places])
    return [float(np.interp(shot.time + later, places[:, 0], places[:, axis])) for axis in (1, 2)]


def assert_blurred(stage: Stage, shots: list[Shot] | None = None) -> None:
    """Each frame was exposed from half way after the one before it to half way before the next, in the middle at it."""
    positions = stage.timelapse.path.positions(FRAMES)
    for frame, shot in enumerate(stage.shots if shots is None else shots):
        for index, axis in enumerate((Axis.PAN, Axis.TILT)):
            here = positions[axis][frame]
            before, after = positions[axis][max(0, frame - 1)], positions[axis][min(frame + 1, FRAMES - 1)]
            spans = {0.0: here - (here - before) * BLUR, EXPOSURE / 2: here, EXPOSURE: here + (after - here) * BLUR}
            for later, place in spans.items():
                assert measured(stage, shot, later)[index] == pytest.approx(place, abs=NEAR), (frame, axis, later)


def gaps(stage: Stage) -> list[float]:
    return [after.time - before.time for before, after in pairwise(stage.shots)]


def test_each_exposure_is_moved_through_and_each_frame_is_in_its_slot(stage: Stage) -> None:
    assert stage.shoot().result is Result.DONE
    assert len(stage.shots) == FRAMES
    assert_blurred(stage)
    assert gaps(stage) == pytest.approx([INTERVAL] * (FRAMES - 1), abs=PERIOD)
    assert not any(stage.shooting.progress.troubles.values())
    shot = stage.shots[2]
    turned = np.array(stage.gimbals[0].turned)
    assert np.interp(shot.time - 1.1, turned[:, 0], turned[:, 1]) == pytest.approx(0, abs=0.05), "the ramp takes 1 s"
    assert np.interp(shot.time - 0.7, turned[:, 0], turned[:, 1]) > 1
    assert np.interp(shot.time + EXPOSURE + 1.1, turned[:, 0], turned[:, 1]) > 1, "and then it goes on"


@pytest.mark.parametrize("later", [2.9, 3.6, 4.5])
def test_a_stop_at_any_moment_loses_no_frame_and_the_next_is_run_up_to_again(stage: Stage, later: float) -> None:
    stage.keys = Keys()
    stopped, cleared = 1012.0 + later, 1060.0
    stage.keys.presses = [(stopped, STOP), (cleared, CLEAR), (cleared + 5, GO)]
    assert stage.shoot().result is Result.DONE
    assert len(stage.shots) == FRAMES
    assert not [shot for shot in stage.shots if stopped + 0.05 < shot.time < cleared + 5]
    moving = [time for time, rate in stage.gimbals[0].turned if rate > 0.05]
    assert not [time for time in moving if stopped + 1.5 < time < cleared + 5]
    halted = stage.shooting.progress.stopped
    exposing = [frame for frame, shot in enumerate(stage.shots) if shot.time < stopped < shot.time + EXPOSURE]
    assert halted == exposing
    for frame in range(FRAMES):
        if frame not in halted:
            middle = stage.timelapse.path.at(frame)[Axis.PAN]
            assert measured(stage, stage.shots[frame], EXPOSURE / 2)[0] == pytest.approx(middle, abs=NEAR)


def test_a_pause_rests_where_the_next_run_begins(stage: Stage) -> None:
    stage.keys = Keys()
    stage.keys.presses = [(1013.0, PAUSE), (1073.0, PAUSE)]
    assert stage.shoot().result is Result.DONE
    assert_blurred(stage)
    assert max(gaps(stage)) == pytest.approx(60, abs=INTERVAL)
    moving = [time for time, rate in stage.gimbals[0].turned if rate > 0.05]
    assert not [time for time in moving if 1013 + INTERVAL < time < 1073]
    assert stage.shooting.progress.missed == 0


@pytest.mark.parametrize("phase", ["prefocus", "expose", "move"])
def test_a_shoot_that_was_ended_goes_on_at_the_exact_frame(stage: Stage, phase: str) -> None:
    def watch(_tick: object) -> None:
        if stage.shooting.progress.frame >= 2 and stage.shooting.progress.phase == phase:
            stage.shooting.interrupt("SIGINT received")
            stage.watch = lambda _tick: None

    stage.watch = watch
    assert stage.shoot().result is Result.INTERRUPTED
    cut = len(stage.shots) - 1 if phase == "expose" else None  # the exposure in which the axes were stopped
    assert stage.shoot(resume=True).result is Result.DONE
    assert len(stage.shots) == FRAMES
    assert stage.said == []
    middles = {frame: measured(stage, shot, EXPOSURE / 2)[0] for frame, shot in enumerate(stage.shots)}
    for frame, pan in middles.items():
        if frame != cut:
            assert pan == pytest.approx(stage.timelapse.path.at(frame)[Axis.PAN], abs=NEAR)


def test_a_frame_whose_journal_is_late_is_run_through_again_an_interval_later(stage: Stage) -> None:
    with stage.journal() as journal:
        ended = stage.shoot(SlowBook(journal, stage, held={2: 1.5}))
    assert ended.result is Result.DONE
    assert_blurred(stage)
    assert gaps(stage) == pytest.approx([INTERVAL, 2 * INTERVAL, INTERVAL], abs=PERIOD)
    assert stage.shooting.progress.missed == 1
    assert len(stage.shots) == FRAMES


def test_a_frame_that_the_camera_refused_is_run_through_again(stage: Stage) -> None:
    stage.write(FRAMES, f"{INTERVAL}s", f"  blur: {BLUR}\n  on_camera_fault: continue\n", exposure=f"{EXPOSURE}s")
    stage.prepare = lambda gimbal: setattr(gimbal, "camera_says", lambda count: 2 if count == 2 else 0)
    assert stage.shoot().result is Result.DONE
    assert_blurred(stage)
    assert len(stage.shots) == FRAMES
    assert stage.shooting.progress.refused == 1

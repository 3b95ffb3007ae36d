"""A shoot as the command runs it: the journal's name, what is refused before it is begun, and the report."""

from __future__ import annotations

from pathlib import Path

import pytest
from shoot_bench import Stage
from silent_screen import SilentScreen, no_signals

from teleop.app.shoot import ShootReport, ShootRun
from teleop.core.clock import VirtualClock
from teleop.core.errors import TeleopError, UsageError
from teleop.core.run_state import Result
from teleop.recording.reader import read_take
from teleop.timelapse.journal import FrameState


@pytest.fixture
def stage(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Stage:
    monkeypatch.chdir(tmp_path)
    made = Stage(tmp_path, monkeypatch)
    made.write(3, "2s")
    return made


def shoot(stage: Stage, screen: SilentScreen, begun: list[Path], **options) -> ShootReport:
    run = ShootRun("dusk.yaml", stage.timelapse, stage.profile, VirtualClock(), None, virtual=True, **options)
    return run.perform(lambda _shooting, _path, _recorder: screen, no_signals, begun.append, screen.notify)


def test_every_frame_is_shot_and_journaled_beside_the_command(stage: Stage, tmp_path: Path):
    screen, begun = SilentScreen(), []
    report = shoot(stage, screen, begun, take=tmp_path / "a.mcap")
    assert report.ended.result is Result.DONE
    assert len(stage.shots) == 3
    assert begun == [Path("dusk.journal")]
    assert (tmp_path / "dusk.journal").is_file()
    assert (screen.entered, screen.left) == (1, 1)
    ending = read_take(tmp_path / "a.mcap").ending
    assert ending is not None
    assert ending.result == "done"


def test_the_journal_of_a_shoot_that_was_cut_off_is_kept_until_a_user_decides(stage: Stage):
    with stage.journal() as journal:
        journal.note(0, FrameState.DONE)
    with pytest.raises(UsageError, match=r"stopped at frame 1 of 3: continue with --resume"):
        shoot(stage, SilentScreen(), [])
    assert stage.shots == []
    assert shoot(stage, SilentScreen(), [], resume=True).ended.result is Result.DONE
    assert len(stage.shots) == 2


def test_a_rig_without_a_camera_is_refused_before_a_journal_is_begun(stage: Stage, tmp_path: Path):
    sinks = [each for each in stage.profile.sinks if each.type != "camera"]
    stage.profile = stage.profile.model_copy(update={"sinks": sinks})
    with pytest.raises(TeleopError, match="has no camera to shoot with"):
        shoot(stage, SilentScreen(), [])
    assert not (tmp_path / "dusk.journal").exists()

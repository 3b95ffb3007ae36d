"""Single frames by the keys, as the gimbal and its camera see them, on virtual time."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from shoot_bench import Keys, Stage

from teleop.core.axes import Axis
from teleop.core.operator_input import Command as Key
from teleop.core.operator_input import Press
from teleop.core.run_state import Result
from teleop.timelapse.journal import FrameState

NEXT, BACK, SHOOT, QUIT = (Press(key) for key in (Key.NEXT, Key.PREVIOUS, Key.GO, Key.QUIT))
STOP, CLEAR = Press(Key.STOP), Press(Key.CLEAR)


@pytest.fixture
def stage(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Stage:
    made = Stage(tmp_path, monkeypatch)
    made.write(3, "1s", by_hand=True)
    return made


def by_hand(stage: Stage, *presses: tuple[float, Press], **how: bool) -> tuple[Result, list[int]]:
    """Keys at times in s after the start; how it ended and the frames at whose places a picture was taken."""
    stage.keys, before = Keys(), len(stage.shots)
    begin = stage.clock.now()
    stage.keys.presses = [(begin + time, press) for time, press in presses]
    ended = stage.shoot(by_hand=True, **how)
    places = range(stage.timelapse.frames)
    shots = stage.shots[before:]
    assert all(min(stage.off(shot, frame) for frame in places) < 0.06 for shot in shots)
    return ended.result, [min(places, key=lambda frame: stage.off(shot, frame)) for shot in shots]


def test_enter_shoots_the_present_frame_and_goes_on_to_the_next(stage: Stage) -> None:
    ended = by_hand(stage, (5, SHOOT), (10, SHOOT), (30, SHOOT), (40, QUIT))
    assert ended == (Result.DONE, [0, 1, 2])
    assert all(shot.rate < 0.05 for shot in stage.shots)
    with pytest.raises(Exception, match="is finished"):
        stage.shoot(by_hand=True, resume=True)


def test_nothing_is_shot_and_nothing_moves_until_a_key_is_pressed(stage: Stage) -> None:
    assert by_hand(stage, (60, QUIT)) == (Result.INTERRUPTED, [])
    assert not [time for time, rate in stage.gimbals[0].turned if rate > 0.05 and time > 1010]
    assert stage.gimbals[0].places[-1][1] == pytest.approx(stage.timelapse.path.at(0)[Axis.PAN], abs=0.06)


def test_frames_forward_and_back_and_a_frame_that_is_shot_again_replaces(stage: Stage) -> None:
    keys = [(5, NEXT), (8, SHOOT), (12, BACK), (12.1, BACK), (18, SHOOT), (24, SHOOT), (30, QUIT)]
    assert by_hand(stage, *keys) == (Result.INTERRUPTED, [1, 0, 1])
    assert stage.shooting.progress.shot == 2
    assert stage.shooting.progress.phase.startswith("frame 2 of 3, not shot")


def test_it_goes_on_at_the_first_frame_that_is_not_shot(stage: Stage) -> None:
    assert by_hand(stage, (5, SHOOT), (10, QUIT)) == (Result.INTERRUPTED, [0])
    assert by_hand(stage, (5, SHOOT), (10, SHOOT), (15, QUIT), resume=True) == (Result.DONE, [1, 2])


def test_a_stop_halts_the_way_and_enter_goes_there_again(stage: Stage) -> None:
    stopped = stage.clock.now() + 10.3
    keys = [(5, SHOOT), (10, SHOOT), (10.3, STOP), (15, SHOOT), (20, CLEAR), (21, SHOOT), (28, SHOOT), (35, QUIT)]
    ended, shots = by_hand(stage, *keys)
    assert (ended, shots) == (Result.DONE, [0, 1, 2])
    moving = [time for time, rate in stage.gimbals[0].turned if rate > 0.05]
    assert not [time for time in moving if stopped + 1.5 < time < stopped + 10]


def test_with_blur_each_exposure_is_moved_through(stage: Stage) -> None:
    stage.write(3, "1s", "  blur: 0.2\n", exposure="2s", by_hand=True)
    stage.keys = Keys()
    stage.keys.presses = [(stage.clock.now() + time, key) for time, key in ((5, SHOOT), (20, SHOOT), (35, SHOOT))]
    stage.keys.presses += [(stage.clock.now() + time, key) for time, key in ((50, STOP), (51, QUIT))]
    stage.shoot(by_hand=True)
    assert len(stage.shots) == 3
    places = np.array(stage.gimbals[0].places)
    pans = stage.timelapse.path.positions(3)[Axis.PAN]
    for frame, shot in enumerate(stage.shots):
        before, here, after = pans[max(0, frame - 1)], pans[frame], pans[min(2, frame + 1)]
        for later, place in ((0, here - (here - before) * 0.2), (1, here), (2, here + (after - here) * 0.2)):
            measured = np.interp(shot.time + later, places[:, 0], places[:, 1])
            assert measured == pytest.approx(place, abs=0.25), (frame, later)


def test_a_stop_in_a_run_up_keeps_the_earlier_picture_of_the_frame(stage: Stage) -> None:
    stage.write(3, "1s", "  blur: 0.2\n", exposure="2s", by_hand=True)
    stage.keys = Keys()
    keys = ((5, SHOOT), (20, BACK), (30, SHOOT), (30.5, STOP), (33, QUIT))
    stage.keys.presses = [(stage.clock.now() + time, key) for time, key in keys]
    with stage.journal() as journal:
        stage.shoot(journal, by_hand=True)
        assert journal.frames == {0: FrameState.DONE}
    assert len(stage.shots) == 1

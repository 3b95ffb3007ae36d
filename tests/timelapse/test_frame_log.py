"""What is written down of a frame, and what a camera that took no picture means for the shoot."""

from __future__ import annotations

import pytest
from timelapse_bench import Book

from teleop.core.errors import DeviceError, TeleopError
from teleop.core.events import ShutterResult
from teleop.timelapse.frame_log import MOST_FAILURES, FrameLog
from teleop.timelapse.journal import FrameState
from teleop.timelapse.progress import Progress
from teleop.timelapse.schedule import Schedule

DONE, REFUSED, SILENT = 0, 2, None


class Bench:
    def __init__(self, go_on: bool) -> None:
        self.book, self.progress = Book(), Progress(Schedule(1, 1, 100), None)
        self.log = FrameLog(self.book, self.progress, go_on)

    def shoot(self, frame: int, code: int | None) -> bool:
        self.log.begin(frame)
        result = ShutterResult(frame, code)
        self.log.on_result(result)
        return self.log.is_past(result)


def test_a_picture_is_written_down_before_and_after_it() -> None:
    bench = Bench(go_on=False)
    assert bench.shoot(4, DONE)
    assert bench.book.states(4) == [FrameState.BEGUN, FrameState.DONE]
    assert bench.progress.shot == 1


def test_a_refused_frame_is_due_again_and_one_without_an_answer_is_not() -> None:
    bench = Bench(go_on=True)
    assert not bench.shoot(4, REFUSED)
    assert bench.book.states(4) == [FrameState.BEGUN, FrameState.UNSHOT]
    assert bench.shoot(5, SILENT)
    assert bench.book.states(5) == [FrameState.BEGUN, FrameState.DOUBTFUL]
    assert (bench.progress.refused, bench.progress.doubtful, bench.progress.shot) == (1, [5], 0)


@pytest.mark.parametrize(
    ("code", "reason", "state"),
    [
        (REFUSED, "the camera refused to shoot frame 7 (return code 0x02)", FrameState.UNSHOT),
        (SILENT, "frame 7 may be missing: the camera did not answer", FrameState.BEGUN),
    ],
)
def test_a_camera_that_takes_no_picture_ends_the_shoot_by_default(
    code: int | None, reason: str, state: FrameState
) -> None:
    bench = Bench(go_on=False)
    with pytest.raises(DeviceError) as raised:
        bench.shoot(7, code)
    assert str(raised.value) == reason
    assert bench.book.states(7)[-1] is state


def test_too_many_failures_in_a_row_end_any_shoot_and_a_picture_starts_the_count_again() -> None:
    bench = Bench(go_on=True)
    for _ in range(2):
        for frame in range(MOST_FAILURES - 1):
            bench.shoot(frame, REFUSED)
        bench.shoot(50, DONE)
    for frame in range(MOST_FAILURES - 1):
        bench.shoot(frame, REFUSED)
    with pytest.raises(DeviceError):
        bench.shoot(60, REFUSED)


def test_nothing_is_begun_that_cannot_be_written_down() -> None:
    bench = Bench(go_on=True)
    bench.book.trouble = "dusk.journal cannot be written: disk full"
    with pytest.raises(TeleopError, match=r"disk full; frame 3 was not shot$"):
        bench.log.begin(3)
    assert bench.book.notes == []
    with pytest.raises(TeleopError, match="the last frame is done all the same"):
        bench.log.check_end()

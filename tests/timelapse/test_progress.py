"""How far a shoot is, and what went wrong in it, counted."""

from __future__ import annotations

from teleop.timelapse.progress import Progress
from teleop.timelapse.schedule import Schedule

SCHEDULE = Schedule(5.0, 5.0, 10)


def test_what_is_left_counts_down_to_the_last_frame() -> None:
    progress = Progress(SCHEDULE, 24.0, frame=3, due=100.0)
    assert progress.left(98.0) == 2.0 + 6 * 5.0
    assert progress.left(101.0) == 6 * 5.0, "late, and not negative"
    progress.frame, progress.due = 9, 130.0
    assert progress.left(130.0) == 0.0


def test_the_clip_is_as_long_as_the_frames_that_were_shot() -> None:
    assert Progress(SCHEDULE, 24.0, shot=12).clip == 0.5
    assert Progress(SCHEDULE, None, shot=12).clip is None


def test_a_shoot_without_trouble_counts_only_zeros() -> None:
    assert set(Progress(SCHEDULE, None, shot=10).troubles.values()) == {0}
    troubled = Progress(SCHEDULE, None, missed=1, lost=[2], doubtful=[3, 4], late=5, refused=6, unsettled=7)
    assert list(troubled.troubles.values()) == [1, 1, 2, 5, 6, 7]

"""What is written down of the frames of a shoot, and what a camera that took no picture means for it.

A frame that the camera refused is known not to be shot and is due again; one without an answer is in doubt, and
that run never presses it again. Whether either of them ends the shoot is the file's to say, up to a number in a row.
"""

from __future__ import annotations

import math
from typing import Protocol

from teleop.core.errors import DeviceError, TeleopError
from teleop.core.events import ShutterResult
from teleop.core.timing import SAME_TIME
from teleop.timelapse.journal import FrameState, Note
from teleop.timelapse.progress import Progress

RETRY = 1.0  # s after which a journal that could not be written is tried again
MOST_FAILURES = 10  # frames in a row without a picture, after which to continue is pointless


class FrameBook(Protocol):
    """Where frames are written down; `teleop.timelapse.journal.Journal`, or a fake of it."""

    trouble: str

    def note(self, frame: int | None, state: FrameState) -> Note: ...

    def finish(self) -> Note: ...


class FrameLog:
    """The book of a shoot, kept together with its `progress`. `go_on` is whether a camera's failure is only counted."""

    def __init__(self, book: FrameBook, progress: Progress, go_on: bool) -> None:
        self._book, self._progress, self._go_on = book, progress, go_on
        self._in_a_row = 0  # frames without a picture
        self._end: Note | None = None
        self._end_asked = -math.inf  # s: when it was last to be written

    def begin(self, frame: int) -> Note:
        """Its shutter is due. Raises TeleopError as `check` does."""
        self.check(frame)
        return self._book.note(frame, FrameState.BEGUN)

    def unshot(self, frame: int) -> None:
        """Begun, and its shutter was not pressed."""
        self._book.note(frame, FrameState.UNSHOT)

    def lost(self, frame: int) -> None:
        """Its place has been passed without a picture."""
        self._progress.lost.append(frame)
        self._book.note(frame, FrameState.MISSED)

    def on_result(self, result: ShutterResult) -> None:
        """Take the camera's answer; a picture is written down at once."""
        if result.code == 0:
            self._book.note(result.frame, FrameState.DONE)

    def is_past(self, result: ShutterResult) -> bool:
        """Whether the shoot is past that frame. Raises DeviceError where what the camera did is to end it."""
        if result.code == 0:
            self._progress.shot += 1
            self._in_a_row = 0
            return True
        self._in_a_row += 1
        if result.code is None:
            reason = f"frame {result.frame} may be missing: the camera did not answer"
        else:
            reason = f"the camera refused to shoot frame {result.frame} (return code {result.code:#04x})"
            self._progress.refused += 1
            self.unshot(result.frame)
        if not self._go_on or self._in_a_row >= MOST_FAILURES:
            raise DeviceError(reason)
        if result.code is None:
            self._progress.doubtful.append(result.frame)
            self._book.note(result.frame, FrameState.DOUBTFUL)
        return result.code is None

    def check(self, frame: int) -> None:
        """Raises TeleopError when nothing can be written down any more; `frame` is the one that waits for it."""
        if self._book.trouble:
            raise TeleopError(f"{self._book.trouble}; frame {frame} was not shot")

    def finished(self, now: float) -> bool:
        """Whether it is written down that the last frame is behind: ask until it is; what fails is tried again.

        Raises TeleopError as `check_end` does.
        """
        if self._end is None or (self._end.failed and now >= self._end_asked + RETRY - SAME_TIME):
            self._end, self._end_asked = self._book.finish(), now
        self.check_end()
        return self._end.safe

    def check_end(self) -> None:
        """Raises TeleopError when the end could not be written down."""
        if self._book.trouble:
            raise TeleopError(f"{self._book.trouble}; the last frame is done all the same")

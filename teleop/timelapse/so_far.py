"""What the journal of a shoot says of its frames, before a run of it begins."""

from __future__ import annotations

from collections.abc import Callable
from typing import Literal

from teleop.timelapse.compile import Timelapse
from teleop.timelapse.journal import FrameState, Journal
from teleop.timelapse.progress import Progress

InDoubt = Literal["shoot", "skip"]


def so_far(timelapse: Timelapse, journal: Journal, by_hand: bool = False) -> Progress:
    """How far it is, frames of an earlier process included."""
    shot = sum(state is FrameState.DONE for state in journal.frames.values())
    progress = Progress(timelapse.slots, timelapse.fps, shot, frame=journal.next, by_hand=by_hand)
    progress.doubtful += [each for each, state in journal.frames.items() if state is FrameState.DOUBTFUL]
    progress.lost += [each for each, state in journal.frames.items() if state is FrameState.MISSED]
    return progress


def settle_doubt(journal: Journal, progress: Progress, in_doubt: InDoubt, notify: Callable[[str], object]) -> None:
    """A frame that was begun and not confirmed is shot again, or counts as shot; either way it is named."""
    frame = journal.in_doubt
    if frame is None:
        return
    line = f"frame {frame} may be missing: the shoot stopped at its shutter"
    if in_doubt == "skip":
        journal.note(frame, FrameState.DOUBTFUL)
        journal.catch_up()
        progress.doubtful.append(frame)
        notify(f"{line}; it counts as shot")
    else:
        notify(f"{line}; it is shot again, so the camera may have it twice")
    progress.frame = journal.next

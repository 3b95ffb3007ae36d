"""What did not go as it should in a shoot, in lines for people."""

from __future__ import annotations

from collections.abc import Sequence

from teleop.timelapse.progress import Progress

SHOWN = 20  # frames that are named in a line


def troubles(progress: Progress) -> list[str]:
    """A line for each kind, none where all went well."""
    lines = (
        (progress.missed, f"{progress.missed} slots were missed"),
        (progress.lost, f"No picture of frames {_numbers(progress.lost)}"),
        (progress.doubtful, f"Frames {_numbers(progress.doubtful)} may be missing: the camera did not confirm them"),
        (
            progress.stopped,
            f"Frames {_numbers(progress.stopped)} were exposing when a STOP halted the axes: check them",
        ),
        (progress.late, f"{progress.late} frames were late, by {progress.latest:.2f} s at most"),
        (progress.refused, f"The camera refused {progress.refused} times"),
        (progress.unsettled, f"{progress.unsettled} frames were shot before the axes were measured to be still"),
    )
    return [line for seen, line in lines if seen]


def _numbers(frames: Sequence[int]) -> str:
    shown = ", ".join(map(str, frames[:SHOWN]))
    return shown if len(frames) <= SHOWN else f"{shown} and {len(frames) - SHOWN} more"

"""What did not go as it should in a shoot, in lines for people."""

from __future__ import annotations

from collections.abc import Sequence

from teleop.timelapse.progress import Progress

SHOWN = 20  # frames that are named in a line


def troubles(progress: Progress) -> list[str]:
    """A line for each kind, none where all went well."""
    lines: list[str] = []
    if progress.missed:
        lines.append(f"{progress.missed} slots were missed")
    if progress.lost:
        lines.append(f"No picture of frames {_numbers(progress.lost)}")
    if progress.doubtful:
        lines.append(f"Frames {_numbers(progress.doubtful)} may be missing: the camera did not confirm them")
    if progress.stopped:
        lines.append(f"Frames {_numbers(progress.stopped)} were exposing when a STOP halted the axes: check them")
    if progress.late:
        lines.append(f"{progress.late} frames were late, by {progress.latest:.2f} s at most")
    if progress.refused:
        lines.append(f"The camera refused {progress.refused} times")
    if progress.unsettled:
        lines.append(f"{progress.unsettled} frames were shot before the axes were measured to be still")
    return lines


def _numbers(frames: Sequence[int]) -> str:
    shown = ", ".join(map(str, frames[:SHOWN]))
    return shown if len(frames) <= SHOWN else f"{shown} and {len(frames) - SHOWN} more"

"""What an operator sees of a shoot: the axes, the frames, what went wrong; where there is no terminal a line at times.

It goes to stderr: stdout is for the result.
"""

from __future__ import annotations

import math
import shutil
from collections.abc import Callable, Mapping
from pathlib import Path

from rich.text import Text

from teleop.cli.screens.picture import Sheet
from teleop.cli.screens.run_rows import labelled
from teleop.cli.screens.run_view import RunView
from teleop.cli.shooting.timelapse_summary import clock
from teleop.core.axes import Axis, Limits
from teleop.core.events import Tick
from teleop.core.run_status import Hint, RunStatus
from teleop.timelapse.progress import Progress

EVERY = 60.0  # s between two lines, at most, while frames are shot
ENDS = Hint("Ctrl-C", "end; continue with --resume")
HINTS = (Hint("space", "STOP"), Hint("p", "pause between frames"), Hint("q", "end"), ENDS)
RESUMES = (Hint("space", "STOP"), Hint("p", "continue"), Hint("q", "end"), ENDS)

BY_HAND = (Hint("Enter", "shoot"), Hint(". ,", "next, previous frame"), Hint("space", "STOP"), Hint("q", "end"))


class ShootView(RunView):
    """A sink that only shows. `folder` is where the journal is written, `progress` how far the shoot is.

    `also` adds what holds it, a STOP or a pause, to what is shown.
    """

    def __init__(
        self,
        title: str,
        limits: Mapping[Axis, Limits],
        folder: Path,
        progress: Progress,
        silent: bool,
        keys: bool,
        take: Callable[[], str] = lambda: "",
        also: Callable[[RunStatus], RunStatus] = lambda status: status,
        sheet: Sheet | None = None,
    ) -> None:
        def status(now: float) -> RunStatus:
            return also(shoot_status(progress, now, keys))

        super().__init__(title, limits, status, silent, take, "teleop shoot", sheet=sheet)
        self._folder, self._progress = folder, progress
        self._reached = -math.inf, -1  # when the last line was written, and at how many hundredths

    def _say_lines(self, tick: Tick, status: RunStatus) -> None:
        shown, hundredth = self._reached
        reached = 100 * self._progress.shot // self._progress.slots.frames
        if tick.time - shown >= EVERY or reached != hundredth:
            self._reached = tick.time, reached
            self._lines.notify(
                "  ".join([*_parts(self._progress, tick.time), f"{free(self._folder) / 1e9:.1f} GB free"])
            )
        self._next_line = math.inf  # its own lines are enough
        super()._say_lines(tick, status)

    def _state(self, tick: Tick, status: RunStatus, width: int) -> list[Text]:
        rows = super()._state(tick, status, width)[:2]
        rows.append(labelled("clip", Text("  ".join(_counted(self._progress)))))
        return [*rows, labelled("disk", Text(f"{free(self._folder) / 1e9:.1f} GB free"))]


def shoot_status(progress: Progress, now: float, keys: bool) -> RunStatus:
    """A shoot as its view shows it at a time of the loop's."""
    known = math.isfinite(progress.due) and math.isfinite(now)
    return RunStatus(
        phase=_doing(progress, now),
        elapsed=0.0,
        left=progress.left(now) if known else None,
        paused=progress.phase == "paused",
        total=f"{progress.shot} of {progress.slots.frames} frames",
        done=progress.shot / progress.slots.frames,
        hints=_hints(progress) if keys else (ENDS,),
    )


def _hints(progress: Progress) -> tuple[Hint, ...]:
    if progress.by_hand:
        return BY_HAND
    return RESUMES if progress.pausing else HINTS


def _parts(progress: Progress, now: float) -> list[str]:
    """Frames shot, time left, clip so far, what went wrong."""
    parts = [f"{progress.shot} of {progress.slots.frames} frames"]
    if math.isfinite(progress.due) and math.isfinite(now):
        parts.append(f"{clock(progress.left(now))} left")
    return [*parts, *_counted(progress)]


def _counted(progress: Progress) -> list[str]:
    """The clip so far, and what went wrong."""
    clip, always = [], "" if progress.by_hand else "missed slots"
    if progress.clip is not None and progress.fps:
        clip.append(f"clip {progress.clip:.2f} of {progress.slots.frames / progress.fps:.2f} s")
    return [*clip, *(f"{n} {name}" for name, n in progress.troubles.items() if n or name == always)]


def _doing(progress: Progress, now: float) -> str:
    phase = "pausing after this frame" if progress.pausing and progress.phase != "paused" else progress.phase
    soon = progress.due - now
    wait = f", frame {progress.frame} in {clock(soon)}" if phase in ("wait", "approach") and 0 < soon < math.inf else ""
    return f"{phase}: {progress.problem}" if progress.problem else f"{phase}{wait}"


def free(folder: Path) -> int:
    """Bytes that are free where the journal is written; 0 where that cannot be known any more."""
    try:
        return shutil.disk_usage(folder).free
    except OSError:  # the folder is gone: the journal says so, a view does not end a shoot
        return 0

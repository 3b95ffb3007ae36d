"""What an operator sees of a shoot: a bar and the next frame on a terminal, a line now and then elsewhere.

It goes to stderr: stdout is for the result.
"""

from __future__ import annotations

import math
import shutil
from pathlib import Path

from rich.console import Group, RenderableType
from rich.progress_bar import ProgressBar
from rich.table import Table
from rich.text import Text

from teleop.cli.screen import Screen
from teleop.cli.timelapse_words import clock
from teleop.motion import Tick
from teleop.sources.progress import Progress

REDRAWS = 4  # a second
EVERY = 60.0  # s between two lines, at most, while frames are shot
STOP = "Ctrl-C stop, --resume goes on"


class ShootView(Screen):
    """A sink that only shows. `folder` is where the journal is written, `progress` how far the shoot is."""

    def __init__(self, title: str, folder: Path, progress: Progress, silent: bool, keys: bool) -> None:
        super().__init__(title, silent, REDRAWS)
        self._folder, self._progress, self._keys = folder, progress, keys
        self._now = -math.inf
        self._said = -math.inf, -1  # when the last line was written, and at how many hundredths

    def write(self, tick: Tick) -> None:
        self._now = tick.time
        if self._in_lines:
            self._line(tick.time, self._progress)

    def _line(self, now: float, progress: Progress) -> None:
        last, hundredth = self._said
        reached = 100 * progress.shot // progress.slots.frames
        if now - last >= EVERY or reached != hundredth:
            self._said = now, reached
            self._lines.say("  ".join(_parts(progress, now, self._folder)))

    def _draw(self) -> RenderableType:
        progress = self._progress
        grid = Table.grid(padding=(0, 2))
        bar = ProgressBar(total=progress.slots.frames, completed=progress.shot, width=30)
        grid.add_row(self._title, bar, *_parts(progress, self._now, self._folder))
        space = f"space {'go on' if progress.pausing else 'pause between frames'}  " if self._keys else ""
        return Group(grid, Text(f"{_doing(progress, self._now)}  {space}{STOP}", style="dim"))


def _parts(progress: Progress, now: float, folder: Path) -> list[str]:
    """Frames shot, time left, clip so far, what went wrong, room on the disk."""
    parts = [f"{progress.shot} of {progress.slots.frames} frames"]
    if math.isfinite(progress.due) and math.isfinite(now):
        parts.append(f"{clock(progress.left(now))} left")
    if progress.clip is not None and progress.fps:
        parts.append(f"clip {progress.clip:.2f} of {progress.slots.frames / progress.fps:.2f} s")
    parts += [f"{count} {name}" for name, count in progress.troubles.items() if count or name == "missed slots"]
    return [*parts, f"{free(folder) / 1e9:.1f} GB free"]


def _doing(progress: Progress, now: float) -> str:
    phase = "pausing after this frame" if progress.pausing and progress.phase != "paused" else progress.phase
    soon = progress.due - now
    wait = f", frame {progress.frame} in {clock(soon)}" if phase in ("wait", "approach") and 0 < soon < math.inf else ""
    return f"{phase}{wait}"


def free(folder: Path) -> int:
    """Bytes that are free where the journal is written."""
    return shutil.disk_usage(folder).free

"""What an operator sees of a run: a bar, the time and each axis; where there is no terminal a line each second.

It goes to stderr: stdout is for the result.
"""

from __future__ import annotations

import math
from collections.abc import Callable

from rich.console import Console, Group, RenderableType
from rich.progress_bar import ProgressBar
from rich.table import Table
from rich.text import Text

from teleop.cli.screen import Screen
from teleop.motion import Axis, Tick
from teleop.sinks.tally import Tally

UNITS = {Axis.PAN: "deg", Axis.TILT: "deg", Axis.ROLL: "deg"}  # the others have none
REDRAWS = 10  # a second


class Display(Screen):
    """A sink that only shows. `begin` is when the run's own time is zero, `duration` its length in s, inf for none.

    `elapsed` is the run's own time at a time of the loop's, where it may go faster or slower, and `said` is what it is
    doing then, in place of that time; `note` is a line below.
    """

    def __init__(
        self,
        title: str,
        begin: Callable[[], float],
        duration: float,
        silent: bool = False,
        elapsed: Callable[[float], float] | None = None,
        note: Callable[[], str] | None = None,
        said: Callable[[float], str] | None = None,
    ) -> None:
        super().__init__(title, silent, REDRAWS)
        self._duration, self._note = duration, note
        self._doing = said
        self._elapsed = lambda now: elapsed(now) if elapsed and now >= begin() else now - begin()
        self._latest: Tick | None = None
        self._said = -math.inf

    def write(self, tick: Tick) -> None:
        self._latest = tick
        if self._in_lines and tick.time - self._said >= 1:
            self._said = tick.time
            self._lines.say("  ".join([self._time(tick), *(_angle(tick, axis) for axis in tick.motion)]))

    def _time(self, tick: Tick) -> str:
        if self._doing:
            return self._doing(tick.time)
        elapsed = self._elapsed(tick.time)
        if elapsed < 0:
            return f"to the start {-elapsed:4.1f} s"
        if math.isinf(self._duration):
            return f"{elapsed:6.1f} s"
        return f"{min(elapsed, self._duration):6.1f} / {self._duration:.1f} s"

    def _draw(self) -> RenderableType:
        tick = self._latest
        grid = Table.grid(padding=(0, 2))
        if tick is None:
            grid.add_row(self._title, "waiting for the first report")
            return grid
        row: list[RenderableType] = [self._title]
        if math.isfinite(self._duration):
            elapsed = min(max(self._elapsed(tick.time), 0.0), self._duration)
            row.append(ProgressBar(total=max(self._duration, 1e-9), completed=elapsed, width=30))
        grid.add_row(*row, self._time(tick), *(_angle(tick, axis) for axis in tick.motion))
        return Group(grid, Text(self._note(), style="dim")) if self._note else grid


def _angle(tick: Tick, axis: Axis) -> str:
    position = round(tick.motion[axis].position, 3) + 0.0  # no -0.00
    return f"{axis} {position:+8.2f}" if axis in UNITS else f"{axis} {position:.3f}"


def error_table(tally: Tally) -> None:
    """Commanded against measured, a row an axis, on stdout."""
    table = Table(title="Commanded against measured")
    for heading in ("Axis", "Commanded", "Measured", "RMS error", "Peak error", "Unit"):
        table.add_column(heading, justify="left" if heading in ("Axis", "Unit") else "right")
    for axis, score in tally.scores.items():
        commanded, measured = tally.ends(axis)
        numbers = (commanded, measured, score.rms, score.peak)
        table.add_row(axis.value, *(f"{round(value, 3) + 0.0:.3f}" for value in numbers), UNITS.get(axis, "0..1"))
    Console().print(table)

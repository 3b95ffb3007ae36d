"""What an operator sees of a run that moves by itself: each axis, how far it is, what comes next, and the keys.

It goes to stderr: stdout is for the result. A view on a terminal; where there is none a line each second, and one at
once when the run stops or asks something.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

from rich.text import Text

from teleop.cli.screens.axis_table import axis_rows
from teleop.cli.screens.picture import Rows, Sheet
from teleop.cli.screens.run_rows import NO_KEYS, banner, hint_rows, note_rows, state_rows, title_row
from teleop.cli.screens.screen import Screen
from teleop.cli.screens.tables import print_table
from teleop.core.axes import Axis, Limits
from teleop.core.events import Action, Tick
from teleop.core.run_status import Hint, RunStatus, StopState, stop_state
from teleop.core.setpoints import Stop
from teleop.monitors.tracking_error import TrackingErrorMonitor

UPDATE = 0.08  # s between two looks at the run's status: the view is drawn ten times a second


class RunView(Screen):
    """A sink that only shows. `status` is what the run does at a time of the loop's, asked in the control thread.

    `take` is a few words about the take that is written, "" for none, `command` the name of what runs, and
    `hints` its keys where the status has none.
    """

    def __init__(
        self,
        title: str,
        limits: Mapping[Axis, Limits],
        status: Callable[[float], RunStatus],
        silent: bool = False,
        take: Callable[[], str] = lambda: "",
        command: str = "teleop play",
        hints: Sequence[Hint] = NO_KEYS,
        sheet: Sheet | None = None,
    ) -> None:
        super().__init__(title, silent, sheet)
        self._limits, self._status, self._take, self._command = limits, status, take, command
        self._hints = hints
        self._latest: tuple[Tick, RunStatus] | None = None
        self._recording: bool | None = None
        self._halted: StopState = ""  # while the whole run comes to rest
        self._shown = -math.inf
        self._next_line = -math.inf
        self._announced = ""
        self._hinted: Sequence[Hint] = ()

    def observe(self, tick: Tick) -> None:
        for act in tick.actions:
            if act in (Action.RECORD, Action.STOP):
                self._recording = act is Action.RECORD
        halts = bool(tick.demand) and all(isinstance(wish, Stop) for wish in tick.demand.values())
        moves = stop_state(halts, tick.motion)
        self._halted = moves if moves == "stopping" or (halts and self._halted) else ""
        if tick.time - self._shown >= UPDATE or tick.time >= self._next_line or self._halted == "stopping":
            self._shown = tick.time
            self._latest = tick, self._seen(self._status(tick.time))
            if self._in_lines:
                self._say_lines(*self._latest)

    def _seen(self, status: RunStatus) -> RunStatus:
        """With what the ticks say: the camera's lamp, and that the whole run comes to rest."""
        recording = self._recording if status.recording is None else status.recording
        if self._halted and not status.stop and not status.paused:
            note = status.note if status.note.startswith("STOPPED") else "STOPPED"
            return replace(status, recording=recording, stop=self._halted, note=note)
        return replace(status, recording=recording)

    def _say_lines(self, tick: Tick, status: RunStatus) -> None:
        shown = {"stopping": "stopping", "stopped": "STOPPED"}.get(status.stop, status.question)
        if shown and shown != self._announced:
            self._lines.notify(shown)
        self._announced = shown
        if status.hints != self._hinted and self._picture.console.is_terminal:  # one on which nothing is drawn
            self._lines.notify("keys: " + "   ".join(f"{key} {does}" for key, does in status.hints))
        self._hinted = status.hints
        if tick.time >= self._next_line:
            self._next_line = tick.time + 1
            self._lines.notify(self._line(tick, status))

    def _line(self, tick: Tick, status: RunStatus) -> str:
        return "  ".join([in_words(status), *(_angle(tick, axis) for axis in tick.motion)])

    def _draw(self, width: int, height: int) -> Rows:  # noqa: ARG002 - `fitted` sees to it
        if self._latest is None:
            waiting = Text(" waiting for the first report of every axis", "yellow")
            title = title_row(self._command, self._title, None, self._take(), width)
            return Rows(title, banner=waiting, notes=self._notes, bottom=hint_rows(self._hints, width))
        tick, status = self._latest
        return Rows(
            title=title_row(self._command, self._title, status.recording, self._take(), width),
            banner=banner(status, width),
            axes=axis_rows(tick, self._limits, width),
            state=[Text(), *self._state(tick, status, width), Text()],
            notes=[*note_rows(status), *self._notes],
            bottom=hint_rows(status.hints or self._hints, width),
        )

    def _state(self, tick: Tick, status: RunStatus, width: int) -> list[Text]:  # noqa: ARG002 - for those who need it
        return state_rows(status, width)


def in_words(status: RunStatus) -> str:
    """Where a run is, in a line: `  6.5 / 15.0 s`, or what it does before and after."""
    if status.elapsed is None or status.total:
        return status.phase
    whole = "" if math.isinf(status.duration) else f" / {status.duration:.1f}"
    words = f"{status.elapsed:6.1f}{whole} s"
    if status.passes > 1:
        words += f"  pass {status.number}{'' if math.isinf(status.passes) else f' of {status.passes:.0f}'}"
    return words if status.phase == "playing" else f"{words}  {status.phase}"


def _angle(tick: Tick, axis: Axis) -> str:
    position = round(tick.motion[axis].position, 3) + 0.0  # no -0.00
    return f"{axis} {position:+8.2f}" if axis.is_angle else f"{axis} {position:.3f}"


def timed(begin: Callable[[], float], duration: float, phase: str) -> Callable[[float], RunStatus]:
    """The status of a run that only has a length, in s, and a beginning on the loop's clock."""

    def status(now: float) -> RunStatus:
        elapsed = now - begin()
        if not math.isfinite(elapsed) or elapsed < 0:
            return RunStatus("starting", None, duration, duration if math.isfinite(duration) else None)
        done = min(elapsed, duration)
        return RunStatus(phase, done, duration, duration - done if math.isfinite(duration) else None)

    return status


def error_table(tracking: TrackingErrorMonitor) -> None:
    """Commanded against measured, a row an axis, on stdout."""
    headings = ("Axis", "Commanded", "Measured", "RMS error", "Peak error", "Unit")
    rows = []
    for axis, score in tracking.scores.items():
        numbers = (*tracking.ends(axis), score.rms, score.peak)
        rows.append([axis.value, *(f"{round(value, 3) + 0.0:.3f}" for value in numbers), axis.unit or "0..1"])
    print_table("Commanded against measured", headings, rows, words=("Axis", "Unit"), drop=("Unit", "RMS error"))

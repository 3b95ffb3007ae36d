"""The rows of a run that moves by itself, beside its axes: title, STOP, how far it is, what comes next, the keys."""

from __future__ import annotations

import math
from collections.abc import Sequence

from rich.cells import cell_len
from rich.text import Text

from teleop.cli.shooting.timelapse_summary import clock
from teleop.core.run_status import Hint, RunStatus, StopState
from teleop.manual.stop_guard import STOPPED, STOPPING

BAR = 30  # cells of the bar of how far it is, at most
LABEL = 9
PAUSED = "PAUSED. Press p to continue."
RUN_HINTS = (Hint("space", "STOP"), Hint("p", "pause"), Hint("q", "end"))
NO_KEYS = (Hint("Ctrl-C", "ends the run"),)


def title_row(command: str, title: str, recording: bool | None, take: str, width: int, more: str = "") -> Text:
    """What runs, the take that is written, the camera's lamp; the lamp stays where there is little room."""
    right = Text()
    if take:
        right.append(f"{take}  ", "bold red" if take.isupper() else "")
    right.append("● REC" if recording else "○ REC", "bold red" if recording else "dim")
    right.append(f"  {more} " if more else " ")
    left = Text.assemble((f" {command} ", "bold reverse"), f"  {title}")
    room = max(0, width - cell_len(right.plain))
    left.truncate(room, overflow="ellipsis")
    left.append(" " * max(0, room - cell_len(left.plain)))
    return left.append_text(right)


def stop_row(stop: StopState, then: str, width: int) -> Text:
    """A latched STOP, and `then` how to go on from it; empty while there is none."""
    if stop == "stopping":
        return Text(f" {STOPPING}".ljust(width), "bold white on red")
    return Text(f" {then}".ljust(width), "bold white on red") if stop else Text()


def banner(status: RunStatus, width: int) -> Text:
    """What holds the run, or asks for an answer. The note says how to go on where that is known."""
    first = status.note.partition("\n")[0]
    if status.stop:
        return stop_row(status.stop, first if first.startswith("STOPPED") else STOPPED, width)
    if status.question:
        return Text(f" {status.question}".ljust(width), "bold black on cyan")
    return Text(f" {first or PAUSED}".ljust(width), "black on yellow") if status.paused else Text()


def note_rows(status: RunStatus) -> list[Text]:
    """The note, without what the banner has of it."""
    lines = status.note.splitlines()
    return [Text(f" {line}") for line in (lines[1:] if status.stop or status.paused else lines)]


def state_rows(status: RunStatus, width: int) -> list[Text]:
    """The phase and how far it is, the next key and cue, the speed."""
    passes = "" if status.passes == 1 else f"  pass {status.number}{_of(status.passes)}"
    speed = f"{status.speed:.0%}{passes}"
    rows = [labelled("now", Text(status.phase)), labelled("time", _time(status, width - LABEL - 1))]
    if status.key or status.cue:
        rows.append(labelled("next", _next(status)))
    return [*rows, labelled("speed", Text(speed))]


def _of(passes: float) -> str:
    return "" if math.isinf(passes) else f" of {passes:.0f}"


def _time(status: RunStatus, width: int) -> Text:
    """In words, and as a bar where there is room for one."""
    words = time_words(status)
    share = _share(status)
    cells = min(BAR, width - cell_len(words) - 2)
    if share is None or cells < BAR // 3:
        return Text(words)
    full = round(share * cells)
    return Text.assemble(("━" * full, "green"), ("─" * (cells - full), "dim"), f"  {words}")


def _share(status: RunStatus) -> float | None:
    if status.done is not None:
        return min(max(status.done, 0.0), 1.0)
    if not 0 < status.duration < math.inf:
        return None
    return min(max((status.elapsed or 0.0) / status.duration, 0.0), 1.0)


def time_words(status: RunStatus) -> str:
    """`6.5 / 15.0 s, 8.5 s left`."""
    left = "" if status.left is None else f", {clock(max(0.0, status.left))} left"
    if status.total:
        return f"{status.total}{left}"
    elapsed = status.elapsed or 0.0
    return f"{elapsed:.1f} s{left}" if math.isinf(status.duration) else f"{elapsed:.1f} / {status.duration:.1f} s{left}"


def _next(status: RunStatus) -> Text:
    parts = []
    if status.key:
        parts.append(f"key {status.key.number} at {status.key.at:.1f} s")
    if status.cue:
        parts.append(f"cue {status.cue.what} at {status.cue.at:.1f} s")
    return Text(", ".join(parts))


def labelled(label: str, what: Text) -> Text:
    return Text.assemble((f" {label:{LABEL}}", "dim"), what)


def hint_rows(hints: Sequence[Hint], width: int, rows: int = 1) -> list[Text]:
    """The keys in as many rows as there are, none of them wrapped: what has no room is left out, from the end on."""
    written = [Text(" ")]
    for key, does in hints:
        before = 0 if len(written[-1]) <= 1 else 3
        if cell_len(written[-1].plain) + before + cell_len(f"{key} {does}") > width:
            if len(written) == rows:
                break
            written.append(Text(" "))
            before = 0
        written[-1].append(" " * before).append(key, "bold").append(f" {does}", "dim")
    return written

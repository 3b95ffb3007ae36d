"""The rows of the live screen, each made from values alone, so that they can be looked at without a terminal."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from rich.text import Text

from teleop.cli.screens.run_rows import hint_rows, labelled, stop_row
from teleop.cli.screens.run_rows import title_row as run_title
from teleop.core.axes import Motion
from teleop.core.run_status import Hint, stop_state
from teleop.inputs.keymaps import COARSE, FINE, HELP, JOG, MARKING, NO_EMERGENCY_STOP, SPELLING
from teleop.manual.status import InputStatus, Message, OperatorStatus

STOPPED = "STOPPED. Press c to clear, then center all sticks."
HINTS = (
    *(Hint("space", "STOP"), Hint("c", "clear"), Hint("?", "all keys"), Hint("q", "quit"), Hint("arrows", "jog")),
    *(Hint("- +", "speed"), Hint("0-9", "recall"), Hint("s 0-9", "store"), Hint("z", "recenter")),
    *(Hint("r", "record"), Hint(".", "shutter")),
)
STALE = 0.5  # s without a frame


class Traffic:
    """What passes on one link, from its counts at different times; `connection` has `counts`."""

    def __init__(self, connection: Any) -> None:
        self._connection = connection
        self._since, self._frames = math.nan, 0
        self._rate = 0.0
        self._heard, self._seen = math.nan, -1

    def row(self, name: str, now: float) -> Text:
        counts = self._connection.counts
        frames = counts.get("frames_in", 0)
        if frames != self._seen:
            self._heard, self._seen = now, frames
        if not now - self._since < 1:
            if now > self._since:
                self._rate = (frames - self._frames) / (now - self._since)
            self._since, self._frames = now, frames
        silent = now - self._heard > STALE
        row = Text.assemble(_dot("red" if silent else "green"), f"{name}  {self._rate:.0f} frames/s in")
        if silent:
            row.append(f", silent for {now - self._heard:.1f} s", "red")
        lost = counts.get("lost_replies", 0)
        row.append(f", {lost} unanswered", "yellow" if lost else "dim")
        return row


def title_row(title: str, elapsed: float, status: OperatorStatus, take: str, width: int) -> Text:
    """What runs, for how long, the camera's lamp, and the take that is written."""
    clock = f"{int(elapsed) // 60:02}:{int(elapsed) % 60:02}"
    return run_title("teleop live", title, status.recording, take, width, clock)


def banner(status: OperatorStatus, motion: Motion, now: float, width: int) -> Text:
    """What holds everything, or where everything is going."""
    if status.stopped:
        return stop_row(stop_state(True, motion), STOPPED, width)
    if not status.manual_control:
        return Text(" MANUAL CONTROL OFF. Press e to enable.".ljust(width), "black on yellow")
    if status.recall:
        left = max(0.0, status.recall_end - now)
        return Text(f" {status.recall} in {left:.1f} s; move a stick to cancel".ljust(width), "black on cyan")
    return Text()


def state_rows(status: OperatorStatus, links: Sequence[Text]) -> list[Text]:
    """Speed and jog step, inputs, camera, follow mode, links, presets."""
    jog = f"   jog {JOG:g} deg (shift {COARSE * JOG:g}, ctrl {FINE * JOG:g})"
    rows = [labelled("speed", _ranges(status).append(jog, "dim"))]
    rows += [labelled("inputs" if index == 0 else "", _input(each)) for index, each in enumerate(status.inputs)]
    camera = Text("● recording", "bold red") if status.recording else Text("○ not recording", "dim")
    rows.append(labelled("camera", camera.append("   follow ", "dim").append(status.follow or "not set")))
    rows += [labelled("link", link) for link in links]
    names = [f"{number} {name}".strip() for number, name in status.presets.items()]
    presets = Text("   ".join(names)) if names else Text("none: press s and a digit to store one", "dim")
    return [*rows, labelled("presets", presets)]


def _ranges(status: OperatorStatus) -> Text:
    row = Text()
    for index, share in enumerate(status.ranges):
        in_force = index == status.range
        row.append(f"[{share:.0%}]" if in_force else f" {share:.0%} ", "bold reverse" if in_force else "dim").append(
            " "
        )
    return row


def _input(status: InputStatus) -> Text:
    if status.trouble:
        return Text.assemble(_dot("red"), (status.trouble, "red"))
    if status.waits_for:
        return Text.assemble(_dot("yellow"), f"{status.name}  ", (status.waits_for, "yellow"))
    moves = f"moves {', '.join(status.moves)}" if status.moves else "ready"
    return Text.assemble(_dot("green"), f"{status.name}  ", (moves, "green" if status.moves else "dim"))


def _dot(colour: str) -> tuple[str, str]:
    return "● ", colour


def message_row(message: Message, now: float) -> Text:
    style = "bold red" if message.text.startswith("STOP by") else ""
    return Text.assemble((f" {max(0.0, now - message.time):4.0f} s ago  ", "dim"), (message.text, style))


def key_rows(question: str, keys: bool, width: int = 80, rows: int = 2) -> list[Text]:
    if not keys:
        return [Text(" no keyboard: press Ctrl-C to end the run", "dim")]
    if question:
        spelling = question.startswith((SPELLING, MARKING))
        return [Text(f" {question}", "bold cyan"), Text("" if spelling else " any other key cancels", "dim")]
    return hint_rows(HINTS, width, rows)


def help_rows() -> list[Text]:
    """Every key, two to a row, and what a STOP is not."""
    half = math.ceil(len(HELP) / 2)
    rows = []
    for left, right in zip(HELP[:half], [*HELP[half:], ("", "")], strict=False):
        cells = [(f" {left[0]:10}", "bold"), f"{left[1]:41}", (f"{right[0]:9}", "bold"), right[1]]
        rows.append(Text.assemble(*cells))
    return [*rows, Text(f" {NO_EMERGENCY_STOP}", "bold")]

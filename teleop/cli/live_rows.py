"""The rows of the live screen, each made from values alone, so that they can be looked at without a terminal."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

from rich.cells import cell_len
from rich.text import Text

from teleop.motion import STICKS, Axis, Limits, Tick
from teleop.sources.keys import HELP, SPELLING
from teleop.sources.status import Hand, Said, Status

STICK = 4  # cells of a stick's bar to either side
BESIDE = 56  # cells of an axis's row beside its bar
ANGLES = (Axis.PAN, Axis.TILT, Axis.ROLL)
AT_LIMIT = 1e-3  # share of the way between the soft limits
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


def title_row(title: str, elapsed: float, status: Status, trouble: str, width: int) -> Text:
    left = Text.assemble((" teleop live ", "bold reverse"), f"  {title}")
    right = Text()
    if trouble:
        right.append("TAKE FAILS  ", "bold red")
    if status.recording:
        right.append("● REC  ", "bold red")
    right.append(f"{int(elapsed) // 60:02}:{int(elapsed) % 60:02} ")
    left.append(" " * max(1, width - cell_len(left.plain) - cell_len(right.plain)))
    return left.append_text(right)


def banner(status: Status, now: float, width: int) -> Text:
    """What holds everything, or where everything is going."""
    if status.stopped:
        text = " E-STOP: nothing moves. c clears it, then let every stick go once."
        return Text(text.ljust(width), "bold white on red")
    if not status.hands_on:
        return Text(" HANDS OFF: e puts them on again.".ljust(width), "black on yellow")
    if status.recall:
        left = max(0.0, status.recall_end - now)
        return Text(f" {status.recall} in {left:.1f} s; a stick ends it".ljust(width), "black on cyan")
    return Text()


def axis_rows(tick: Tick, limits: Mapping[Axis, Limits], status: Status, width: int) -> list[Text]:
    names = max(6, *(len(axis) for axis in tick.motion))
    bar = max(8, width - BESIDE - names)
    heading = f" {'axis':{names}} {'':{bar + 12}}{'commanded':>10}{'measured':>10}{'error':>8}  stick"
    return [Text(heading, "dim"), *(_axis_row(tick, axis, limits[axis], status, names, bar) for axis in tick.motion)]


def _axis_row(tick: Tick, axis: Axis, limits: Limits, status: Status, names: int, bar: int) -> Text:
    state, reading = tick.motion[axis], tick.reported.get(axis)
    low, high = (-180.0, 180.0) if limits.continuous else (limits.minimum, limits.maximum)
    position = (state.position + 180) % 360 - 180 if limits.continuous else state.position
    share = (position - low) / (high - low)
    ends = ("", "") if limits.continuous else (f"{low:g}", f"{high:g}")
    at_low, at_high = (not limits.continuous and edge for edge in (share < AT_LIMIT, share > 1 - AT_LIMIT))
    places = 2 if axis in ANGLES else 3
    row = Text(f" {axis:{names}} ")
    row.append(f"{ends[0]:>5} ", "bold yellow" if at_low else "dim")
    row.append_text(_bar(share, bar, at_low or at_high, bool(state.velocity)))
    row.append(f" {ends[1]:5}", "bold yellow" if at_high else "dim")
    row.append(f"{_number(state.position, places):>10}", "bold")
    if reading is None or axis in STICKS:  # which nobody measures
        row.append(f"{'-':>10}{'-':>8}", "dim")
    else:
        row.append(f"{_number(reading.position, places):>10}{_number(state.position - reading.position, places):>8}")
    return row.append("  ").append_text(_stick(status.deflections.get(axis, 0.0)))


def _number(value: float, places: int) -> str:
    return f"{round(value, places) + 0.0:+.{places}f}"


def _bar(share: float, cells: int, at_limit: bool, moves: bool) -> Text:
    at = min(max(round(share * (cells - 1)), 0), cells - 1)
    mark = "bold yellow" if at_limit else "bold green" if moves else "bold"
    return Text.assemble(("─" * at, "dim"), ("●", mark), ("─" * (cells - 1 - at), "dim"))


def _stick(deflection: float) -> Text:
    cells = min(STICK, math.ceil(abs(deflection) * STICK))
    left, right = (cells, 0) if deflection < 0 else (0, cells)
    return Text.assemble(
        " " * (STICK - left), ("█" * left, "cyan"), ("│", "dim"), ("█" * right, "cyan"), " " * (STICK - right)
    )


def state_rows(status: Status, links: Sequence[Text]) -> list[Text]:
    """Speed, inputs, camera, links, presets."""
    rows = [_labelled("speed", _ranges(status))]
    rows += [_labelled("inputs" if index == 0 else "", _hand(hand)) for index, hand in enumerate(status.hands)]
    camera = Text("● recording", "bold red") if status.recording else Text("○ not told to record", "dim")
    rows.append(_labelled("camera", camera))
    rows += [_labelled("link", link) for link in links]
    names = [f"{number} {name}".strip() for number, name in status.presets.items()]
    presets = Text("   ".join(names)) if names else Text("none yet: s and a digit stores one", "dim")
    return [*rows, _labelled("presets", presets)]


def _labelled(label: str, what: Text) -> Text:
    return Text.assemble((f" {label:9}", "dim"), what)


def _ranges(status: Status) -> Text:
    row = Text()
    for index, share in enumerate(status.ranges):
        in_force = index == status.range
        row.append(f"[{share:.0%}]" if in_force else f" {share:.0%} ", "bold reverse" if in_force else "dim").append(
            " "
        )
    return row


def _hand(hand: Hand) -> Text:
    if hand.trouble:
        return Text.assemble(_dot("red"), (hand.trouble, "red"))
    if hand.waits_for:
        return Text.assemble(_dot("yellow"), f"{hand.name}  ", (hand.waits_for, "yellow"))
    moves = f"moves {', '.join(hand.moves)}" if hand.moves else "ready"
    return Text.assemble(_dot("green"), f"{hand.name}  ", (moves, "green" if hand.moves else "dim"))


def _dot(colour: str) -> tuple[str, str]:
    return "● ", colour


def said(message: Said, now: float) -> Text:
    style = "bold red" if message.text.startswith("E-STOP") else ""
    return Text.assemble((f" {max(0.0, now - message.time):4.0f} s ago  ", "dim"), (message.text, style))


def key_rows(question: str, keys: bool) -> list[Text]:
    if not keys:
        return [Text(" no keys here: Ctrl-C ends the run", "dim")]
    if question:
        spelling = question.startswith(SPELLING)
        return [Text(f" {question}", "bold cyan"), Text("" if spelling else " any other key takes it back", "dim")]
    row = Text(" ")
    for key, word in (("space", "STOP"), ("c", "clear"), ("arrows", "jog"), ("- +", "speed"), ("0-9", "recall")):
        row.append(key, "bold").append(f" {word}   ", "dim")
    second = Text(" ")
    for key, word in (("s 0-9", "store"), ("z", "recentre"), ("r", "record"), (".", "shutter"), ("?", "all keys")):
        second.append(key, "bold").append(f" {word}   ", "dim")
    return [row, second.append("q", "bold").append(" quit", "dim")]


def help_rows() -> list[Text]:
    """Every key, two to a row."""
    half = math.ceil(len(HELP) / 2)
    rows = []
    for left, right in zip(HELP[:half], [*HELP[half:], ("", "")], strict=False):
        cells = [(f" {left[0]:10}", "bold"), f"{left[1]:41}", (f"{right[0]:9}", "bold"), right[1]]
        rows.append(Text.assemble(*cells))
    return rows

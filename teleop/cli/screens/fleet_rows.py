"""The table of `teleop fleet`: a row for each rig, its state first."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from rich.box import SIMPLE_HEAD
from rich.console import Console, ConsoleOptions, RenderResult
from rich.table import Table
from rich.text import Text

from teleop.core.plain import plain
from teleop.studio.clocks import MOST_DOUBT
from teleop.studio.rig_state import RigState, battery

STYLES: Mapping[str, str] = {"lost": "bold red", "stopped": "bold red", "playing": "green", "ended": "dim"}
NOTHING = "–"
FOLDED = ("holder", "move", "error")  # columns that give way on a narrow terminal
HEAD = 2  # lines of a short table that are no rig: its head, and one for the cursor


class FleetView:
    """The table on a terminal. Where it has too few lines, each rig has one of them, what is wrong comes first, and the
    last line counts the rigs that are left out."""

    def __init__(self, rigs: Sequence[RigState], problems: Sequence[str] = ()) -> None:
        self._rigs, self._problems = rigs, problems

    def __rich_console__(self, console: Console, options: ConsoleOptions) -> RenderResult:
        whole, lines = fleet_table(self._rigs, self._problems), console.size.height
        if len(console.render_lines(whole, options)) < lines:
            yield whole
            return
        rigs = sorted(self._rigs, key=lambda rig: (rig.alive and not rig.error and not rig.stopped, rig.name))
        room = max(1, lines - HEAD - len(self._problems))
        left_out = len(rigs) - room
        more = [f"and {left_out} rigs more: make the terminal higher"] if left_out > 0 else []
        yield fleet_table(rigs[:room], [*more, *self._problems], short=True)


def fleet_table(rigs: Sequence[RigState], problems: Sequence[str] = (), short: bool = False) -> Table:
    """`problems` are why endpoints are not connected; `short` has one line for each rig."""
    below = Text("\n".join(map(plain, problems)), no_wrap=short, overflow="ellipsis") if problems else None
    table = Table(caption=below, caption_justify="left", box=None if short else SIMPLE_HEAD, padding=(0, 1, 0, 0))
    for title in ("rig", "state", "holder", "move", "error", "link", "battery", "clock"):
        right, fixed = title in ("link", "battery", "clock"), title not in FOLDED
        table.add_column(title, justify="right" if right else "left", no_wrap=fixed, overflow="fold")
    for rig in rigs:
        alive = rig.alive
        cells = [
            Text(plain(rig.name)),
            Text(rig.word, style=STYLES.get(rig.word, "")),
            Text(plain(str(rig.state.get("holder") or NOTHING)) if alive else NOTHING),
            Text(_move(rig.state.get("move")) if alive else NOTHING),
            Text(plain(rig.error) or NOTHING, style="red" if rig.error else ""),
            Text(_age(rig)),
            Text(NOTHING if (left := battery(rig.state)) is None else f"{left:.0f} %"),
            Text(_clock(rig), style="yellow" if _doubtful(rig) else ""),
        ]
        for cell in cells if short else ():
            cell.no_wrap, cell.overflow = True, "ellipsis"
        table.add_row(*cells)
    if not rigs:
        table.add_row(Text("no rig yet", style="dim"), *[""] * 7)
    return table


def _move(move: Any) -> str:
    if not isinstance(move, Mapping):
        return NOTHING
    at, duration = move.get("at"), move.get("duration")
    timed = f" {at:.1f}/{duration:.1f} s" if isinstance(at, int | float) and isinstance(duration, int | float) else ""
    return plain(f"{move.get('title')}{timed}")


def _age(rig: RigState) -> str:
    if rig.age is None:
        return NOTHING
    return f"{rig.age * 1000:.0f} ms" if rig.age < 1 else f"{rig.age:.0f} s"


def _clock(rig: RigState) -> str:
    offset = rig.offset
    if offset is None:
        return NOTHING
    return f"{round(offset.date * 1000, 1) + 0.0:+.1f} ±{offset.doubt * 1000:.1f} ms"


def _doubtful(rig: RigState) -> bool:
    return rig.offset is not None and rig.offset.doubt > MOST_DOUBT

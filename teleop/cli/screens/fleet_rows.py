"""The table of `teleop fleet`: a row for each rig, its state first."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from rich.table import Table
from rich.text import Text

from teleop.core.plain import plain
from teleop.studio.clocks import MOST_DOUBT
from teleop.studio.rig_state import RigState, battery

STYLES: Mapping[str, str] = {"lost": "bold red", "stopped": "bold red", "playing": "green", "ended": "dim"}
NOTHING = "–"


def fleet_table(rigs: Sequence[RigState], problems: Sequence[str] = ()) -> Table:
    """`problems` are why endpoints are not connected."""
    table = Table(expand=False, caption="\n".join(map(plain, problems)) or None, caption_justify="left")
    for title in ("rig", "state", "holder", "move", "error", "link", "battery", "clock"):
        table.add_column(title, justify="right" if title in ("link", "battery", "clock") else "left")
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
    return f"{offset.date * 1000:+.1f} ±{offset.doubt * 1000:.1f} ms"


def _doubtful(rig: RigState) -> bool:
    return rig.offset is not None and rig.offset.doubt > MOST_DOUBT

"""The table of axes that every view shares: a row an axis, with where it is commanded and measured to be, the error.

A narrow terminal loses columns, from the least important on, and never a row; a wide one does not stretch the bar
over the whole room, because an eye then loses its row.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import NamedTuple

from rich.text import Text

from teleop.core.axes import Axis, Limits
from teleop.core.events import Tick

AT_LIMIT = 1e-3  # share of the way between the soft limits
STICK = 4  # cells of a stick's bar to either side
SHORTEST, LONGEST = 8, 48  # cells of a bar
NUMBER = 10  # cells of a number's column
ERROR = 8
ENDS = 12  # cells of the soft limits at both ends of a bar
NAMES = 6  # cells, at least


class Columns(NamedTuple):
    """Which there are, and how many cells the names and the bar have; a bar of 0 cells is none."""

    names: int
    bar: int
    measured: bool
    error: bool
    stick: bool


def columns(tick: Tick, width: int, sticks: bool) -> Columns:
    """What fits: first the name and where it is commanded to be, last the bar."""
    names = max([NAMES, *(len(axis) for axis in tick.motion)])
    left = width - 2 - names - NUMBER
    if left < 0:
        return Columns(max(1, names + left), 0, False, False, False)
    measured = left >= NUMBER
    left -= NUMBER * measured
    error = measured and left >= ERROR
    left -= ERROR * error
    stick = sticks and error and left >= 3 + 2 * STICK
    left -= (3 + 2 * STICK) * stick
    bar = min(left - ENDS, LONGEST)
    return Columns(names, bar if error and bar >= SHORTEST else 0, measured, error, stick)


def axis_rows(
    tick: Tick, limits: Mapping[Axis, Limits], width: int, deflections: Mapping[Axis, float] | None = None
) -> list[Text]:
    """A heading and a row an axis; with `deflections` (-1..1) also what comes of the sticks."""
    shown = columns(tick, width, deflections is not None)
    heading = Text(f" {'axis':{shown.names}.{shown.names}} " + " " * (shown.bar + ENDS if shown.bar else 0), "dim")
    heading.append(f"{'commanded':>{NUMBER}}")
    heading.append(f"{'measured':>{NUMBER}}" if shown.measured else "")
    heading.append(f"{'error':>{ERROR}}" if shown.error else "")
    heading.append("  stick" if shown.stick else "")
    stick = deflections or {}
    return [heading, *(_row(tick, axis, limits.get(axis), stick.get(axis, 0.0), shown) for axis in tick.motion)]


def _row(tick: Tick, axis: Axis, limits: Limits | None, deflection: float, shown: Columns) -> Text:
    state, reading = tick.motion[axis], tick.reported.get(axis)
    row = Text(f" {axis:{shown.names}.{shown.names}} ")
    if shown.bar:
        row.append_text(_place(state.position, bool(state.velocity), limits, shown.bar))
    row.append(f"{number(axis, state.position):>{NUMBER}}", "bold")
    measured = reading is not None and not axis.is_stick  # a stick's place has no measure
    if shown.measured:
        row.append(f"{number(axis, reading.position) if reading and measured else '-':>{NUMBER}}")
    if shown.error:
        off = number(axis, state.position - reading.position) if reading and measured else "-"
        row.append(f"{off:>{ERROR}}")
    return row.append("  ").append_text(_stick(deflection)) if shown.stick else row


def number(axis: Axis, value: float) -> str:
    """Degrees with two decimals, everything else with three."""
    places = 2 if axis.is_angle else 3
    return f"{round(value, places) + 0.0:+.{places}f}"  # no -0.00


def _place(position: float, moves: bool, limits: Limits | None, cells: int) -> Text:
    """The bar between the soft limits, with where the axis is."""
    if limits is None:
        return Text(" " * (cells + ENDS))
    low, high = (-180.0, 180.0) if limits.continuous else (limits.minimum, limits.maximum)
    position = (position + 180) % 360 - 180 if limits.continuous else position
    share = (position - low) / (high - low) if high > low and math.isfinite(position) else 0.0
    ends = ("", "") if limits.continuous else (f"{low:g}", f"{high:g}")
    at_low, at_high = (not limits.continuous and edge for edge in (share < AT_LIMIT, share > 1 - AT_LIMIT))
    place = Text(f"{ends[0]:>5.5} ", "bold yellow" if at_low else "dim")
    place.append_text(_bar(share, cells, at_low or at_high, moves))
    return place.append(f" {ends[1]:5.5}", "bold yellow" if at_high else "dim")


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

"""The axes' table: columns go from the least important on, marks show limits, numbers have their places."""

from __future__ import annotations

import math

import pytest

from teleop.cli.screens.axis_table import LONGEST, SHORTEST, axis_rows, columns, number
from teleop.core.axes import Axis, Limits, Reading, State
from teleop.core.events import Tick

PAN, FOCUS, YAW = Axis.PAN, Axis.FOCUS, Axis.STICK_YAW
LIMITS = {PAN: Limits(-90, 90, 60, 120, 600)}


def tick(position: float = 0.0, velocity: float = 0.0, reading: float | None = None, axis: Axis = PAN) -> Tick:
    reported = {} if reading is None else {axis: Reading(reading, 0.0)}
    return Tick(0.0, {axis: State(position, velocity)}, {}, (), reported)


def test_columns_go_one_after_the_other_as_the_terminal_narrows():
    shown = [columns(tick(), width, sticks=True) for width in range(200, 4, -1)]
    counts = [(each.bar > 0) + each.stick + each.error + each.measured for each in shown]
    assert counts[0] == 4
    assert counts == sorted(counts, reverse=True)
    assert counts[-1] == 0
    assert {each.bar for each in shown} <= {0, *range(SHORTEST, LONGEST + 1)}


@pytest.mark.parametrize("width", [12, 24, 40, 60, 80, 200])
def test_no_row_is_wider_than_the_terminal(width: int):
    rows = axis_rows(tick(-12.0, 3.0, -12.5), LIMITS, width, {PAN: 0.5})
    assert len(rows) == 2
    assert max(row.cell_len for row in rows) <= max(width, 18)


def test_the_error_is_commanded_less_measured_and_a_dash_where_nothing_is_known():
    assert axis_rows(tick(10.0, 0.0, 9.5), LIMITS, 60)[1].plain.split()[-3:] == ["+10.00", "+9.50", "+0.50"]
    assert axis_rows(tick(10.0), LIMITS, 60)[1].plain.split()[-2:] == ["-", "-"]
    assert axis_rows(tick(0.5, 0.0, 0.4, YAW), {}, 60)[1].plain.split()[-2:] == ["-", "-"]


@pytest.mark.parametrize(("position", "at"), [(-90.0, 0.0), (0.0, 0.5), (90.0, 1.0), (500.0, 1.0), (math.nan, 0.0)])
def test_the_bar_has_its_mark_where_the_axis_is(position: float, at: float):
    row = axis_rows(tick(position), LIMITS, 100)[1].plain
    bar = "".join(cell for cell in row if cell in "─●")
    assert bar.index("●") / (len(bar) - 1) == pytest.approx(at, abs=0.03)


@pytest.mark.parametrize(
    ("axis", "value", "shown"),
    [(PAN, -0.001, "+0.00"), (PAN, 12.345678, "+12.35"), (FOCUS, 0.5, "+0.500"), (FOCUS, -0.0004, "+0.000")],
)
def test_degrees_have_two_places_all_else_three_and_nothing_is_minus_0(axis: Axis, value: float, shown: str):
    assert number(axis, value) == shown

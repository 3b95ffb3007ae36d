"""Tables on a terminal lose columns, never wrap; into a pipe they are whole."""

from __future__ import annotations

import pytest

from teleop.cli.screens.tables import _kept, print_table

HEADINGS, WIDTHS = ("Axis", "Velocity", "Jerk", "Room"), (5, 8, 5, 6)


@pytest.mark.parametrize(("room", "kept"), [(200, [0, 1, 2, 3]), (30, [0, 1, 2]), (24, [0, 1]), (5, [0, 1])])
def test_columns_go_in_their_order_until_the_rest_fits(room, kept):
    assert _kept(HEADINGS, WIDTHS, ("Room", "Jerk"), room) == kept


def test_a_pipe_gets_every_column(capsys, monkeypatch):
    monkeypatch.setenv("COLUMNS", "20")
    print_table("A title", HEADINGS, [["pan", "100", "5", "long" * 20]], words=("Axis",), drop=("Room",))
    printed = capsys.readouterr().out
    assert "long" * 20 in printed
    assert "left out" not in printed

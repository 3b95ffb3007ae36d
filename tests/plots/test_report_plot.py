"""The picture of a take."""

from __future__ import annotations

import io
from pathlib import Path

import pytest
from made_takes import write_take

from teleop.core.axes import Axis, State
from teleop.core.events import Action
from teleop.plots.style import COLORS
from teleop.recording.reader import Take, read_take

pytest.importorskip("matplotlib", reason="drawings are an extra")
from teleop.plots.report_plot import draw, figure


@pytest.fixture
def take(tmp_path: Path) -> Take:
    motion = {Axis.PAN: lambda time: State(2 * time, 2.0), Axis.FOCUS: lambda _time: State(0.5)}
    measured = {Axis.PAN: lambda time: 2 * time - 0.1}
    path = write_take(tmp_path / "t.mcap", motion, 1, measured=measured, acts={50: [Action.RECORD]})
    return read_take(path)


def test_a_panel_for_each_quantity_with_units_and_a_line_for_each_axis(take: Take) -> None:
    drawing = figure(take)
    labels = [panel.get_ylabel() for panel in drawing.axes]
    assert labels[:4] == ["position °", "error °", "velocity °/s", "acceleration °/s²"]
    colors = {line.get_color() for panel in drawing.axes for line in panel.get_lines()}
    assert {COLORS[Axis.PAN], COLORS[Axis.FOCUS]} <= colors


def test_actions_and_the_end_are_named(take: Take) -> None:
    texts = [text.get_text() for text in figure(take).axes[0].texts]
    assert "record" in texts
    assert "ended: done" in texts


def test_the_same_take_is_the_same_file(take: Take) -> None:
    first, second = io.BytesIO(), io.BytesIO()
    draw(take, first, "svg")
    draw(take, second, "svg")
    assert first.getvalue() == second.getvalue()

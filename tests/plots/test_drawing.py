"""What is in the drawing; that it becomes a file is tests/cli/test_preview.py's to show."""

from __future__ import annotations

import numpy as np
import pytest

from teleop.config.profile import load_profile
from teleop.core.axes import Axis, Limits
from teleop.planner.keyframes.planner import Key, plan
from teleop.plots.drawing import figure
from teleop.plots.style import COLORS
from teleop.sequence.compile import CompiledSequence, load_sequence

pytest.importorskip("matplotlib", reason="the plot extra is not installed")


def test_each_quantity_has_every_axis_and_the_cues_and_each_unit_a_scale() -> None:
    profile = load_profile("sim")
    drawing = figure(load_sequence("reveal", profile.limits, profile.name), profile)
    degrees, share = drawing.axes[:4], drawing.axes[4:]
    assert [panel.get_ylabel() for panel in degrees] == ["position °", "velocity °/s", "acceleration °/s²", "jerk °/s³"]
    assert [panel.get_ylabel() for panel in share] == ["position", "velocity 1/s", "acceleration 1/s²", "jerk 1/s³"]
    for panel in degrees:
        assert {COLORS[Axis.PAN], COLORS[Axis.TILT]} <= {line.get_color() for line in panel.lines}
    names = [text.get_text() for panel in drawing.axes for text in panel.texts]
    assert sorted(names) == sorted([*"1122334455", *"134", "record", "stop"])
    for panel in drawing.axes:
        low, high = panel.get_ylim()
        assert "position" in panel.get_ylabel() or low == -high  # 0 at the same height on both sides


def test_limits_are_dashed_where_the_move_comes_near_them() -> None:
    profile = load_profile("sim")
    limits: Limits = profile.limits[Axis.TILT]
    keys = {Axis.TILT: [Key(0, -50), Key(60, 0)]}
    drawing = figure(CompiledSequence("slow", plan(keys, {Axis.TILT: limits}), [], [], keys), profile)
    dashed = [[line for line in panel.lines if line.get_linestyle() == "--"] for panel in drawing.axes]
    assert [len(lines) for lines in dashed] == [1, 0, 0, 0]
    assert np.asarray(dashed[0][0].get_ydata()).tolist() == [limits.minimum] * 2

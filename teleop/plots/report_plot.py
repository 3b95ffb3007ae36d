"""A take as an SVG or PNG, in the preview's look: the page's plots, for a report that is printed or mailed."""

from __future__ import annotations

from typing import TYPE_CHECKING, BinaryIO

from teleop.core.axes import Axis
from teleop.planner.polynomial import Array
from teleop.plots.drawing import CUE, MARGIN, STYLE, TEXT
from teleop.plots.report_html import QUANTITIES, ROWS, curves, marks
from teleop.plots.style import COLORS, PER, UNIT_SIGNS
from teleop.recording.reader import Take

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

Curves = dict[Axis, tuple[Array, Array]]


def draw(take: Take, stream: BinaryIO, kind: str) -> None:
    """Write the drawing to `stream`, as `kind` "svg" or "png"; the take must have a tick."""
    from matplotlib import rc_context

    with rc_context(STYLE):
        undated = {"Date": None} if kind == "svg" else None
        figure(take).savefig(stream, format=kind, dpi=120, metadata=undated)


def figure(take: Take) -> Figure:
    """A panel for each quantity; what was measured is dotted, over what was commanded."""
    from matplotlib.figure import Figure

    drawing = Figure(figsize=(12, 9), layout="constrained")
    drawing.suptitle(f"{take.about.title}: {take.duration:.2f} s on {take.about.rig}; ended: {take.ended}", color=TEXT)
    panels = drawing.subplots(len(QUANTITIES), 1, sharex=True, height_ratios=(2, 1, 1, 1))
    lines = {axis: curves(take, axis) for axis in take.axes}
    for quantity, panel in zip(QUANTITIES, panels, strict=True):
        _panel(panel, quantity, lines)
        for time, name in marks(take):
            panel.axvline(time, color=CUE, linewidth=1)
            if quantity == "position":
                late = time > take.duration / 2
                spot, aside, across = (time, 0), (-4 if late else 4, 4), panel.get_xaxis_transform()
                side = "right" if late else "left"
                panel.annotate(name, spot, aside, across, "offset points", ha=side, color=CUE, fontsize=8)
    panels[-1].set_xlabel("s")
    end = take.duration or 1
    panels[-1].set_xlim(-MARGIN * end, (1 + MARGIN) * end)
    return drawing


def _panel(panel: Axes, quantity: str, lines: Curves) -> None:
    """One quantity of all axes, each unit on a scale of its own."""
    scales: dict[str, Axes] = {}
    for axis, (times, rows) in lines.items():
        unit = UNIT_SIGNS[axis.unit]
        if unit not in scales:
            scales[unit] = panel.twinx() if scales else panel
        name = axis.value.replace("_", " ")
        scales[unit].plot(times, rows[ROWS.index(quantity)], color=COLORS[axis], linewidth=1.5, label=name)
        if quantity == "position":
            scales[unit].plot(times, rows[ROWS.index("measured")], color=TEXT, linewidth=0.8, linestyle=":")
    for unit, scale in scales.items():
        measure = (unit or "1") + PER[quantity] if unit or PER[quantity] else ""
        scale.set_ylabel(f"{quantity} {measure}".strip())
    if quantity == "position":
        handles = [handle for scale in scales.values() for handle in scale.get_legend_handles_labels()[0]]
        place = {"loc": "lower left", "bbox_to_anchor": (0, 1), "ncols": len(handles), "frameon": False}
        panel.legend(handles=handles, **place)
    panel.grid(visible=True)

"""A performance as an SVG or PNG for a call sheet: the page's four plots, on paper that cannot be zoomed.

Needs the `plot` extra. matplotlib is asked for a bare Figure, not for pyplot, which would look for a screen.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, BinaryIO

from teleop.config.profile import Profile
from teleop.core.axes import Axis, Limits
from teleop.planner.polynomial import Array
from teleop.plots.downsample import QUANTITIES, Curve, curve
from teleop.plots.style import COLORS, PER, UNIT_SIGNS, mark
from teleop.sequence.compile import CompiledSequence, Cue

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

GROUND, CARD, GRID, TEXT, MUTED, CUE = "#0d0f12", "#171a1f", "#2a2e35", "#e9ecef", "#8b929c", "#ff5f56"
MARGIN = 0.02  # of the duration, beside the first and the last key
NEAR = 0.5  # of what an axis's own curve spans: a limit that close to it is drawn

STYLE: dict[Any, Any] = {  # matplotlib has a type of its own for the keys
    "axes.edgecolor": GRID,
    "axes.facecolor": CARD,
    "axes.labelcolor": MUTED,
    "figure.facecolor": GROUND,
    "font.size": 9,
    "grid.color": GRID,
    "svg.hashsalt": "teleop",  # the same move is the same file
    "text.color": TEXT,
    "xtick.color": MUTED,
    "ytick.color": MUTED,
}


def draw(performance: CompiledSequence, profile: Profile, stream: BinaryIO, kind: str) -> None:
    """Write the drawing to `stream`, as `kind` "svg" or "png"."""
    from matplotlib import rc_context

    with rc_context(STYLE):
        undated = {"Date": None, "Creator": "teleop preview"} if kind == "svg" else {"Software": "teleop preview"}
        figure(performance, profile).savefig(stream, format=kind, dpi=120, metadata=undated)


def figure(performance: CompiledSequence, profile: Profile) -> Figure:
    """A panel for each quantity, from position down to jerk."""
    from matplotlib.figure import Figure

    drawing = Figure(figsize=(12, 9), layout="constrained")
    drawing.suptitle(f"{performance.title}: {performance.duration:.2f} s on {profile.name}", color=TEXT)
    panels = drawing.subplots(len(QUANTITIES), 1, sharex=True, height_ratios=(2, 1, 1, 1))
    curves = {axis: curve(track, performance.duration) for axis, track in performance.move.tracks.items()}
    for row, panel in enumerate(panels):
        _panel(panel, row, performance, profile, curves)
    panels[-1].set_xlabel("s")
    end = performance.duration or 1
    panels[-1].set_xlim(-MARGIN * end, (1 + MARGIN) * end)
    place = {"loc": "lower left", "bbox_to_anchor": (0, 1), "ncols": len(curves), "frameon": False}
    panels[0].legend(handles=_legend(curves), **place)
    return drawing


def _panel(panel: Axes, row: int, performance: CompiledSequence, profile: Profile, curves: dict[Axis, Curve]) -> None:
    """One quantity of all axes, each unit on a scale of its own."""
    quantity = QUANTITIES[row]
    scales: dict[str, Any] = {}
    for number, (axis, (times, rows)) in enumerate(curves.items()):
        unit = UNIT_SIGNS[axis.unit]
        if unit not in scales:
            scales[unit] = panel.twinx() if scales else panel
        scale = scales[unit]
        scale.plot(times, rows[row], color=COLORS[axis], linewidth=1.5)
        if row == 0:
            _keys(scale, axis, performance, above=number % 2 == 0)
    for unit, scale in scales.items():
        measure = (unit or "1") + PER[quantity] if unit or PER[quantity] else ""
        scale.set_ylabel(f"{quantity} {measure}".strip())
        for axis, (_, rows) in curves.items():
            if UNIT_SIGNS[axis.unit] == unit:
                _limits(scale, axis, profile.limits[axis], quantity, rows[row])
        if row > 0 and len(scales) > 1:  # 0 at the same height in both
            reach = max(map(abs, scale.get_ylim()))
            scale.set_ylim(-reach, reach)
    for cue in performance.cues:
        panel.axvline(cue.at, color=CUE, linewidth=1)
        if row == 0:
            _cue_name(panel, cue, late=cue.at > 0.9 * performance.duration)
    panel.grid(visible=True)


def _cue_name(panel: Axes, cue: Cue, *, late: bool) -> None:
    """At the foot of the cue's line, on the side where there is room."""
    spot, aside = (cue.at, 0), (-4 if late else 4, 4)
    across = panel.get_xaxis_transform()
    panel.annotate(
        cue.name, spot, aside, across, "offset points", ha="right" if late else "left", color=CUE, fontsize=8
    )


def _keys(scale: Axes, axis: Axis, performance: CompiledSequence, *, above: bool) -> None:
    """Diamonds and their keyframes' names, of every other axis below, as axes often share a keyframe."""
    for key in performance.keys[axis]:
        held = [key.at, key.at + key.hold]
        scale.plot(held, [key.position] * 2, "D-", color=COLORS[axis], markersize=5, markevery=[0], linewidth=4)
        name = mark(key.where)
        spot = (key.at, key.position)
        aside = (0, 7 if above else -14)
        scale.annotate(name, spot, aside, textcoords="offset points", ha="center", color=COLORS[axis], fontsize=8)


def _limits(scale: Axes, axis: Axis, limits: Limits, quantity: str, values: Array) -> None:
    """Dashed lines where the axis's own curve comes near its limits; further ones would flatten it."""
    reach = getattr(limits, quantity, None)
    low, high = float(values.min()), float(values.max())
    near = NEAR * (high - low if reach is None else max(high, 0) - min(low, 0))
    for limit in (limits.minimum, limits.maximum) if reach is None else (-reach, reach):
        if near > 0 and low - near <= limit <= high + near:
            scale.axhline(limit, color=COLORS[axis], linewidth=1, linestyle="--")


def _legend(curves: dict[Axis, Curve]) -> list[Any]:
    from matplotlib.lines import Line2D

    return [Line2D([], [], color=COLORS[axis], label=axis.value.replace("_", " ")) for axis in curves]

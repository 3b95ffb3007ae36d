"""How axes answered a test move, measured against what the identified response explains: a page, or a drawing."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import BinaryIO, NamedTuple

import numpy as np

from teleop.core.axes import Axis
from teleop.core.response import Response
from teleop.planner.polynomial import Array
from teleop.plots.error_chart import chart
from teleop.plots.printed_page import printed_page
from teleop.plots.style import UNIT_SIGNS


class Trace(NamedTuple):
    """Readings (deg) of an axis at their times (s), and what its response explains of each."""

    axis: Axis
    response: Response
    times: Sequence[float]
    measured: Sequence[float]
    model: Sequence[float]

    def curves(self) -> tuple[Array, Array, Array]:
        """Times from 0, and both from their middle."""
        measured, model = np.array(self.measured), np.array(self.model)
        middle = (measured.max() + measured.min()) / 2
        return np.array(self.times) - self.times[0], measured - middle, model - middle

    def figures(self) -> str:
        """The response in words, each value with its doubt."""
        of = self.response
        drift = round(of.drift, 2) + 0.0  # no -0.0
        return (
            f"delay {of.delay:.3f} s ± {of.delay_doubt:.3f}, dead time {of.dead_time:.3f} s, lag {of.lag:.3f} s,"
            f" gain {of.gain:.3f} ± {of.gain_doubt:.3f}, drift {drift:.2f} deg/s ± {of.drift_doubt:.2f}"
        )


def page(title: str, traces: Sequence[Trace]) -> str:
    """The HTML text, without scripts."""
    return printed_page(title, "Calibration", title, _content(traces))


def _content(traces: Sequence[Trace]) -> Iterator[str]:
    for trace in traces:
        times, measured, model = trace.curves()
        unit = UNIT_SIGNS[trace.axis.unit]
        yield f"<h2>{trace.axis}</h2><p>{trace.figures()}</p>"
        yield '<p class="note">The measured angle (first color) and what the response explains of it (second).</p>'
        yield chart([(times, measured), (times, model)], [], unit)
        yield '<p class="note">What the response does not explain.</p>'
        yield chart([(times, measured - model)], [], unit)


def draw(title: str, traces: Sequence[Trace], stream: BinaryIO, kind: str) -> None:
    """Write the drawing to `stream`, as `kind` "svg" or "png"."""
    from matplotlib import rc_context
    from matplotlib.figure import Figure

    from teleop.plots.drawing import STYLE, TEXT
    from teleop.plots.style import COLORS

    with rc_context(STYLE):
        drawing = Figure(figsize=(12, 1 + 4 * len(traces)), layout="constrained")
        drawing.suptitle(title, color=TEXT)
        panels = drawing.subplots(2 * len(traces), 1, squeeze=False, height_ratios=(2, 1) * len(traces))[:, 0]
        for trace, above, below in zip(traces, panels[::2], panels[1::2], strict=True):
            times, measured, model = trace.curves()
            above.plot(times, measured, color=COLORS[trace.axis], linewidth=1.5, label="measured")
            above.plot(times, model, color=TEXT, linewidth=0.8, linestyle=":", label="explained")
            above.set_title(f"{trace.axis}: {trace.figures()}", fontsize=9)
            above.legend(frameon=False)
            below.plot(times, measured - model, color=COLORS[trace.axis], linewidth=1)
            for panel, name in ((above, "angle"), (below, "unexplained")):
                panel.set_ylabel(f"{name} {UNIT_SIGNS[trace.axis.unit]}")
                panel.grid(visible=True)
            below.set_xlabel("s")
        drawing.savefig(stream, format=kind, dpi=120, metadata={"Date": None} if kind == "svg" else None)

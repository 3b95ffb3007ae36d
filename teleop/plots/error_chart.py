"""The errors of several passes over the move's time, as an inline SVG that prints."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from teleop.planner.polynomial import Array
from teleop.plots.downsample import outline

WIDTH, HEIGHT = 960, 210
LEFT, RIGHT, TOP, BOTTOM = 56, 24, 8, 26
COLORS = ("#0b7285", "#d9480f", "#2b8a3e", "#862e9c", "#c2255c", "#5f3dc4", "#e67700", "#343a40")
MOST_POINTS = 1500
STEPS = (1, 2, 5, 10)
SAME = 0.06  # s: a key that near to either end is shown


def chart(curves: Sequence[tuple[Array, Array]], keys: Sequence[float], unit: str) -> str:
    """`curves` are times (n,) in s and errors (n,) in units, one for each pass; `keys` are times, drawn dashed."""
    curves = [curve for curve in curves if len(curve[0])]
    begin, end = min(float(times[0]) for times, _ in curves), max(float(times[-1]) for times, _ in curves)
    end = max(end, begin + 1e-3)
    reach = max(float(np.abs(errors).max()) for _, errors in curves) or 1e-3
    step = _step(reach / 2)
    reach = math.ceil(reach / step) * step

    def x(time: float) -> float:
        return LEFT + (time - begin) / (end - begin) * (WIDTH - LEFT - RIGHT)

    def y(error: float) -> float:
        return TOP + (1 - error / reach) / 2 * (HEIGHT - TOP - BOTTOM)

    parts = [f'<svg viewBox="0 0 {WIDTH} {HEIGHT}" role="img" aria-label="Error over time">']
    for level in np.arange(-reach, reach + step / 2, step).tolist():
        stroke = "#868e96" if abs(level) < step / 2 else "#e9ecef"
        place = f"{y(level):.1f}"
        parts.append(f'<line x1="{LEFT}" x2="{WIDTH - RIGHT}" y1="{place}" y2="{place}" stroke="{stroke}"/>')
        parts.append(f'<text x="{LEFT - 6}" y="{y(level) + 4:.1f}" text-anchor="end">{level + 0.0:.4g}{unit}</text>')
    dashed = f'y1="{TOP}" y2="{HEIGHT - BOTTOM}" stroke="#adb5bd" stroke-dasharray="3 3"/>'
    shown = [x(key) for key in keys if begin - SAME <= key <= end + SAME]
    parts += [f'<line x1="{place:.1f}" x2="{place:.1f}" {dashed}' for place in shown]
    width = _step((end - begin) / 6)
    marks = np.arange(math.ceil(begin / width) * width, end + SAME, width).tolist()
    parts += [f'<text x="{x(t):.1f}" y="{HEIGHT - 8}" text-anchor="middle">{t + 0.0:g} s</text>' for t in marks]
    for number, (times, errors) in enumerate(curves):
        if len(times) > MOST_POINTS:
            kept = outline(errors[None, :])
            times, errors = times[kept], errors[kept]
        points = " ".join(f"{x(t):.1f},{y(e):.1f}" for t, e in zip(times.tolist(), errors.tolist(), strict=True))
        color = COLORS[number % len(COLORS)]
        parts.append(f'<polyline points="{points}" fill="none" stroke="{color}" stroke-width="1.3"/>')
    return "".join([*parts, "</svg>"])


def _step(least: float) -> float:
    """The next round number: 1, 2 or 5 times a power of ten."""
    power = 10 ** math.floor(math.log10(least))
    return next(each * power for each in STEPS if each * power >= least * (1 - 1e-9))

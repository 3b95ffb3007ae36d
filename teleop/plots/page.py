"""A performance as one HTML file that works where there is no network: on set, from a memory stick.

Everything is inlined, and a content security policy forbids the page to fetch anything, so that this is not left to
care. The move goes in as JSON with `<` escaped, the one character by which data could end its script; titles reach the
document as text only.
"""

from __future__ import annotations

import html
import json
import math
import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from teleop.config.profile import Profile
from teleop.core.axes import Axis, Limits
from teleop.plots.downsample import QUANTITIES, curve
from teleop.plots.style import COLORS, PER, UNIT_SIGNS, mark
from teleop.sequence.compile import CompiledSequence

_WEB = Path(__file__).parent / "web"
_UPLOT = Path(__file__).parent / "vendor" / "uplot"
_SCRIPTS = ("values", "marks", "plots")  # one module: in this order


def page(performance: CompiledSequence, profile: Profile) -> str:
    """The HTML text of an interactive page about `performance` on the rig of `profile`."""
    return assembled(performance.title, _data(performance, profile))


def assembled(title: str, data: Mapping[str, Any]) -> str:
    """The page about `data`, which is as `_data` gives it.

    An axis may have samples of `measured`, drawn over its position, and None for what is not known at a time; `facts`
    replaces the line below the title.
    """
    parts = {
        "title": html.escape(title),
        "data": json.dumps(data, separators=(",", ":"), allow_nan=False).replace("<", "\\u003c"),
        "style": _text(_WEB / "page.css"),
        "script": "\n".join(_text(_WEB / f"{name}.js") for name in _SCRIPTS),
        "uplot_style": _text(_UPLOT / "uPlot.min.css"),
        "uplot": _text(_UPLOT / "uPlot.iife.min.js"),
        "uplot_license": _text(_UPLOT / "LICENSE"),
    }
    return re.sub(r"{{(\w+)}}", lambda found: parts[found[1]], _text(_WEB / "page.html"))


def _text(file: Path) -> str:
    return file.read_text(encoding="utf-8").strip()


def _data(performance: CompiledSequence, profile: Profile) -> dict[str, Any]:
    """What page.js draws."""
    return {
        "title": performance.title,
        "rig": profile.name,
        "duration": performance.duration,
        "cues": [{"at": cue.at, "name": cue.name} for cue in performance.cues],
        "quantities": [{"name": name, "per": PER[name]} for name in QUANTITIES],
        "axes": [_axis(axis, performance, profile.limits[axis]) for axis in performance.move.tracks],
        "warnings": list(performance.warnings),
    }


def _axis(axis: Axis, performance: CompiledSequence, limits: Limits) -> dict[str, Any]:
    track = performance.move.tracks[axis]
    times, rows = curve(track, performance.duration)
    peaks = track.peaks()
    reach = {name: [-getattr(limits, name), getattr(limits, name)] for name in QUANTITIES[1:]}
    return {
        "name": axis.value.replace("_", " "),
        "color": COLORS[axis],
        "unit": UNIT_SIGNS[axis.unit],
        "limits": {"position": [finite(limits.minimum), finite(limits.maximum)], **reach},
        "peaks": {
            "position": [short(peaks.minimum), short(peaks.maximum)],
            **{name: [short(getattr(peaks, name))] for name in QUANTITIES[1:]},
        },
        "keys": [
            {"at": key.at, "hold": key.hold, "position": key.position, "name": key.where, "mark": mark(key.where)}
            for key in performance.keys[axis]
        ],
        "times": [round(time, 6) for time in times.tolist()],
        "samples": {name: [short(value) for value in row] for name, row in zip(QUANTITIES, rows.tolist(), strict=True)},
    }


def finite(limit: float) -> float | None:
    return limit if math.isfinite(limit) else None


def short(value: float) -> float:
    """Six digits: finer than a screen, a third of the bytes."""
    return float(f"{value:.6g}")

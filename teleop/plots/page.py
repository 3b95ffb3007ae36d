"""A performance as one HTML file that works where there is no network: on set, from a memory stick.

Everything is inlined, and a content security policy forbids the page to fetch anything, so that this is not left to
care. The move goes in as JSON with `<` escaped, the one character by which data could end its script; titles reach the
document as text only.
"""

from __future__ import annotations

import html
import json
import re
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from teleop.config.documents.document import ENTRIES
from teleop.config.profile import Profile
from teleop.core.axes import Axis, Limits
from teleop.plots.downsample import QUANTITIES, curve
from teleop.plots.numbers import finite, short
from teleop.plots.shoot_page import shoot_data
from teleop.plots.style import COLORS, PER, UNIT_SIGNS, mark
from teleop.sequence.compile import CompiledSequence
from teleop.sequence.panorama import WHERE

if TYPE_CHECKING:
    from teleop.timelapse.compile import Timelapse

SHOT = f"{ENTRIES[WHERE]} "
_WEB = Path(__file__).parent / "web"
_UPLOT = Path(__file__).parent / "vendor" / "uplot"
_SCRIPTS = ("values", "labels", "marks", "path", "plots", "watch")  # one module: in this order


FOV = (54.0, 38.0)  # deg across and up: 35 mm on a full frame, where nothing says which lens it is


class Watch(NamedTuple):
    """A page that is written again and again: its `version`, and the `script` beside it that names the newest one."""

    version: str
    script: str


def page(
    performance: CompiledSequence,
    profile: Profile,
    timelapse: Timelapse | None = None,
    fov: tuple[float, float] | None = None,
    watch: Watch | None = None,
) -> str:
    """The HTML text of an interactive page about `performance` on the rig of `profile`.

    That of a `timelapse` is about its frames. `fov` is the field of view of the lens, across and up, in deg.
    """
    data = _data(performance, profile) if timelapse is None else shoot_data(timelapse, profile)
    if {"pan", "tilt"} & {axis["name"] for axis in data["axes"]}:
        data["fov"] = fov or performance.fov or FOV
        if performance.fov:
            data["tiles"] = tiles(performance)
    if watch is not None:
        data["watch"] = watch._asdict()
    return assembled(performance.title, data)


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
        "scripts_of": " 'self' file:" if "watch" in data else "",
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
        "notes": list(_notes(performance)),
    }


def tiles(performance: CompiledSequence) -> list[list[float]]:
    """Where the pictures of a panorama look, pan and tilt in deg, in their order."""
    shots = [key for key in performance.keys[Axis.PAN] if SHOT in key.where]
    tilts = {key.where: key.position for key in performance.keys[Axis.TILT]}
    return [[key.position, tilts[key.where]] for key in shots]


def _notes(performance: CompiledSequence) -> Iterator[str]:
    """A line for each axis that a table gives: how near the plan is to the frames."""
    for axis, tables in performance.frames.items():
        for table in tables:
            worst, unit = table.deviation(performance.move.tracks[axis]), UNIT_SIGNS[axis.unit]
            near = f"within {worst.size:.3f}{unit} of {table.tolerance:g}{unit}, worst at frame {worst.frame}"
            yield f"{table.table}: {axis.value} {near} ({worst.time:.2f} s)"


def _frames(axis: Axis, performance: CompiledSequence) -> list[list[float]] | None:
    """Times and positions of all frames that tables have of an axis."""
    tables = performance.frames.get(axis)
    if not tables:
        return None
    rows = ([value for table in tables for value in getattr(table, row).tolist()] for row in ("times", "positions"))
    return [[round(value, 5) for value in row] for row in rows]


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
        **({"frames": frames} if (frames := _frames(axis, performance)) else {}),
        "times": [round(time, 6) for time in times.tolist()],
        "samples": {name: [short(value) for value in row] for name, row in zip(QUANTITIES, rows.tolist(), strict=True)},
    }

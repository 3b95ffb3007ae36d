"""A certificate of repeatability as one page without scripts: to be printed, or handed to who composites the passes."""

from __future__ import annotations

import html
from collections.abc import Iterator, Sequence
from datetime import datetime

from teleop.core.axes import Axis
from teleop.plots.error_chart import COLORS, chart
from teleop.plots.printed_page import printed_page
from teleop.plots.style import UNIT_SIGNS
from teleop.recording.certificate import Certificate, Comparison, error_path
from teleop.recording.chan import ORDER, TURNS

NOT_IN_TAKE = "not in the take"
NONE = "&#8211;"


def page(found: Certificate, files: Sequence[str], fps: float, vfov: float) -> str:
    """The HTML text; `files` are the names of the paths written beside it."""
    title = found.takes[0].about.title
    name = f"{title}: repeatability"
    return printed_page(name, "Certificate of repeatability", title, _content(found, files, fps, vfov))


def _content(found: Certificate, files: Sequence[str], fps: float, vfov: float) -> Iterator[str]:
    yield _facts(found)
    for axis in found.measured:
        yield from _axis(found, axis)
    if missing := [axis for axis in found.axes if axis not in found.measured]:
        yield f"<p>Not measured, so nothing is certified of it: {', '.join(missing)}.</p>"
    yield from _passes(found)
    yield from _files(files, fps, vfov, [axis for axis in TURNS if axis not in found.measured])


def _facts(found: Certificate) -> str:
    about = found.takes[0].about
    dates = dict.fromkeys(_date(take.about.started) for take in found.takes)
    versions = dict.fromkeys(f"{link} {version}" for take in found.takes for link, version in take.firmware.items())
    rows = {
        "Rig": about.rig,
        "Firmware": ", ".join(versions) or NOT_IN_TAKE,
        "Recorded": ", ".join(dates),
        "Sequence (SHA-256)": found.fingerprint or NOT_IN_TAKE,
        "Passes": str(len(found.passes)),
        "Takes": ", ".join(take.path.name for take in found.takes),
        "Program": f"teleop {about.version}",
    }
    items = "".join(f"<dt>{name}</dt><dd>{html.escape(text)}</dd>" for name, text in rows.items())
    note = "Errors: the planned position less the measured one, at each reading of the gimbal's own sensors."
    return f'<dl>{items}</dl><p class="note">{note}</p>'


def _axis(found: Certificate, axis: Axis) -> Iterator[str]:
    unit = UNIT_SIGNS[axis.unit]
    yield f"<h2>{axis.value}</h2>"
    groups = ("Against the plan", "Against the first pass")
    heads = [
        "".join(f'<th class="group" colspan="6">{each}</th>' for each in groups),
        "".join(f'<th class="group" colspan="2">{each}</th>' for each in ("all", "at keys", "between") * 2),
        '<th class="group">RMS</th><th>peak</th>' * 6,
    ]
    head = "".join(f"<tr><th></th>{each}</tr>" for each in heads)
    rows = []
    for number, results in enumerate(found.results, 1):
        if axis in results:
            plan, first = results[axis].plan, results[axis].first
            rows.append(f"<tr><td>pass {number}</td>{_cells(plan, unit)}{_cells(first, unit)}</tr>")
    body = "".join(rows)
    yield f'<div class="scroll"><table><thead>{head}</thead><tbody>{body}</tbody></table></div>'
    shown = [(number, each) for number, each in enumerate(found.passes) if axis in found.results[number]]
    keys = found.keys.get(axis, ())
    yield f"<figure>{chart([error_path(each, axis, found.end) for _, each in shown], keys, unit)}</figure>"
    legend = "".join(
        f'<span><i style="background:{COLORS[place % len(COLORS)]}"></i>pass {number + 1}</span>'
        for place, (number, _) in enumerate(shown)
    )
    dashed = "dashed: keys" if keys else "the takes do not have the times of the keys"
    yield f'<p class="legend">error against the plan {legend}<span>{dashed}</span></p>'


def _cells(found: Comparison | None, unit: str) -> str:
    spreads = [None] * 3 if found is None else [found.all, found.keys, found.between]
    return "".join(
        f'<td class="group">{_number(each and each.rms, unit)}</td><td>{_number(each and each.peak, unit)}</td>'
        for each in spreads
    )


def _number(value: float | None, unit: str) -> str:
    return NONE if value is None else f"{value:.3f}{unit}" if unit else f"{value:.4f}"


def _passes(found: Certificate) -> Iterator[str]:
    yield "<h2>Passes</h2><ul>"
    for number, each in enumerate(found.passes, 1):
        begin, end = each.span
        text = f"pass {number}: pass {each.number} of {each.take.path.name}, {max(begin, 0):.2f} to {end:.2f} s"
        remarks = [*(["with a learned correction"] if each.corrected else []), *each.remarks]
        yield f"<li>{html.escape('; '.join([text, *remarks]))}</li>"
    yield "</ul>"
    for take in found.takes:
        if take.remark:
            yield f"<p>{html.escape(take.remark)}</p>"


def _files(files: Sequence[str], fps: float, vfov: float, missing: Sequence[Axis]) -> Iterator[str]:
    yield "<h2>Measured path</h2><ul>"
    for name in files:
        yield f"<li>{html.escape(name)}</li>"
    yield "</ul>"
    lens = f"vfov {vfov:g} degrees, as given" if vfov else "vfov 0: the lens is not in the take"
    still = f"; {' and '.join(missing)} not measured: 0" if missing else ""
    yield (
        f"<p>.chan: frame tx ty tz rx ry rz vfov at {fps:g} frames a second; degrees; rotation order {ORDER}; y is up"
        " and the camera looks along -z; rx is tilt up, ry is pan to the left, rz is roll counterclockwise"
        f"{still}. tx, ty, tz 0: a gimbal turns in place; {lens}. Frame 1 is the start of the move."
        " .csv: every reading at its own time.</p>"
    )


def _date(started: float) -> str:
    return datetime.fromtimestamp(started).astimezone().strftime("%Y-%m-%d %H:%M %z")

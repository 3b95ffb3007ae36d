"""`teleop take certificate FILE... -o PAGE`: how exactly the passes of a move were repeated, for who uses them."""

from __future__ import annotations

import io
import json
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, TextIO

from cyclopts import Parameter

from teleop.cli.screens.folded import tell
from teleop.cli.take.options import Json, Overwrite, notify, place, problems_as_json, recorded_on
from teleop.config.files import write_text
from teleop.core.errors import UsageError

if TYPE_CHECKING:
    from teleop.recording.certificate import Certificate, Comparison

ENDINGS = (".html", ".htm")
FASTEST = 1000.0  # frames a second


def take_certificate(
    files: Annotated[
        list[Path],
        Parameter(help="Takes (.mcap) of one move: several passes in one file, or a file for each.", negative=()),
    ],
    /,
    *,
    output: Annotated[Path, Parameter(name=("--output", "-o"), metavar="FILE", help="The page to write (.html).")],
    fps: Annotated[float, Parameter(metavar="RATE", help="Frames a second of the .chan files.")] = 24.0,
    vfov: Annotated[
        float, Parameter(metavar="DEGREES", help="Vertical field of view for the .chan files; 0: not known.")
    ] = 0.0,
    overwrite: Overwrite = False,
    as_json: Json = False,
) -> int:
    """Certify how exactly the passes of a move were repeated, against the plan and against the first pass.

    The measured path of each pass is written beside the page, as .chan and as .csv.
    """
    if output.suffix.lower() not in ENDINGS:
        raise UsageError(f"-o {output}: its ending must be .html")
    if not 0 < fps <= FASTEST:
        raise UsageError(f"--fps {fps:g}: must be above 0, and {FASTEST:g} at most")
    if not 0 <= vfov < 180:
        raise UsageError(f"--vfov {vfov:g}: must be between 0 and 180 degrees")
    for file in files:
        place("-o", output, overwrite, file)
    from teleop.plots.certificate_html import page
    from teleop.recording.certificate import certify
    from teleop.recording.reader import read_take

    with problems_as_json(as_json):
        found = certify([read_take(file) for file in files])
    for take in found.takes:
        notify(take.remark)
    beside = _paths(found, output, fps, vfov)
    for path in beside:
        place("-o", path, overwrite, output)
    write_text(output, page(found, [path.name for path in beside], fps, vfov))
    for path, write in beside.items():
        text = io.StringIO()
        write(text)
        write_text(path, text.getvalue())
    if as_json:
        print(json.dumps(_facts(found, output, list(beside))))
    else:
        _print(found, output, list(beside))
    return 0


def _paths(found: Certificate, output: Path, fps: float, vfov: float) -> Mapping[Path, Callable[[TextIO], None]]:
    """The files beside the page, and what writes each."""
    from functools import partial

    from teleop.recording.chan import ORDER, write_chan, write_path

    paths: dict[Path, Callable[[TextIO], None]] = {}
    for number, each in enumerate(found.passes, 1):
        stem = f"{output.stem}.pass{number}"
        paths[output.with_name(f"{stem}.{ORDER}.chan")] = partial(write_chan, each, fps, vfov)
        paths[output.with_name(f"{stem}.csv")] = partial(write_path, each)
    return paths


def _print(found: Certificate, output: Path, beside: Sequence[Path]) -> None:
    from teleop.cli.screens.tables import print_table
    from teleop.plots.style import UNIT_SIGNS

    rows = []
    for number, results in enumerate(found.results, 1):
        for axis, result in results.items():
            unit = UNIT_SIGNS[axis.unit]
            first = ["-", "-"] if result.first is None else _shown(result.first, unit)
            rows.append([str(number), axis.value, *_shown(result.plan, unit), *first])
    headings = ("Pass", "Axis", "RMS to plan", "Peak to plan", "RMS to first", "Peak to first")
    title = f"{found.takes[0].about.title} on {found.takes[0].about.rig}"
    print_table(title, headings, rows, words=("Axis",), drop=("Peak to first", "Peak to plan"))
    for axis in found.axes:
        if axis not in found.measured:
            tell(f"{axis}: not measured")
    for number, each in enumerate(found.passes, 1):
        for remark in each.remarks:
            tell(f"pass {number}: {remark}")
    for path in (output, *beside):
        tell(f"{path}: written")


def _shown(found: Comparison, unit: str) -> list[str]:
    return [f"{found.all.rms:.3f}{unit}", f"{found.all.peak:.3f}{unit}"]


def _facts(found: Certificate, output: Path, beside: Sequence[Path]) -> Mapping[str, Any]:
    from teleop.recording.chan import ORDER

    about = found.takes[0].about
    passes = [
        {
            "take": str(each.take.path),
            "pass": each.number,
            "corrected": each.corrected,
            "remarks": list(each.remarks),
            "axes": {
                axis.value: {
                    "plan": _plain(result.plan),
                    "first": None if result.first is None else _plain(result.first),
                }
                for axis, result in results.items()
            },
        }
        for each, results in zip(found.passes, found.results, strict=True)
    ]
    firmware = {link: version for take in found.takes for link, version in take.firmware.items()}
    return {
        "ok": True,
        "written": [str(output), *map(str, beside)],
        "title": about.title,
        "rig": about.rig,
        "recorded": [recorded_on(take.about.started) for take in found.takes],
        "firmware": firmware or None,
        "sequence": found.fingerprint or None,
        "rotation_order": ORDER,
        "not_measured": [axis.value for axis in found.axes if axis not in found.measured],
        "passes": passes,
    }


def _plain(found: Comparison) -> Mapping[str, Any]:
    spreads = {"all": found.all, "keys": found.keys, "between": found.between}
    return {
        name: each and {key: round(value, 6) for key, value in asdict(each).items()} for name, each in spreads.items()
    }

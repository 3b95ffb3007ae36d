"""`teleop take report FILE`: how well a run went, in a table, and as a page or a picture."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from dataclasses import asdict
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from cyclopts import Parameter

from teleop.cli.screens.folded import tell
from teleop.cli.take.options import Json, Overwrite, TakeFile, ending_facts, length, notify, place, problems_as_json
from teleop.config.documents.document import UnplayableError
from teleop.config.files import replacing
from teleop.core.axes import Axis
from teleop.core.errors import UsageError

if TYPE_CHECKING:
    from teleop.recording.reader import Take
    from teleop.recording.report import AxisReport

ENDINGS = (".html", ".svg", ".png")


def take_report(
    file: TakeFile,
    /,
    *,
    output: Annotated[
        Path | None,
        Parameter(
            name=("--output", "-o"), metavar="FILE", help="Draw it too: a page (.html) or a drawing (.svg, .png)."
        ),
    ] = None,
    overwrite: Overwrite = False,
    as_json: Json = False,
) -> int:
    """Report how well a run went: errors, delay and limits used by axis, and why it stopped.

    The page and the drawing show what was commanded and measured, the error, the actions and the end.
    """
    if output is not None:
        _drawable(output)
        place("-o", output, overwrite, file)
    from teleop.recording.reader import read_take
    from teleop.recording.report import report

    with problems_as_json(as_json):
        take = read_take(file)
    notify(take.remark)
    found = report(take)
    if output is not None:
        _draw(take, found, output)
    if as_json:
        axes = {axis.value: {key: _plain(value) for key, value in asdict(of).items()} for axis, of in found.items()}
        about = {"title": take.about.title, "rig": take.about.rig, "seconds": round(take.duration, 3)}
        print(json.dumps({"ok": True, **about, **ending_facts(take.ending), "problem": take.remark, "axes": axes}))
    else:
        _print(take, found)
    return 0


def _drawable(output: Path) -> None:
    ending = output.suffix.lower()
    if ending not in ENDINGS:
        raise UsageError(f"-o {output}: its ending must be one of {', '.join(ENDINGS)}")
    if ending != ".html" and find_spec("matplotlib") is None:
        raise UsageError(f"-o {output}: a drawing needs matplotlib: pip install 'rs-teleop[plot]'")


def _draw(take: Take, found: Mapping[Axis, AxisReport], output: Path) -> None:
    if not found:
        raise UnplayableError([f"{take.path}: is empty: nothing to draw"])
    with replacing(output) as stream:
        if output.suffix.lower() == ".html":
            from teleop.plots.report_html import page

            stream.write(page(take, found).encode())
        else:
            from teleop.plots.report_plot import draw

            draw(take, stream, output.suffix.lower().removeprefix("."))


def _print(take: Take, found: Mapping[Axis, AxisReport]) -> None:
    from teleop.cli.screens.tables import print_table
    from teleop.plots.style import UNIT_SIGNS

    rows = []
    for axis, of in found.items():
        unit = UNIT_SIGNS[axis.unit]
        off = [f"{of.rms:.3f}{unit}", f"{of.peak:.3f}{unit}", f"{of.peak_at:.2f} s"] if of.readings else ["-"] * 3
        later = "?" if of.delay is None else f"{round(1000 * of.delay)} ms"
        used = [f"{share:.0%}" for share in (of.velocity, of.acceleration, of.jerk)]
        rows.append([axis.value, *off, later, *used, "endless" if of.room is None else f"{of.room:.2f}{unit}"])
    title = f"{take.about.title}: {length(take.duration)} on {take.about.rig}"
    headings = ("Axis", "RMS", "Peak", "at", "Delay", "V", "A", "J", "Room")
    print_table(title, headings, rows, words=("Axis",), drop=("at", "Room", "J", "A", "V", "Delay"))
    for axis, of in found.items():
        if of.delay is None:
            tell(f"{axis}: delay unknown: {of.untold}")
    tell(f"ended: {take.ended}")


def _plain(value: object) -> object:
    """NaN, which JSON has not, is null; floats with as many digits as mean something."""
    if isinstance(value, float):
        return round(value, 6) if math.isfinite(value) else None
    return value

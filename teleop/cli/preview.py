"""`teleop preview FILE`: what a move will look like, without touching a port.

What can be wrong with the request is found before the sequence is planned, and what is wrong with the sequence before
anything is written.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterator, Mapping
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, BinaryIO

from cyclopts import Parameter

from teleop.app.planning import Plan
from teleop.cli.options import DEFAULTS, MOVES, Options, announce, announce_json, print_warnings
from teleop.cli.own_files import check_own
from teleop.cli.shipped_files import named
from teleop.cli.signals import unwound_by_signals
from teleop.config.files import replacing
from teleop.config.frame_rates import exact_rate
from teleop.core.errors import UsageError
from teleop.core.timing import SAME_TIME
from teleop.sequence.compile import CompiledSequence

if TYPE_CHECKING:
    from teleop.plots.page import Watch

Fov = tuple[float, float]  # deg across and up
Write = Callable[["Plan", BinaryIO, "Watch | None"], None]


def preview(
    file: Annotated[str | None, Parameter(help="A shipped move's name, or a file.", completer=MOVES)] = None,
    /,
    *,
    output: Annotated[
        Path | None,
        Parameter(name=("--output", "-o"), metavar="FILE", help="Write a page (.html) or a drawing (.svg, .png)."),
    ] = None,
    csv: Annotated[Path | None, Parameter(metavar="FILE", help="Write a table of every axis over time.")] = None,
    rate: Annotated[float, Parameter(metavar="HZ", help="Rows of the table per second.")] = 100.0,
    fov: Annotated[
        str | None, Parameter(metavar="WxH", help="Field of view of the lens in deg, for the page's path: 54x38.")
    ] = None,
    watch: Annotated[
        bool,
        Parameter(
            negative="",
            show_default=False,
            help="Write again whenever a file of the sequence is saved; the page reloads.",
        ),
    ] = False,
    options: Options = DEFAULTS,
) -> int:
    """Draw a sequence as a rig would play it: an interactive page, a drawing or a table."""
    lens = None if fov is None else _fov(fov)
    file, writes = named("preview", file, options.json), _writes(output, csv, rate, lens)
    for path in writes:
        check_own(path)
    if watch:
        from teleop.cli.watched_preview import watch_preview

        if output is None or output.suffix.lower() != ".html":
            raise UsageError("--watch: needs a page to reload: give -o FILE.html")
        return watch_preview(file, options, output, lambda version: _write(file, options, writes, version))
    _write(file, options, writes)
    return 0


def _write(file: str, options: Options, writes: Mapping[Path, Write], watch: Watch | None = None) -> None:
    """Plan, and write what is asked for. Raises DocumentError and OutputError."""
    plan = options.plan(file)
    profile, performance = plan.profile, plan.sequence
    if plan.timelapse is not None:
        print_warnings(performance.warnings)
    written = []
    for path, write in writes.items():
        with unwound_by_signals(), replacing(path) as stream:
            write(plan, stream, watch)
            written.append({"path": str(path), "bytes": stream.tell()})
        if not options.json:
            announce(f"{path}: {performance.title}, {performance.duration:.2f} s on {profile.name}", *writes)
    if options.json:
        found = {"ok": True, "title": performance.title, "duration": performance.duration, "written": written}
        announce_json({**found, "warnings": list(performance.warnings)}, *writes)


def _fov(text: str) -> Fov:
    """`54x38` in deg. Raises UsageError."""
    found = re.fullmatch(r"([0-9]+(?:\.[0-9]+)?)\s*[xX×]\s*([0-9]+(?:\.[0-9]+)?)", text.strip())
    across, up = (float(found[1]), float(found[2])) if found else (0.0, 0.0)
    if not (0 < across < 180 and 0 < up < 180):
        raise UsageError(f"--fov {text}: must be degrees across and up, below 180: 54x38")
    return across, up


def _writes(output: Path | None, csv: Path | None, rate: float, fov: Fov | None) -> Mapping[Path, Write]:
    """What to write where; raises UsageError when that cannot be done on any sequence."""
    writes: dict[Path, Write] = {}
    if output is not None:
        ending = output.suffix.lower()
        if ending not in _KINDS:
            raise UsageError(f"-o {output}: its ending must be one of {', '.join(_KINDS)}")
        if _KINDS[ending] is _drawing and find_spec("matplotlib") is None:
            raise UsageError(f"-o {output}: a drawing needs matplotlib: pip install 'rs-teleop[plot]'")
        writes[output] = _KINDS[ending](ending, fov)
    if csv is not None:
        if not (math.isfinite(rate) and rate > 0):
            raise UsageError(f"--rate {rate:g}: must be more than 0 rows per second")
        if output is not None and csv.resolve() == output.resolve():
            raise UsageError(f"--csv {csv}: is where -o writes too")
        writes[csv] = _table(exact_rate(rate))  # 29.97 rows a second are those of the frames
    if not writes:
        raise UsageError("nothing to write: give -o FILE.html, .svg or .png, or --csv FILE")
    return writes


def _page(_ending: str, fov: Fov | None) -> Write:
    def write(plan: Plan, stream: BinaryIO, watch: Watch | None) -> None:
        from teleop.plots.page import page

        stream.write(page(plan.sequence, plan.profile, plan.timelapse, fov, watch).encode())

    return write


def _drawing(ending: str, _fov: Fov | None) -> Write:
    def write(plan: Plan, stream: BinaryIO, _watch: Watch | None) -> None:
        from teleop.plots.drawing import draw

        draw(plan.sequence, plan.profile, stream, ending.removeprefix("."))

    return write


_KINDS: Mapping[str, Callable[[str, Fov | None], Write]] = {
    ".html": _page,
    ".svg": _drawing,
    ".png": _drawing,
}


def _table(rate: float) -> Write:
    def write(plan: Plan, stream: BinaryIO, _watch: Watch | None) -> None:
        for text in _progress(plan.sequence, rate):
            stream.write(text.encode())

    return write


def _progress(performance: CompiledSequence, rate: float) -> Iterator[str]:
    """The table's text, with a bar on a terminal: a day takes a minute."""
    import numpy as np
    from rich.console import Console
    from rich.progress import Progress

    from teleop.plots.table import header, lines

    move, console = performance.move, Console(stderr=True)
    last = 0.0
    yield header(list(move.tracks))
    with Progress(console=console, transient=True, disable=not console.is_terminal or console.is_dumb_terminal) as bar:
        task = bar.add_task("Writing", total=move.duration or None)
        for times, samples in move.chunks(rate):
            yield from lines([(times, samples)])
            last = float(times[-1])
            bar.update(task, completed=last)
        if last < move.duration - SAME_TIME:  # the last row is the end, on the rate's grid or not
            end = np.array([move.duration])
            yield from lines([(end, move.sample(end))])

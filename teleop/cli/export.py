"""`teleop export MOVE|TAKE -o FILE`: the path of a move or a take for another program."""

from __future__ import annotations

from fractions import Fraction
from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from teleop.app.export_motion import USUAL_RATE, Exported, exported, keys_of, own_rate, planned_motion, recorded_motion
from teleop.app.planning import is_take
from teleop.cli.exchanged_files import FormatName, Overwrite, certain, check_output, check_vfov, rate_of
from teleop.cli.options import DEFAULTS, MOVES, Options, announce, announce_json
from teleop.cli.screens.folded import complain
from teleop.cli.shipped_files import named
from teleop.cli.take.options import problems_as_json
from teleop.config.files import is_stream, replacing, write_text
from teleop.core.errors import UsageError
from teleop.interchange.companion import beside
from teleop.interchange.motion import Motion, shown
from teleop.interchange.table import Format, format_of


def export(
    file: Annotated[
        str | None, Parameter(help="A shipped move's name, a file, or a take (.mcap).", completer=MOVES)
    ] = None,
    /,
    *,
    output: Annotated[
        Path,
        Parameter(
            name=("--output", "-o"),
            metavar="FILE",
            help="The file to write: .chan, .csv, .arcm, .raw, .asc, .usda, .usdc, .py (Blender) or .otio.",
        ),
    ],
    form: FormatName = None,
    rate: Annotated[
        str | None,
        Parameter(metavar="FPS", help="Frames per second, as in 24 or 24000/1001; else the move's own, else 24."),
    ] = None,
    first_frame: Annotated[int, Parameter(metavar="N", help="Number of the first frame.")] = 1,
    vfov: Annotated[float | None, Parameter(metavar="DEGREES", help="Vertical field of view of the lens.")] = None,
    commanded: Annotated[
        bool,
        Parameter(help="Of a take: commanded positions, not the measured ones.", negative=(), show_default=False),
    ] = False,
    number: Annotated[
        int | None,
        Parameter(name="--pass", metavar="N", help="Of a take: only this pass, at the move's own time."),
    ] = None,
    overwrite: Overwrite = False,
    options: Options = DEFAULTS,
) -> int:
    """Write the path of a move or a take for another program: Nuke, Dragonframe, Blender, USD, Kuper, an editor.

    A take is what was measured, at the times of its readings; with --rate, or in a format with a row for each frame,
    it is drawn straight between them. What a format has no place for is printed.
    """
    file, frames = named("export", file, options.json), rate_of(rate)
    chosen = certain(format_of(output, form, "-o "), output, "-o ")
    check_vfov(vfov)
    if not is_take(file) and (commanded or number is not None):
        raise UsageError(f"{'--commanded' if commanded else '--pass'}: is for takes (.mcap), and {file} is none")
    check_output(output, overwrite, Path(file))
    side = None if chosen.notes is None or is_stream(output) else beside(output)
    if side is not None:
        check_output(side, overwrite, Path(file))
    chosen.load()
    if is_take(file):
        motion = _recorded(Path(file), chosen, frames, first_frame, commanded, number, options.json)
    else:
        motion = _planned(file, frames, first_frame, options)
    with problems_as_json(options.json):
        done = exported(motion, chosen, output.suffix.lower(), vfov)
    with replacing(output) as stream:
        stream.write(done.content)
    if side is not None and done.beside is not None:
        write_text(side, done.beside)
    _report(done, chosen, output, side, options.json)
    return 0


def _planned(file: str, rate: Fraction | None, first: int, options: Options) -> Motion:
    """The path of a move."""
    plan = options.plan(file)
    motion = keys_of(plan, planned_motion(plan, file, rate, first))
    if rate is None and own_rate(plan) is None:
        complain(f"{file}: has no fps: written at {shown(motion.known_rate)}; --rate gives another")
    return motion


def _recorded(
    file: Path, form: Format, rate: Fraction | None, first: int, commanded: bool, number: int | None, as_json: bool
) -> Motion:
    """The path of a take: with the times of its readings, where the format can have them."""
    from teleop.recording.reader import read_take

    with problems_as_json(as_json):
        take = read_take(file)
        if take.remark:
            complain(take.remark)
        if rate is None and not form.by_time:
            complain(f"{file}: has no frame rate: written at {shown(USUAL_RATE)}; --rate gives another")
            rate = USUAL_RATE
        return recorded_motion(take, rate, first, commanded=commanded, number=number)


def _report(done: Exported, form: Format, output: Path, side: Path | None, as_json: bool) -> None:
    motion = done.motion
    written = [str(output), *([str(side)] if side is not None else [])]
    if side is None and done.beside is not None:
        complain(f"rotation order ZXY, degrees, {motion.known_rate} frames a second; axes {', '.join(motion.axes)}")
    if as_json:
        known = {"format": form.name, "rate": str(motion.known_rate), "rows": len(motion.times)}
        announce_json({"ok": True, "written": written, **known, "not_carried": list(done.not_carried)}, output)
        return
    for line in done.not_carried:
        complain(f"not carried: {line}")
    rows = f"{len(motion.times)} frames, {shown(motion.known_rate)}"
    if not motion.by_frame:
        rows = f"{len(motion.times)} readings, at the times of the recording"
    announce(f"{output}: {form.title}, {rows}", output)
    if side is not None:
        announce(f"{side}: its units, axes, rotation order and rate; keep it beside the file", output)

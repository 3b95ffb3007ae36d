"""`teleop import FILE -o MOVE.yaml`: a path or markers of another program as a sequence file."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from teleop.app.import_motion import Imported, Importer
from teleop.app.read_motion import origin_lines, read_motion, sniffed
from teleop.cli.completion import offered
from teleop.cli.exchanged_files import FormatName, Overwrite, certain, check_output, rate_of
from teleop.cli.fitted_options import SequenceOutput, check_ending, check_tolerance, counted
from teleop.cli.options import RIGS
from teleop.cli.screens.busy import busy
from teleop.cli.screens.folded import complain, tell
from teleop.cli.take.options import Json, problems_as_json
from teleop.config.documents.document import DocumentError
from teleop.config.files import write_text
from teleop.config.profile import load_profile
from teleop.core.axes import Axis
from teleop.core.errors import UsageError
from teleop.interchange.rotation import ORDERS
from teleop.interchange.table import AMBIGUOUS, READABLE, Format, Hints, format_of
from teleop.plots.style import UNIT_SIGNS

FILES = offered("", *READABLE, *AMBIGUOUS)
SKIPPED = ("frame", "time", "-")
"""What a column may be beside an axis."""


def import_(
    file: Annotated[Path, Parameter(help="A file of another program.", completer=FILES)],
    /,
    *,
    output: SequenceOutput,
    form: FormatName = None,
    rate: Annotated[
        str | None, Parameter(metavar="FPS", help="Frames per second of the file, as in 24 or 24000/1001.")
    ] = None,
    rotation_order: Annotated[
        str | None, Parameter(metavar="ORDER", help="Rotation order of a .chan, first turn first: ZXY is Nuke's own.")
    ] = None,
    columns: Annotated[
        str | None,
        Parameter(metavar="LIST", help="The axis of each column, as in pan,tilt,-: a minus skips a column."),
    ] = None,
    only: Annotated[str | None, Parameter(metavar="AXES", help="The axes to take, as in pan,tilt.")] = None,
    invert: Annotated[
        str | None, Parameter(metavar="AXES", help="Axes that go the other way in the file, as in pan.")
    ] = None,
    camera: Annotated[str | None, Parameter(metavar="NAME", help="Which camera of a USD file.")] = None,
    tolerance: Annotated[
        float,
        Parameter(
            metavar="DEGREES", help="Largest error at any frame: degrees; for focus and sticks percent of their range."
        ),
    ] = 0.1,
    stretch: Annotated[
        bool, Parameter(help="Slow it down where it is too fast for the rig.", negative=(), show_default=False)
    ] = False,
    rig: Annotated[
        str, Parameter(metavar="NAME|FILE", help="The rig: a shipped profile's name, or a file.", completer=RIGS)
    ] = "sim",
    overwrite: Overwrite = False,
    as_json: Json = False,
) -> int:
    """Make a sequence file of a path by the frame, or of an editor's markers: sparse keys within a tolerance.

    Read are .chan, .csv, .arcm, .raw, .asc, .txt (with --format), .usda, .usdc, .otio, and teleop's Blender script.
    The sequence is planned for the rig and compared with every frame before it is written.
    """
    check_tolerance(tolerance)
    if rotation_order is not None and rotation_order.upper() not in ORDERS:
        raise UsageError(f"--rotation-order {rotation_order}: must be one of {', '.join(ORDERS)}")
    check_ending(output)
    order = rotation_order and rotation_order.upper()
    hints = Hints(rate_of(rate), order, _names("--columns", columns, [*Axis, *SKIPPED]), camera=camera)
    taken, inverted = _axes("--only", only), _axes("--invert", invert) or []
    with problems_as_json(as_json):
        if not file.is_file():
            raise DocumentError([f"{file}: no such file"])
        chosen = format_of(file, form, "")
        chosen = certain(sniffed(file) if chosen is None else chosen, file, "")
        check_output(output, overwrite, file)
        profile = load_profile(rig, {}, "")
        motion = read_motion(file, chosen, hints, taken, inverted)
        about = list(origin_lines(file, chosen, motion, hints, tolerance))
        with busy("Fitting"):
            done = Importer(str(file), profile.limits, profile.name, tolerance, stretch).sequence(motion, about)
    write_text(output, done.text)
    _report(done, motion.remarks, chosen, output, as_json)
    return 0


def _axes(option: str, text: str | None) -> Sequence[Axis] | None:
    names = _names(option, text, [*Axis])
    return None if names is None else [Axis(each) for each in names]


def _names(option: str, text: str | None, known: Sequence[str]) -> Sequence[str] | None:
    """The names in a list, each one of those known. Raises UsageError."""
    if text is None:
        return None
    names = [each.strip().lower() for each in text.split(",")]
    if wrong := [each for each in names if each not in known]:
        raise UsageError(f"{option} {text}: {wrong[0] or 'an empty name'} is none of {', '.join(known)}")
    return names


def _report(done: Imported, left_out: Sequence[str], form: Format, output: Path, as_json: bool) -> None:
    cues = len(done.sequence.cues)
    if as_json:
        errors = {axis.value: {"error": round(e.size, 6), "frame": e.frame} for axis, e in done.deviations.items()}
        known = {"ok": True, "written": str(output), "format": form.name, "rate": done.sequence.fps}
        counts = {"keyframes": done.keyframes, "cues": cues}
        lines = {"left_out": list(left_out), "remarks": list(done.remarks)}
        print(json.dumps({**known, **counts, "largest_errors": errors, **lines}))
        return
    for line in left_out:
        complain(f"left out: {line}")
    for line in (*done.remarks, *done.sequence.warnings):
        complain(f"{output}: {line}")
    errors = [f"{axis} {e.size:.3f}{UNIT_SIGNS[axis.unit]} at frame {e.frame}" for axis, e in done.deviations.items()]
    parts = [counted(done.keyframes, "keyframe")]
    parts += [counted(cues, "cue")] if cues else []
    parts += [f"largest error {', '.join(errors)}"] if errors else []
    tell(f"{output}: {', '.join(parts)}")

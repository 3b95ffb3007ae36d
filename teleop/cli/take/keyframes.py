"""`teleop take keyframes FILE -o OUT.yaml`: a recorded run as a sequence file that a person can edit."""

from __future__ import annotations

import json
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Annotated

from cyclopts import Parameter

from teleop.cli.fitted_options import SequenceOutput, check_ending, check_tolerance, counted
from teleop.cli.play import percentage
from teleop.cli.screens.folded import tell
from teleop.cli.take.options import Json, Overwrite, TakeFile, notify, place, problems_as_json
from teleop.config.files import write_text
from teleop.plots.style import UNIT_SIGNS


def take_keyframes(
    file: TakeFile,
    /,
    *,
    output: SequenceOutput,
    tolerance: Annotated[
        float,
        Parameter(
            metavar="DEGREES",
            help="Largest error at any time: degrees; for focus and sticks percent of their range.",
        ),
    ] = 0.2,
    measured: Annotated[
        bool, Parameter(help="Fit the measured positions, not the commanded ones.", negative=(), show_default=False)
    ] = False,
    speed: Annotated[
        str, Parameter(metavar="PERCENT", help="Speed of the result, as a percentage of the take's.")
    ] = "100%",
    overwrite: Overwrite = False,
    as_json: Json = False,
) -> int:
    """Fit sparse keyframes to a take, and write them as a sequence file.

    The file is planned and compared with the take at every hundredth of a second before it is written. The way to the
    start that `play` made is a part of its takes.
    """
    check_tolerance(tolerance)
    check_ending(output)
    place("-o", output, overwrite, file)
    from teleop.recording.reader import read_take
    from teleop.recording.replay import warnings
    from teleop.recording.to_keyframes.convert import keyframes

    with problems_as_json(as_json):
        rate = percentage("--speed", speed)
        take = read_take(file)
        for warning in warnings(take):
            notify(warning)
        with _busy(f"Fitting {take.duration:.0f} s"):
            fitted = keyframes(take, tolerance, rate, measured=measured)
    write_text(output, fitted.text)
    if as_json:
        errors = {axis.value: {"error": round(e.size, 6), "time": e.time} for axis, e in fitted.errors.items()}
        facts = {"ok": True, "written": str(output), "keyframes": len(fitted.frames), "tolerance": tolerance}
        print(json.dumps({**facts, "largest_errors": errors}))
    else:
        errors = [f"{axis} {e.size:.3f}{UNIT_SIGNS[axis.unit]} at {e.time:.2f} s" for axis, e in fitted.errors.items()]
        tell(f"{output}: {counted(len(fitted.frames), 'keyframe')}, largest error {', '.join(errors)}")
    return 0


@contextmanager
def _busy(what: str) -> Iterator[None]:
    """A sign of life on a terminal: a minute of a restless hand takes about as long to fit."""
    from rich.console import Console
    from rich.text import Text

    console = Console(stderr=True)
    if not console.is_terminal or console.is_dumb_terminal:
        yield
        return
    with console.status(Text(what), spinner="dots" if console.encoding.startswith("utf") else "line"):
        yield

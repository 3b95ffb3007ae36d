"""What `teleop export` and `teleop import` share: rates, formats, and files that are not replaced unasked."""

from __future__ import annotations

import math
import re
from fractions import Fraction
from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from teleop.cli.take.options import check_free
from teleop.config.frame_rates import exact
from teleop.core.errors import UsageError
from teleop.interchange.motion import MOST_RATE
from teleop.interchange.table import AMBIGUOUS, BY_NAME, Format

Overwrite = Annotated[bool, Parameter(help="Replace existing files.", negative=(), show_default=False)]
FormatName = Annotated[
    str | None,
    Parameter(name="--format", metavar="NAME", help=f"The format, else by the ending: {', '.join(BY_NAME)}."),
]


def rate_of(text: str | None) -> Fraction | None:
    """`24`, `23.976` and `24000/1001` as frames a second. Raises UsageError."""
    if text is None:
        return None
    found = re.fullmatch(r"([0-9]{1,7})\s*/\s*([0-9]{1,7})", text.strip())
    try:
        rate = Fraction(int(found[1]), int(found[2])) if found else exact(float(text))
    except (ValueError, ZeroDivisionError, OverflowError):
        rate = Fraction(0)
    if not 0 < rate <= MOST_RATE:
        raise UsageError(f"--rate {text}: must be frames a second, as in 24, 23.976 or 24000/1001")
    return rate


def check_vfov(vfov: float | None) -> None:
    """Raises UsageError."""
    if vfov is not None and not (math.isfinite(vfov) and 0 < vfov < 180):
        raise UsageError(f"--vfov {vfov:g}: must be between 0 and 180 degrees")


def check_output(path: Path, overwrite: bool, source: Path) -> None:
    """Raises UsageError where nothing may be written, OutputError where nothing can be."""
    if path.exists() and source.exists() and path.samefile(source):
        raise UsageError(f"-o {path}: is the file itself; choose another")
    check_free("-o", path, overwrite)


def certain(found: Format | None, path: Path, option: str) -> Format:
    """A format, where the ending left no doubt. Raises UsageError."""
    if found is None:
        what = AMBIGUOUS[path.suffix.lower()]
        raise UsageError(f"{option}{path}: is {what}: give --format raw or --format kuper")
    return found

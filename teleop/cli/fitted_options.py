"""What commands share that fit keys within a tolerance: the sequence file that they write, and what they say of it."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from teleop.core.errors import UsageError

ENDINGS = (".yaml", ".yml")
SequenceOutput = Annotated[
    Path, Parameter(name=("--output", "-o"), metavar="FILE", help="The sequence file to write (.yaml).")
]


def check_tolerance(tolerance: float) -> None:
    """Raises UsageError."""
    if not (math.isfinite(tolerance) and tolerance > 0):
        raise UsageError(f"--tolerance {tolerance:g}: must be more than 0 degrees")


def check_ending(output: Path) -> None:
    """Raises UsageError for a file that would be no sequence file."""
    if output.suffix.lower() not in ENDINGS:
        raise UsageError(f"-o {output}: its ending must be {' or '.join(ENDINGS)}")


def counted(count: int, what: str) -> str:
    """`1 keyframe`, `2 keyframes`."""
    return f"{count} {what}{'' if count == 1 else 's'}"

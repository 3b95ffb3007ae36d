"""The options of `teleop play` for a trim of the running sequence, and its report at the end."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from teleop.app.trim_writer import TrimWriter
from teleop.core.errors import UsageError

SHARE = "25%"


@Parameter(name="*")
@dataclass(frozen=True)
class TrimOptions:
    """`left` is the share of V, A and J that is left for the sequence."""

    trim: Annotated[
        bool, Parameter(help="Trim the playing sequence with sticks, dials and keys.", negative=(), show_default=False)
    ] = False
    trim_share: Annotated[
        str, Parameter(metavar="PERCENT", help="Share of velocity, acceleration and jerk for the trim.")
    ] = SHARE
    trim_out: Annotated[
        Path | None,
        Parameter(metavar="FILE", help="Write the trimmed sequence to a new file: at key w, or at the end."),
    ] = None

    @property
    def left(self) -> float:
        """Raises UsageError for options that mean nothing."""
        if not self.trim:
            if self.trim_out or self.trim_share != SHARE:
                raise UsageError(f"--trim-{'out' if self.trim_out else 'share'}: needs --trim")
            return 1.0
        text = self.trim_share.strip().removesuffix("%")
        try:
            percent = float(text)
        except ValueError:
            percent = 0.0
        if not 0 < percent < 100:
            raise UsageError(f"--trim-share {self.trim_share}: must be a percentage between 0 and 100, as in {SHARE}")
        return 1 - percent / 100


class TrimReport:
    """What the trim came to, and its file."""

    def __init__(self, writer: TrimWriter) -> None:
        self._writer = writer

    def facts(self) -> Iterator[tuple[str, object]]:
        offsets = {axis.value: round(state.position, 6) for axis, state in self._writer.offsets.items()}
        file = self._writer.finish()
        yield "trim", {"offsets": offsets, "file": file, "trouble": self._writer.failure}

    def print(self) -> None:
        offsets = self._writer.offsets.items()
        words = [f"{axis} {o.position + 0.0:+.3f} {axis.unit}".rstrip() for axis, o in offsets]
        file = self._writer.finish()
        print(f"trim: {', '.join(words)}{f'; written to {file}' if file else ''}")
        if self._writer.failure:
            print(f"teleop: {self._writer.failure}", file=sys.stderr)


NO_TRIM = TrimOptions()

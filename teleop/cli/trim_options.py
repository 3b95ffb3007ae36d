"""The options of `teleop play` for a hand on the running sequence, and what is said of it at the end."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator, Mapping
from concurrent.futures import Future
from dataclasses import dataclass
from pathlib import Path
from threading import Thread
from typing import TYPE_CHECKING, Annotated

from cyclopts import Parameter

from teleop.core.errors import TeleopError, UsageError

if TYPE_CHECKING:
    from teleop.core.axes import Axis, State
    from teleop.core.events import Tick
    from teleop.manual.live_offset import LiveOffset
    from teleop.sequence.trim_export import TrimmedFile

SHARE = "25%"
PATIENCE = 10.0  # s for the file at the end of a run


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
    """What the trim came to, and its file: written when the operator asks for it, else at the end.

    As a watcher of the run it tells the operator when the file is written. `failure` is why it was not, in a line, and
    "" as long as that has not happened.
    """

    def __init__(self, trimming: LiveOffset, file: TrimmedFile | None) -> None:
        self._trimming, self._file = trimming, file
        self._written: Future[None] | None = None
        self._untold: Future[None] | None = None  # to the operator
        self.failure = ""

    @property
    def keep(self) -> Callable[[], str] | None:
        """For the operator's key; None without a file."""
        return self._write if self._file else None

    def facts(self) -> Iterator[tuple[str, object]]:
        offsets = {axis.value: round(state.position, 6) for axis, state in self._trimming.offsets.items()}
        file = self._finished()
        yield "trim", {"offsets": offsets, "file": file, "trouble": self.failure}

    def print(self) -> None:
        offsets = self._trimming.offsets.items()
        words = [f"{axis} {o.position + 0.0:+.3f} {axis.unit}".rstrip() for axis, o in offsets]
        file = self._finished()
        print(f"trim: {', '.join(words)}{f'; written to {file}' if file else ''}")
        if self.failure:
            print(f"teleop: {self.failure}", file=sys.stderr)

    def _write(self) -> str:
        """Begin to write the trim as it is now; neither the control thread nor the program's end waits for a disk."""
        assert self._file is not None
        self._written = self._untold = _in_background(self._file.write, dict(self._trimming.offsets), self._written)
        return f"writing the trim to {self._file.target}"

    def write(self, tick: Tick) -> None:  # noqa: ARG002 - as a watcher: whether the file is there by now
        if self._file is None or self._untold is None or not self._untold.done():
            return
        done, self._untold = self._untold, None
        self._trimming.say(self._failure(done) or f"the trim is written to {self._file.target}")

    def release(self, now: float) -> float | None:  # noqa: ARG002 - nothing was taken over
        return None

    def _failure(self, written: Future[None]) -> str:
        try:
            error = written.exception(PATIENCE)
        except TimeoutError:
            return f"{'' if self._file is None else self._file.target}: cannot be written: the disk does not answer"
        if error is None or self._file is None:
            return ""
        return str(error) if isinstance(error, TeleopError) else f"{self._file.target}: cannot be written: {error}"

    def _finished(self) -> str | None:
        """The file, once it is written; None where there is none, or it could not be."""
        if self._file is None:
            return None
        if self._written is None:
            self._write()
        assert self._written is not None
        self.failure = self._failure(self._written)
        return None if self.failure else str(self._file.target)


def _in_background(
    write: Callable[[Mapping[Axis, State]], None], offsets: Mapping[Axis, State], after: Future[None] | None
) -> Future[None]:
    """Call `write`, once `after` is over, in a thread that ends with the program whatever the disk does.

    An executor's thread would be waited for.
    """
    future: Future[None] = Future()

    def work() -> None:
        try:
            if after is not None:
                after.exception()
            write(offsets)
        except BaseException as error:  # noqa: BLE001 - whatever it is, the one who asks for the result gets it
            future.set_exception(error)
        else:
            future.set_result(None)

    Thread(target=work, name="trim", daemon=True).start()
    return future


NO_TRIM = TrimOptions()

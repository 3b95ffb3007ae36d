"""Writes the sequence with the operator's trim in its keys: when the operator asks for it, else at the end."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from concurrent.futures import Future
from functools import partial
from typing import TYPE_CHECKING

from teleop.app.background import in_background
from teleop.core.errors import TeleopError

if TYPE_CHECKING:
    from teleop.core.axes import Axis, State
    from teleop.core.events import Tick
    from teleop.manual.live_offset import LiveOffset
    from teleop.sequence.trim_export import TrimmedFile

WRITE_TIMEOUT = 10.0  # s for the file at the end of a run


class TrimWriter:
    """Observes a run to tell the operator when the file is written; `file` is None where none is asked for.

    `failure` is why it was not written, in a line, and "" as long as that has not happened.
    """

    def __init__(self, trimming: LiveOffset, file: TrimmedFile | None) -> None:
        self._trimming, self._file = trimming, file
        self._written: Future[None] | None = None
        self._unreported: Future[None] | None = None  # to the operator
        self.failure = ""

    @property
    def offsets(self) -> Mapping[Axis, State]:
        """The trim of each axis as it is now, in units."""
        return self._trimming.offsets

    @property
    def keep(self) -> Callable[[], str] | None:
        """For the operator's key; None without a file."""
        return self._write if self._file else None

    def observe(self, tick: Tick) -> None:  # noqa: ARG002 - to see whether the file is there by now
        if self._file is None or self._unreported is None or not self._unreported.done():
            return
        done, self._unreported = self._unreported, None
        self._trimming.notify(self._failure(done) or f"the trim is written to {self._file.target}")

    def finish(self) -> str | None:
        """The file, once it is written; None where there is none, or it could not be: see `failure`."""
        if self._file is None:
            return None
        if self._written is None:
            self._write()
        assert self._written is not None
        self.failure = self._failure(self._written)
        return None if self.failure else str(self._file.target)

    def _write(self) -> str:
        """Begin to write the trim as it is now; neither the control thread nor the program's end waits for a disk."""
        assert self._file is not None
        self._written = self._unreported = in_background(
            partial(self._file.write, dict(self.offsets)), self._written, "trim"
        )
        return f"writing the trim to {self._file.target}"

    def _failure(self, written: Future[None]) -> str:
        try:
            error = written.exception(WRITE_TIMEOUT)
        except TimeoutError:
            return f"{'' if self._file is None else self._file.target}: cannot be written: the disk does not answer"
        if error is None or self._file is None:
            return ""
        return str(error) if isinstance(error, TeleopError) else f"{self._file.target}: cannot be written: {error}"

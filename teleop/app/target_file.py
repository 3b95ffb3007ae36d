"""The `targets:` of a sequence file, written while a rig is in an operator's hands; the rest of the file stays."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import Future
from pathlib import Path

from teleop.app.background import in_background
from teleop.config.documents.document import mapping
from teleop.config.documents.yaml_edit import edited
from teleop.config.documents.yaml_loader import parse_document, read_document
from teleop.config.files import check_place, write_text
from teleop.core.errors import TeleopError
from teleop.core.events import Tick
from teleop.planner.aim import Point
from teleop.sequence.model import SequenceModel

WRITE_TIMEOUT = 5.0  # s to wait at the end for a disk that does not answer
_NEW = "# Targets that teleop live marked. Add keyframes that aim at them.\ntargets: {}\n"


class TargetFile:
    """Observes a run to tell the operator, by `notify`, what is not written. `file` need not exist yet.

    `height` is that of the camera by the file's `mount`, in m. Raises DocumentError for a file that is no sequence,
    OutputError where it cannot be written.
    """

    def __init__(self, file: Path) -> None:
        self._file, self._text = file, _NEW
        self.notify: Callable[[str], object] = lambda _text: None
        check_place(file)
        document = parse_document(_NEW, str(file))
        if file.exists():
            document, self._text = read_document(file), file.read_bytes().decode()
        self.height = document.check(SequenceModel).mount.height
        self._data = dict(mapping(document.data))
        self._written: Future[None] | None = None

    def add(self, name: str, place: Point) -> None:
        """Write the file with this target, in the background, in the place of one of the same name."""
        self._data["targets"] = {**mapping(self._data, "targets"), name: list(place)}
        data = dict(self._data)

        def write() -> None:
            self._text = edited(self._text, data, str(self._file))
            write_text(self._file, self._text)

        self._written = in_background(write, self._written, "targets")

    def observe(self, tick: Tick) -> None:  # noqa: ARG002 - to see whether the file is there by now
        if self._written is not None and self._written.done():
            self._report(self._written)

    def close(self) -> None:
        """Wait for what is being written, but not for ever."""
        if self._written is not None:
            self._report(self._written)

    def _report(self, written: Future[None]) -> None:
        try:
            error = written.exception(WRITE_TIMEOUT)
        except TimeoutError:
            self.notify(f"targets are not saved: {self._file}: the disk does not answer")
            return
        self._written = None
        if error is not None:
            text = str(error) if isinstance(error, TeleopError) else f"{self._file}: {error}"
            self.notify(f"targets are not saved: {text}")

"""Any capture, read frame by frame: the first bytes of the file say whether it is MCAP or text of candump."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from teleop.captures import candump, mcap_format
from teleop.captures.captured import Captured, CaptureError, Source
from teleop.config.documents.document import DocumentError
from teleop.recording.records import Progress, whole_records


def read(path: Path) -> Iterator[tuple[Source, Captured]]:
    """Each frame with where it was captured; several interfaces may be in one file. A cut file is read to its cut.

    Raises CaptureError when it cannot be read, or is no capture.
    """
    try:
        with path.open("rb") as stream:
            is_mcap = stream.read(len(mcap_format.MAGIC)) == mcap_format.MAGIC
        yield from _mcap(path) if is_mcap else _candump(path)
    except OSError as error:
        raise CaptureError(f"{path}: cannot be read: {error.strerror or error}") from None


def _candump(path: Path) -> Iterator[tuple[Source, Captured]]:
    sources: dict[str, Source] = {}
    with path.open(encoding="ascii", errors="replace") as lines:
        for name, frame in candump.frames(lines, str(path)):
            yield sources.setdefault(name, Source("can", name)), frame


def _mcap(path: Path) -> Iterator[tuple[Source, Captured]]:
    try:
        yield from mcap_format.messages(whole_records(path, Progress()), str(path))
    except DocumentError:
        raise CaptureError(f"{path}: damaged: nothing in it can be read") from None

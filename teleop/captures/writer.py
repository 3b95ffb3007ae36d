"""A capture as it grows: every line or record in the file is whole, whenever its writer is killed.

What has arrived is written by `flush`, in one call of the system, so memory does not grow with time. A disk that takes
only a part of it gets the file cut back to its last whole line.
"""

from __future__ import annotations

import io
from importlib.metadata import version
from pathlib import Path
from typing import IO, cast

from teleop.captures import candump
from teleop.captures.captured import Captured, CaptureError, Source
from teleop.captures.mcap_format import McapWriter
from teleop.config.files import OutputError, check_place, is_stream
from teleop.recording import ENDING

CANDUMP_ENDINGS = ".log", ".candump"
_LARGEST = 1 << 20  # bytes that wait for a flush, at most


def check_file(option: str, path: Path, source: Source, overwrite: bool) -> None:
    """Raises CaptureError where a capture of `source` cannot be in this file, OutputError where nothing can."""
    ending = path.suffix.lower()
    if ending not in (ENDING, *CANDUMP_ENDINGS):
        raise CaptureError(f"{option} {path}: its ending must be {', '.join(CANDUMP_ENDINGS)} (candump) or {ENDING}")
    if source.kind == "serial" and ending != ENDING:
        raise CaptureError(f"{option} {path}: candump has CAN frames only; a serial line is recorded as {ENDING}")
    if path.exists() and not (overwrite or is_stream(path)):
        raise CaptureError(f"{option} {path}: already exists; give --overwrite to replace it")
    check_place(path)


class CaptureWriter:
    """A new file at `path`, of the format that its ending says. Every call may raise OutputError.

    `count` is the number of frames that were given to it.
    """

    def __init__(self, path: Path, source: Source) -> None:
        self.path, self.count = path, 0
        self._source = source
        try:
            is_mcap = path.suffix.lower() == ENDING
            self._stream = _WholeWrites(io.FileIO(path, "w"), in_lines=not is_mcap)
            self._mcap = McapWriter(cast(IO[bytes], self._stream), source, version("rs-teleop")) if is_mcap else None
        except OSError as error:
            raise self._trouble(error) from None

    def add(self, frame: Captured) -> None:
        """Written at the next `flush`."""
        self.count += 1
        if self._mcap:
            self._mcap.add(frame)
        else:
            self._stream.write(candump.line(frame, self._source.interface).encode())
        if self._stream.waiting > _LARGEST:
            self.flush()

    def flush(self) -> None:
        """What was added is in the file."""
        try:
            self._stream.flush_out()
        except OSError as error:
            raise self._trouble(error) from None

    def close(self) -> None:
        """Complete the file; a disk that is full leaves it as it is."""
        try:
            if self._mcap and not self._stream.failed:
                self._mcap.finish()
            self._stream.flush_out()
        except OSError as error:
            raise self._trouble(error) from None
        finally:
            self._stream.shut()

    def _trouble(self, error: OSError) -> OutputError:
        return OutputError(self.path, error.strerror or str(error))


class _WholeWrites:
    """Bytes that go to `raw` all at once; `tell` counts those of the file."""

    def __init__(self, raw: io.FileIO, in_lines: bool) -> None:
        self._raw, self._in_lines, self._written = raw, in_lines, 0
        self._parts: list[bytes] = []
        self.waiting = 0  # bytes
        self.failed = False

    def write(self, data: bytes) -> int:
        self._parts.append(bytes(data))
        self.waiting += len(data)
        return len(data)

    def tell(self) -> int:
        return self._written + self.waiting

    def flush(self) -> None:
        """Does nothing: what a library flushes may be half of what belongs together."""

    def flush_out(self) -> None:
        """Raises OSError; the file then ends as it did before, where it can be cut back."""
        data, self._parts, self.waiting = b"".join(self._parts), [], 0
        if not data or self.failed:
            return
        rest = memoryview(data)
        try:
            while rest:
                rest = rest[self._raw.write(rest) or 0 :]
        except OSError:
            self.failed = True
            self._cut_back(data[: len(data) - len(rest)])
            raise
        self._written += len(data)

    def shut(self) -> None:
        self._raw.close()

    def _cut_back(self, taken: bytes) -> None:
        """Keep the whole lines of what the disk has taken; of records nothing."""
        if self._raw.seekable():
            self._raw.truncate(self._written + (taken.rfind(b"\n") + 1 if self._in_lines else 0))

"""Every file that the program writes whole is written here: complete or not at all, with the user's umask.

The content goes into a new file in the same directory, is put on the disk, and then takes the old one's place, because
a rename is atomic only within one file system. The new file has no name until then where the system can do that
(O_TMPFILE), so that even kill -9 leaves nothing behind. A file that is replaced keeps its mode and owner, a symbolic
link stays one. A FIFO, a device or /dev/stdout cannot be replaced: those are written as the bytes come.

A take (sinks/recorder.py) and the journal of a timelapse are not written here: they grow during a run, and what is in
them after a power cut is what they are for.
"""

from __future__ import annotations

import errno
import io
import os
import re
import secrets
import stat
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING, BinaryIO, cast

from teleop.core.errors import TeleopError

if TYPE_CHECKING:
    from typing_extensions import Buffer

_STANDARD = {"/dev/stdout": 1, "/dev/stderr": 2}
_DESCRIPTOR = re.compile(r"/(?:dev|proc/self)/fd/(\d+)")


class OutputError(TeleopError):
    """A file cannot be written where it was asked for; `reason` is why, in a few words."""

    def __init__(self, path: Path, reason: str) -> None:
        super().__init__(f"{path}: cannot be written: {reason}")
        self.reason = reason


@contextmanager
def replacing(path: Path) -> Iterator[BinaryIO]:
    """A stream whose content is at `path` once the block ends without an error; else `path` is as it was.

    Raises OutputError when the place cannot be written or the disk is full; BrokenPipeError passes through.
    """
    try:
        with _opened(path) as stream:
            yield stream
    except BrokenPipeError:  # the reader of a pipe has what it needs and has left
        raise
    except OSError as error:
        raise OutputError(path, error.strerror or str(error)) from None


def write_text(path: Path, text: str) -> None:
    """Write `text` as UTF-8, its line ends as they are. Raises OutputError."""
    with replacing(path) as stream:
        stream.write(text.encode())


def check_place(path: Path) -> None:
    """Raises OutputError where it is known beforehand that nothing can be written; tries nothing."""
    target = Path(os.path.realpath(path))
    if is_stream(path):
        return
    if target.is_dir():
        raise OutputError(path, "it is not a file")
    if not target.parent.is_dir():
        raise OutputError(path, os.strerror(errno.ENOENT))
    if not os.access(target.parent, os.W_OK | os.X_OK):
        raise OutputError(path, "its directory is not writable")
    if target.exists() and not os.access(target, os.W_OK):
        raise OutputError(path, "it is read-only")


def is_stream(path: Path) -> bool:
    """Whether `path` is a FIFO, a device or an open descriptor, which takes bytes and cannot be replaced."""
    if _descriptor(path) is not None:
        return True
    try:
        mode = path.stat().st_mode
    except OSError:
        return False
    return not (stat.S_ISREG(mode) or stat.S_ISDIR(mode))


def is_stdout(path: Path) -> bool:
    """Whether what is written to `path` comes out at standard output, where other words would spoil it."""
    return _descriptor(path) == 1


@contextmanager
def _opened(path: Path) -> Iterator[BinaryIO]:
    descriptor = _descriptor(path)
    if descriptor is not None:
        (sys.stderr if descriptor == 2 else sys.stdout).flush()  # what was printed before comes before
        with _Stream(io.FileIO(os.dup(descriptor), "wb")) as stream:
            yield stream
        return
    if is_stream(path):
        with _Stream(io.FileIO(path, "wb")) as stream:
            yield stream
        return
    with _replacement(Path(os.path.realpath(path))) as stream:
        yield stream


class _Stream(io.BufferedWriter):
    """A pipe or a device, which cannot say where it is: the bytes written are counted."""

    def __init__(self, raw: io.FileIO) -> None:
        super().__init__(raw)
        self._count = 0

    def write(self, data: Buffer, /) -> int:
        count = super().write(data)
        self._count += count
        return count

    def tell(self) -> int:
        return self._count


@contextmanager
def _replacement(target: Path) -> Iterator[BinaryIO]:
    """A new file that takes the place of `target`. Raises OSError."""
    try:
        before = target.stat()
    except FileNotFoundError:
        before = None
    if before and not os.access(target, os.W_OK):
        raise PermissionError(0, "it is read-only")
    if target.is_dir():
        raise IsADirectoryError(0, "it is not a file")
    name = target.with_name(f".teleop-{secrets.token_hex(8)}.part")
    with _created(name) as stream:
        try:
            yield stream
            stream.flush()
            if before:
                with suppress(OSError, AttributeError):  # another's file becomes its writer's where the system insists
                    os.fchown(stream.fileno(), before.st_uid, before.st_gid)
                with suppress(AttributeError):  # Windows has neither
                    os.fchmod(stream.fileno(), stat.S_IMODE(before.st_mode))
            os.fsync(stream.fileno())
            if not name.exists():  # it has none yet
                _give_name(stream, name)
            stream.close()  # Windows renames no open file
            name.replace(target)
        except BaseException:  # an interrupt too leaves nothing behind
            name.unlink(missing_ok=True)
            raise
    _settle(target.parent)


def _created(name: Path) -> BinaryIO:
    """A new file to be called `name`: without a name for now, where the system can do that."""
    unnamed = getattr(os, "O_TMPFILE", None)
    if unnamed is not None and Path("/proc/self/fd").is_dir():
        with suppress(OSError):  # a file system that cannot; what is wrong with the place is reported below
            descriptor = os.open(name.parent, unnamed | os.O_WRONLY | os.O_CLOEXEC, 0o666)
            return cast(BinaryIO, open(descriptor, "wb"))
    return name.open("xb")


def _give_name(stream: BinaryIO, name: Path) -> None:
    # With a directory's descriptor Python asks for linkat, which follows the link in /proc; the path is absolute.
    os.link(f"/proc/self/fd/{stream.fileno()}", name, src_dir_fd=stream.fileno(), follow_symlinks=True)


def _settle(directory: Path) -> None:
    """Have the new name on the disk too, where a directory can be synced."""
    with suppress(OSError):
        descriptor = os.open(directory, os.O_RDONLY)
        try:
            os.fsync(descriptor)
        finally:
            os.close(descriptor)


def _descriptor(path: Path) -> int | None:
    """The open descriptor that `path` names, as /dev/stdout does."""
    text = os.path.abspath(path)
    if text in _STANDARD:
        return _STANDARD[text]
    match = _DESCRIPTOR.fullmatch(text)
    return int(match[1]) if match else None

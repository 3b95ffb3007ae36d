"""Files that are there whole or not at all: written beside their place, then renamed onto it.

The temporary file is in the same directory, as a rename is only atomic within a file system. What is not a plain file
(a directory, /dev/null) is refused, because a rename would replace it.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import BinaryIO

from teleop.ports import TeleopError


class OutputError(TeleopError):
    """A file cannot be written where it was asked for."""


@contextmanager
def replacing(path: Path) -> Iterator[BinaryIO]:
    """A stream whose content is at `path` once the block ends without an error; else `path` is as it was.

    Raises OutputError when the place cannot be written or the disk is full.
    """
    target = path.resolve()
    if target.exists() and not target.is_file():
        raise OutputError(f"{path}: cannot be written: it is not a file")
    temporary = target.with_name(f".{target.name}.{os.getpid()}.part")
    try:
        with temporary.open("xb") as stream:
            try:
                yield stream
                stream.flush()
                temporary.replace(target)
            except BaseException:  # an interrupt too leaves nothing behind
                temporary.unlink(missing_ok=True)
                raise
    except OSError as error:
        raise OutputError(f"{path}: cannot be written: {error.strerror or error}") from None

"""Files that this program has made from others, and may make again: a preview replaces a preview, and nothing else."""

from __future__ import annotations

from pathlib import Path

from teleop.config.files import is_stream
from teleop.core.errors import UsageError

HEAD = 4096  # bytes in which a file says what wrote it
MARKS = {
    ".html": b'<meta name="generator" content="teleop',
    ".svg": b"teleop",
    ".png": b"teleop",
    ".csv": b"time,",
}


def check_own(path: Path) -> None:
    """Raises UsageError where a file of that name exists that is not empty, and not one that teleop wrote."""
    if is_stream(path) or not path.is_file():
        return
    try:
        with path.open("rb") as stream:
            head = stream.read(HEAD)
    except OSError:
        return  # why it cannot be written is said when that is tried
    mark = MARKS.get(path.suffix.lower(), MARKS[".csv"])
    if head and mark not in head:
        raise UsageError(f"{path}: exists, and teleop did not write it; choose another name, or delete it")

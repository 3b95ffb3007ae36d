"""Where the door of a run is: a folder of its own, for this user alone, with the ring and the socket in it."""

from __future__ import annotations

import os
import stat
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from shutil import rmtree
from typing import NamedTuple

PREFIX = "teleop-"
MEMORY = "/dev/shm"  # of Linux: a folder that is on no disk


class DoorAddress(NamedTuple):
    """The folder of a door. Names in it are short: macOS gives the path of a socket 104 bytes."""

    folder: Path

    @property
    def ring(self) -> Path:
        return self.folder / "ring"

    @property
    def commands(self) -> str:
        """The socket that the control process takes commands from."""
        return str(self.folder / "door")

    def client(self, number: int) -> str:
        """A socket for the answers to a client, which is the process with this number."""
        return str(self.folder / f"c{number}")

    def sent(self, number: int) -> Path:
        """A folder for one move that a client has sent as text."""
        return self.folder / "sent" / str(number)


@contextmanager
def new_door() -> Iterator[DoorAddress]:
    """A folder (mode 0700) for the door of this run, removed with all that is in it afterwards."""
    folder = Path(tempfile.mkdtemp(prefix=PREFIX, dir=_runtime_folder()))
    try:
        yield DoorAddress(folder)
    finally:
        rmtree(folder, ignore_errors=True)


def _runtime_folder() -> str | None:
    """`$XDG_RUNTIME_DIR` where it is this user's alone, else memory; None is the system's place for temporary files.

    On a disk a write to a mapped page waits now and then for the disk: the loop stalled for 0.28 s by that.
    """
    if not hasattr(os, "getuid"):  # Windows, where that place is in the folder of the user
        return None
    named = os.environ.get("XDG_RUNTIME_DIR", "")
    try:
        found = os.stat(named) if os.path.isabs(named) else None
    except OSError:
        found = None
    if found is None or not stat.S_ISDIR(found.st_mode) or found.st_uid != os.getuid() or found.st_mode & 0o077:
        return MEMORY if os.path.isdir(MEMORY) and os.access(MEMORY, os.W_OK) else None
    return named

"""The files of one folder by their names. A name is never a path; a link that leads out of the folder is no file."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

NAME = re.compile(r"\w[\w. -]{0,99}")  # no separator, and nothing that begins with a point
MOST_FILES = 1000  # of a folder, that are listed


@dataclass(frozen=True)
class NamedFiles:
    """Files of `folder` with one of these `endings`; their names are without it."""

    folder: Path
    endings: Sequence[str]

    def find(self, name: str) -> Path | None:
        """The file of this name, None where there is none."""
        if not NAME.fullmatch(name):
            return None
        for candidate in (name, *(name + ending for ending in self.endings)):
            path = self.folder / candidate
            if path.suffix.lower() in self.endings and self._is_inside(path):
                return path
        return None

    def place(self, name: str) -> Path | None:
        """Where a new file of this name goes; None for what is no name, or where something else is."""
        if not NAME.fullmatch(name) or name != name.strip():
            return None
        path = self.folder / (name if Path(name).suffix.lower() in self.endings else name + self.endings[0])
        return None if path.exists() or path.is_symlink() else path

    def files(self) -> Iterator[Path]:
        """Every file, by name; nothing where the folder cannot be read."""
        with suppress(OSError):
            found = sorted(each for each in self.folder.iterdir() if each.suffix.lower() in self.endings)
            for path in found[:MOST_FILES]:
                if NAME.fullmatch(path.name) and self._is_inside(path):
                    yield path

    def _is_inside(self, path: Path) -> bool:
        try:
            return path.is_file() and path.resolve().parent == self.folder.resolve()
        except (OSError, RuntimeError):  # a circle of links
            return False

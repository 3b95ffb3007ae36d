"""The file of a rig that is read to be written again, with what was learned or found in it."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from teleop.config.documents.yaml_loader import parse_document
from teleop.config.files import OutputError
from teleop.config.resources import described, find, folder, is_bare
from teleop.core.errors import UsageError


class RigFile:
    """`rig` is what was asked for. `is_shipped`: it comes with the program, and is never written.

    Raises DocumentError where there is no such rig.
    """

    def __init__(self, rig: str) -> None:
        self.source, self.name = find(rig, "profiles", "rig")
        self.is_shipped = is_bare(rig) or _is_shipped(self.source)

    def text(self) -> str:
        """Raises OutputError."""
        try:
            return self.source.read_bytes().decode("utf-8")
        except (OSError, UnicodeDecodeError) as error:
            raise OutputError(self.source, f"it cannot be read any more: {error}") from None

    def data(self, text: str) -> Any:
        """What is in its text. Raises DocumentError."""
        return parse_document(text.removeprefix("\ufeff"), self.name).data


def check_target(file: Path) -> None:
    """Raises UsageError for a file that is never written."""
    if _is_shipped(file):
        raise UsageError(f"{file}: a shipped rig is never written: choose another file with -o")


def _is_shipped(file: Path) -> bool:
    shipped = folder("profiles").resolve()
    return file.resolve().parent == shipped and file.stem in described("profiles")

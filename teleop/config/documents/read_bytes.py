"""Reads a user's file whole, but no more of it than is sane."""

from __future__ import annotations

from pathlib import Path

from teleop.config.documents.document import DocumentError
from teleop.config.files_read import note


def read_bytes(file: Path, name: str, most: int) -> bytes:
    """What is in `file`, which errors call `name`. Raises DocumentError where it cannot be read, or has over `most`."""
    note(file)
    try:
        with file.open("rb") as stream:
            raw = stream.read(most + 1)
    except OSError as error:
        raise DocumentError([f"{name}: cannot be read: {error.strerror or error}"]) from None
    if len(raw) > most:
        raise DocumentError([f"{name}:1:1: is larger than {most // 1_000_000} MB"])
    return raw

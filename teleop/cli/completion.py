"""What the tab key offers where a shipped file's name or a path may be typed."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

from teleop.config.resources import described


def offered(kind: str, *endings: str) -> Callable[[Any], list[tuple[str, str]]]:
    """A completer for the shipped files of a kind, with what they are, and for paths with these endings."""

    def complete(context: Any) -> list[tuple[str, str]]:
        begun = context.incomplete
        folder, slash, _ = begun.rpartition("/")
        paths = sorted(Path(f"{folder}{slash}" or ".").expanduser().glob("*"))
        found = [
            (f"{folder}{slash}{path.name}{'/' if path.is_dir() else ''}", "")
            for path in paths
            if path.is_dir() or path.suffix.lower() in endings
        ]
        return [*described(kind).items(), *found]

    return complete

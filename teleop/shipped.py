"""Finds the profiles and sequences that come with the program.

A bare name is looked up among them; whatever has a directory or an ending is a path, and only a path. In an
installed package they lie inside it, in a checkout beside it.
"""

from __future__ import annotations

from pathlib import Path

from teleop.document import DocumentError
from teleop.phrases import nearest

_PACKAGE = Path(__file__).parent


def folder(kind: str) -> Path:
    """Where the shipped files of a kind (`profiles`, `sequences`) lie."""
    installed = _PACKAGE / "data" / kind
    return installed if installed.is_dir() else _PACKAGE.parent / kind


def find(name: str, kind: str, word: str) -> tuple[Path, str]:
    """The file for a bare name or a path, and what to call it in errors; raises DocumentError when there is none."""
    if Path(name).name != name or Path(name).suffix:
        path = Path(name).expanduser()
        if not path.is_file():
            raise DocumentError([f"{name}: no such file"])
        return path, name
    names = sorted(file.stem for file in folder(kind).glob("*.yaml"))
    if name not in names:
        near = nearest(name, names) or f"; there are {', '.join(names)}"
        raise DocumentError([f"{name}: no {word} of that name is shipped{near}; a file needs its ending, {name}.yaml"])
    path = folder(kind) / f"{name}.yaml"
    return path, path.name

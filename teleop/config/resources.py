"""Finds the profiles and sequences that come with the program.

A bare name is looked up among them; whatever has a directory or an ending is a path, and only a path. In an
installed package they lie inside it, in a checkout beside it.
"""

from __future__ import annotations

from pathlib import Path

from teleop.config.documents.document import DocumentError
from teleop.config.documents.messages import nearest
from teleop.config.files_read import note

_PACKAGE = Path(__file__).parents[1]


def folder(kind: str) -> Path:
    """Where the shipped files of a kind (`profiles`, `sequences`) lie."""
    installed = _PACKAGE / "data" / kind
    return installed if installed.is_dir() else _PACKAGE.parent / kind


def described(kind: str) -> dict[str, str]:
    """The name of each shipped file of a kind, and what it is: the comment in its first line."""
    lines = {}
    for file in sorted(folder(kind).glob("*.yaml")):
        with file.open(encoding="utf-8") as stream:
            lines[file.stem] = stream.readline().removeprefix("#").strip().removesuffix(".")
    return lines


def is_bare(name: str) -> bool:
    """Whether it is a shipped file's name, and no path."""
    return Path(name).name == name and not Path(name).suffix


def find(name: str, kind: str, word: str, beside: Path | None = None) -> tuple[Path, str]:
    """The file for a bare name or a path, and what to call it in errors; raises DocumentError when there is none.

    A relative path begins at the folder `beside`, the current one unless given.
    """
    if not is_bare(name):
        path = (beside or Path()) / Path(name).expanduser()
        if not path.is_file():
            note(path)
            raise DocumentError([f"{name}: {'is no file' if path.exists() else 'no such file'}"])
        return path, name
    names = sorted(file.stem for file in folder(kind).glob("*.yaml"))
    if name not in names:
        near = nearest(name, names) or f"; there are {', '.join(names)}"
        raise DocumentError([f"{name}: no {word} of that name is shipped{near}; a file needs its ending, {name}.yaml"])
    path = folder(kind) / f"{name}.yaml"
    return path, path.name

"""The moves that a client can name: files of one folder, and shipped ones. A path is never taken from a request."""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

from teleop.config.documents.document import DocumentError, mapping, sequence
from teleop.config.documents.messages import nearest
from teleop.config.documents.yaml_loader import read_document
from teleop.config.named_files import NAME, NamedFiles
from teleop.config.resources import described, is_bare
from teleop.core.errors import TeleopError, UsageError

ENDINGS = (".yaml", ".yml", ".mcap")


class Sent(NamedTuple):
    """A move that a client has sent as text, which is in this file now. The files that it names were not sent."""

    file: Path


def move_file(name: str, folder: Path) -> str:
    """What a move of this name is for the planner. Raises TeleopError for one that is neither here nor shipped."""
    if not NAME.fullmatch(name):
        raise TeleopError(f"{name!r} is not the name of a move")
    files = NamedFiles(folder, ENDINGS)
    if (own := files.find(name)) is not None:
        return str(own)
    if name in described("sequences"):
        return name
    near = nearest(name, [*described("sequences"), *(path.stem for path in files.files())])
    raise TeleopError(f"there is no move {name!r} in the folder of moves, and none is shipped{near}")


def refuse_files(file: Path) -> None:
    """Raises TeleopError where the move in `file`, which is sent, needs another file, which is not; or has a tag."""
    document = read_document(file)
    if flaws := document.flawed():
        raise DocumentError(flaws)
    for entry in sequence(document.data, "include"):
        name = mapping(entry).get("move")
        if isinstance(name, str) and not is_bare(name):
            raise UsageError(f"it includes the file {name[:80]}, which is not sent: include shipped moves only")
    if (name := mapping(document.data, "source").get("file")) is not None:
        raise UsageError(f"its rows are in {str(name)[:80]}, which is not sent: give keyframes")

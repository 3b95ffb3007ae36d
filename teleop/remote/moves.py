"""The moves that a client can name: files of one folder, and shipped ones. A path is never taken from a request."""

from __future__ import annotations

from pathlib import Path

from teleop.config.documents.messages import nearest
from teleop.config.named_files import NAME, NamedFiles
from teleop.config.resources import described
from teleop.core.errors import TeleopError

ENDINGS = (".yaml", ".yml", ".mcap")


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

"""The moves that a client can name: files of one folder, and shipped ones. A path is never taken from a request."""

from __future__ import annotations

import re
from pathlib import Path

from teleop.config.documents.messages import nearest
from teleop.config.resources import described
from teleop.core.errors import TeleopError

NAME = re.compile(r"\w[\w. -]*")
ENDINGS = (".yaml", ".yml", ".mcap")


def move_file(name: str, folder: Path) -> str:
    """What a move of this name is for the planner. Raises TeleopError for one that is neither here nor shipped."""
    if not NAME.fullmatch(name):
        raise TeleopError(f"{name!r} is not the name of a move")
    for candidate in (name, *(name + ending for ending in ENDINGS)):
        path = folder / candidate
        if path.suffix.lower() in ENDINGS and path.is_file() and path.resolve().parent == folder.resolve():
            return str(path)
    if name in described("sequences"):
        return name
    near = nearest(name, [*described("sequences"), *(path.stem for path in folder.glob("*.yaml"))])
    raise TeleopError(f"there is no move {name!r} in the folder of moves, and none is shipped{near}")

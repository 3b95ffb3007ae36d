"""The text of moves, read and changed in the console's worker: a large file takes seconds."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from teleop.config.documents.document import DocumentError, mapping
from teleop.config.documents.yaml_edit import edited
from teleop.config.documents.yaml_loader import parse_document, read_document
from teleop.config.file_kinds import kind_of
from teleop.sequence.timelapse_section import is_timelapse


def parse(text: str, name: str) -> dict[str, Any]:
    """The values of a move as `content`, None where the text has none, and the `problem` then."""
    try:
        return {"content": parse_document(text, f"{name}.yaml").data, "problem": ""}
    except DocumentError as error:
        return {"content": None, "problem": error.problems[0]}


def edit(text: str, content: Mapping[str, Any], name: str) -> dict[str, Any]:
    """The text with these values and its own comments, or the `error`."""
    try:
        return {"text": edited(text, content, f"{name}.yaml")}
    except DocumentError as error:
        return {"error": error.problems[0]}


def describe(file: str) -> dict[str, Any]:
    """Title and kind of a file: `move`, `timelapse`, or "" for one that is no sequence; `problem` of one unreadable."""
    path = Path(file)
    try:
        document = read_document(path, path.name)
    except DocumentError as error:
        return {"title": path.stem, "kind": "move", "problem": error.problems[0]}
    if kind_of(document.data) != "sequence":
        return {"title": "", "kind": "", "problem": ""}
    title = mapping(document.data).get("title")
    kind = "timelapse" if is_timelapse(document.data) else "move"
    return {"title": title if isinstance(title, str) else path.stem, "kind": kind, "problem": ""}

"""Comments of our own above a place in a YAML text, among those that an earlier run left there.

A line with a colon is about its first word, and replaces an earlier one about the same. One without is a heading, which
stays above earlier lines that are still true.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from teleop.config.documents.document import Location
from teleop.config.documents.yaml_edit import child
from teleop.config.documents.yaml_loader import MAX_DEPTH, MAX_NODES
from teleop.config.documents.yaml_nodes import compose


def with_notes(text: str, notes: Mapping[Location, Sequence[str]], mark: str) -> str:
    """`text` with the lines of `notes` as comments above each place; `mark` begins each comment of ours."""
    mark = f"# {mark}"
    for path, lines in notes.items():
        text = _noted(text, path, lines, mark)
    return text


def _noted(text: str, path: Location, notes: Sequence[str], mark: str) -> str:
    line = _line_of(text, path)
    if line is None or not notes:
        return text
    lines = text.splitlines(keepends=True)
    first = line
    while first > 0 and lines[first - 1].strip().startswith(mark):
        first -= 1
    end = "\r\n" if lines[line].endswith("\r\n") else "\n"
    indent = lines[line][: len(lines[line]) - len(lines[line].lstrip(" "))]
    earlier = [each.strip().removeprefix(mark).removeprefix(":").strip() for each in lines[first:line]]
    comments = [f"{indent}{mark}: {note}{end}" for note in (*notes, *_still_true(earlier, notes))]
    return "".join([*lines[:first], *comments, *lines[line:]])


def _still_true(earlier: Sequence[str], notes: Sequence[str]) -> list[str]:
    """The earlier notes about what the new ones say nothing of, each below its heading."""
    known = {note.partition(" ")[0] for note in notes if ": " in note}
    kept, heading = list[str](), list[str]()
    for note in earlier:
        if ": " not in note:
            heading = [note]
        elif note.partition(" ")[0] not in known:
            kept += [*heading, note]
            heading = []
    return kept


def _line_of(text: str, path: Location) -> int | None:
    """The line, from 0, in which the key or the entry at `path` begins; None for one that is not there."""
    node: Any = compose(text.removeprefix("\ufeff"), MAX_DEPTH, MAX_NODES)
    begin = node
    for step in path:
        key, node = child(node, step)
        if node is None:
            return None
        begin = key or node
    return begin.start_mark.line

"""A trim made part of a sequence: its file once more, with the keys moved, under another name.

Only the numbers of the keys are written anew, in the text as it stands, so that comments, order and everything else of
the file survive. What is no plain number there (an alias, a key that a cue or another file makes) is refused before the
run: a trim that could not be kept is not to be found out at its end.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

from teleop.config.documents.document import Document, DocumentError, Location, mapping, number, sequence
from teleop.config.documents.yaml_loader import read_document
from teleop.config.files import check_place, is_stream, write_text
from teleop.config.resources import find
from teleop.core.axes import Axis, Limits, State
from teleop.core.errors import UsageError
from teleop.sequence.written_values import decimal

PLACES = 4  # decimals of a key, in degrees or of 0..1: finer than any rig
_TOKEN = re.compile(r"[^\s,\]}#]+")
_MADE = ("include", "panorama", "source")  # sections from which keys are made that stand nowhere


class Number(NamedTuple):
    """A key's number in the text: from where to where, of which axis, and what it says."""

    start: int
    end: int
    axis: Axis
    value: float


class TrimmedFile:
    """The sequence called `name`, to be written to `target` with its keys moved by offsets within `limits`.

    Raises DocumentError where the keys cannot be rewritten, UsageError where `target` already exists, OutputError
    where it cannot be written.
    """

    def __init__(self, name: str, target: Path, axes: Sequence[Axis], limits: Mapping[Axis, Limits]) -> None:
        if target.exists() and not is_stream(target):
            raise UsageError(f"--trim-out {target}: already exists; choose another name")
        check_place(target)
        file, called = find(name, "sequences", "sequence")
        document = read_document(file, called)
        self.target, self._limits = target, limits
        self._text = file.read_bytes().decode("utf-8-sig")
        self._numbers = _numbers(document, self._text, axes)

    def text(self, offsets: Mapping[Axis, State]) -> str:
        """The file with the keys of each axis moved by its offset."""
        parts, end = [], 0
        for each in self._numbers:
            parts += [self._text[end : each.start], self._moved(each, offsets)]
            end = each.end
        return "".join([*parts, self._text[end:]])

    def write(self, offsets: Mapping[Axis, State]) -> None:
        """Write it whole or not at all. Raises OutputError."""
        write_text(self.target, self.text(offsets))

    def _moved(self, each: Number, offsets: Mapping[Axis, State]) -> str:
        offset = offsets[each.axis].position if each.axis in offsets else 0.0
        if not offset:
            return self._text[each.start : each.end]
        limits = self._limits[each.axis]
        moved = min(max(round(each.value + offset, PLACES), limits.minimum), limits.maximum)
        return decimal(moved, PLACES)


def _numbers(document: Document, text: str, axes: Sequence[Axis]) -> list[Number]:
    """Where the keys of the axes stand, in the order of the text."""
    starts = [0]
    for line in text.splitlines(keepends=True):
        starts.append(starts[-1] + len(line))
    problems = [
        document.problem((made,), "makes keys that no file has: --trim-out cannot move them", key=True)
        for made in _MADE
        if made in mapping(document.data)
    ]
    problems += [
        document.problem(("cues", index, "recenter"), "always goes to 0: --trim-out cannot move it")
        for index, cue in enumerate(sequence(document.data, "cues"))
        if "recenter" in mapping(cue)
    ]
    problems += [
        document.problem(("keyframes", index, "aim"), "gives its pan and tilt: --trim-out cannot move it")
        for index, frame in enumerate(sequence(document.data, "keyframes"))
        if "aim" in mapping(frame) and {Axis.PAN, Axis.TILT} & {*axes}
    ]
    found: dict[int, Number] = {}
    for index, frame in enumerate(sequence(document.data, "keyframes")):
        for axis in axes:
            value = number(mapping(frame).get(axis.value))
            if value is None:
                continue
            path: Location = ("keyframes", index, axis.value)
            line, column = document.places[path]
            start = starts[line - 1] + column - 1
            token = _TOKEN.match(text, start)
            if token is None or not _says(token[0], value) or start in found:
                problems.append(document.problem(path, "must be a plain number to be moved by --trim-out"))
            else:
                found[start] = Number(start, token.end(), axis, value)
    if problems:
        raise DocumentError(problems)
    return [found[start] for start in sorted(found)]


def _says(token: str, value: float) -> bool:
    try:
        return float(token) == value
    except ValueError:
        return False

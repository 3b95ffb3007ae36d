"""DFMoco's commands as lines of ASCII: pure, and as bounded as the maker's firmware.

A line is two letters and whole numbers. Ends of lines are CR, LF or both; what is sent ends with CR LF.
"""

from __future__ import annotations

import re
from typing import NamedTuple

LONGEST = 512  # characters of a line: go-motion of eight motors has 34 numbers
MOST_NUMBERS = 39
END = "\r\n"
PARSE_ERROR = "parse error"
PLAIN = ("hi", "ms", "sa", "go")
"""Commands without numbers; what follows them in the line is ignored."""
WITH_NUMBERS = ("mm", "mp", "sm", "jm", "im", "pr", "zm", "np", "bf")
GREATEST = 2**31 - 1
_ENDS = re.compile(rb"[\r\n]")
_NUMBER = re.compile(r"[+-]?\d{1,10}", re.ASCII)


class Line(NamedTuple):
    """A command with its numbers; None instead of them where they are none."""

    name: str
    numbers: tuple[int, ...] | None = ()


def parsed(line: bytes) -> Line | None:
    """The command that a line is; None for what is none, which is not answered."""
    text = line.decode("ascii", "replace").strip(" \t")
    name, rest = text[:2], text[2:]
    if name in PLAIN:
        return Line(name)
    if name not in WITH_NUMBERS:
        return None
    words = rest.replace("\t", " ").split(" ")
    first, words = words[0], [word for word in words if word]
    if first or len(words) > MOST_NUMBERS or not all(map(_NUMBER.fullmatch, words)):
        return Line(name, None)
    numbers = tuple(int(word) for word in words)
    return Line(name, numbers if all(-GREATEST <= each <= GREATEST for each in numbers) else None)


class LineReader:
    """Bytes as they arrive, to commands. Of a line that is too long only its beginning is kept: it has no numbers."""

    def __init__(self) -> None:
        self._rest = b""

    def feed(self, data: bytes) -> list[Line]:
        *whole, rest = _ENDS.split(data)
        found: list[Line] = []
        for part in whole:
            line, self._rest = self._joined(part), b""
            command = parsed(line)
            if command is not None:
                is_long = len(line) > LONGEST and command.name in WITH_NUMBERS
                found.append(Line(command.name, None) if is_long else command)
        self._rest = self._joined(rest)
        return found

    def _joined(self, part: bytes) -> bytes:
        return (self._rest + part[: LONGEST + 1])[: LONGEST + 1]

"""Tables on stdout: a row is one line of the terminal, and never wrapped; a narrow terminal loses columns.

Into a pipe or a file a table has all its columns, as wide as they are. Drawn here, because loading what else could
draw it takes a tenth of `teleop check`.
"""

from __future__ import annotations

import os
import shutil
import sys
from collections.abc import Collection, Iterable, Iterator, Sequence
from typing import NamedTuple

from rich.cells import cell_len, set_cell_size

from teleop.core.plain import plain

BESIDE = 3  # cells of a column beside its text: a line and two blanks
FEWEST = 2  # columns


class _Lines(NamedTuple):
    """What a table is drawn with: left end, line, crossing and right end; and what is between the columns."""

    top: str
    head: str
    below_head: str
    row: str
    bottom: str
    cut: str


UNICODE = _Lines("┏━┳┓", "┃", "┡━╇┩", "│", "└─┴┘", "…")
ASCII = _Lines("+-++", "|", "+-++", "|", "+-++", "~")


def print_table(
    title: str,
    headings: Sequence[str],
    rows: Iterable[Sequence[str]],
    words: Collection[str] = (),
    drop: Sequence[str] = (),
) -> None:
    """`words` are the columns of words, all others are numbers; `drop` the columns that go first, in this order."""
    cells = [list(map(plain, row)) for row in rows]
    widths = [max(cell_len(row[index]) for row in [headings, *cells]) for index in range(len(headings))]
    room = shutil.get_terminal_size().columns if sys.stdout.isatty() else None
    kept = list(range(len(headings))) if room is None else _kept(headings, widths, drop, room)
    shown = _narrowed([widths[index] for index in kept], room)
    lines = UNICODE if (sys.stdout.encoding or "").lower().startswith("utf") else ASCII
    if title:
        print(_styled(_cut(plain(title), room, lines), "3"))
    left = [headings[index] in words for index in kept]
    picked = [[row[index] for index in kept] for row in [headings, *cells]]
    print("\n".join(_drawn(picked, shown, left, lines)))
    if missing := [heading for index, heading in enumerate(headings) if index not in kept]:
        print(_styled(_cut(f"columns left out: {', '.join(missing)}", room, lines), "2"))


def _drawn(rows: Sequence[Sequence[str]], widths: Sequence[int], left: Sequence[bool], lines: _Lines) -> Iterator[str]:
    """The lines of a table: `rows` with the headings first."""
    yield _rule(lines.top, widths)
    for number, row in enumerate(rows):
        cells = [_aligned(text, width, at, lines) for text, width, at in zip(row, widths, left, strict=True)]
        if number == 0:
            yield _row([_styled(cell, "1") for cell in cells], lines.head)
            yield _rule(lines.below_head, widths)
        else:
            yield _row(cells, lines.row)
    yield _rule(lines.bottom, widths)


def _rule(ends: str, widths: Sequence[int]) -> str:
    begin, line, crossing, end = ends
    return begin + crossing.join(line * (width + 2) for width in widths) + end


def _row(cells: Sequence[str], between: str) -> str:
    return between + between.join(f" {cell} " for cell in cells) + between


def _aligned(text: str, width: int, left: bool, lines: _Lines) -> str:
    text = _cut(text, width, lines)
    blanks = " " * (width - cell_len(text))
    return text + blanks if left else blanks + text


def _cut(text: str, width: int | None, lines: _Lines) -> str:
    """`text` in at most `width` cells."""
    if width is None or cell_len(text) <= width:
        return text
    return set_cell_size(text, max(width - 1, 0)).rstrip() + lines.cut


def _styled(text: str, style: str) -> str:
    """Bold (1), dim (2) or italic (3) on a terminal that can be."""
    plain_terminal = not sys.stdout.isatty() or os.environ.get("TERM", "dumb") in ("", "dumb", "unknown")
    return text if plain_terminal else f"\x1b[{style}m{text}\x1b[0m"


def _width(widths: Sequence[int]) -> int:
    return sum(widths) + BESIDE * len(widths) + 1


def _narrowed(widths: Sequence[int], room: int | None) -> list[int]:
    """With the widest column as narrow as it takes, for a terminal that has not even room for the last columns."""
    result = list(widths)
    while room is not None and _width(result) > room and max(result) > 1:
        result[result.index(max(result))] -= 1
    return result


def _kept(headings: Sequence[str], widths: Sequence[int], drop: Sequence[str], room: int) -> list[int]:
    """The columns that fit, in their order."""
    kept = list(range(len(headings)))
    last = [index for index in kept if headings[index] not in drop][::-1]
    for index in [*(headings.index(heading) for heading in drop), *last]:
        if _width([widths[each] for each in kept]) <= room or len(kept) <= FEWEST:
            break
        kept.remove(index)
    return kept

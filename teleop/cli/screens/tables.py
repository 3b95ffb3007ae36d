"""Tables on stdout: a row is one line of the terminal, and never wrapped; a narrow terminal loses columns.

Into a pipe or a file a table has all its columns, as wide as they are.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Sequence

from rich.cells import cell_len
from rich.console import Console
from rich.table import Table
from rich.text import Text

BESIDE = 3  # cells of a column beside its text: a line and two blanks
FEWEST = 2  # columns


def print_table(
    title: str,
    headings: Sequence[str],
    rows: Iterable[Sequence[str]],
    words: Collection[str] = (),
    drop: Sequence[str] = (),
) -> None:
    """`words` are the columns of words, all others are numbers; `drop` the columns that go first, in this order."""
    console, cells = Console(highlight=False), [list(row) for row in rows]
    widths = [max(cell_len(row[index]) for row in [headings, *cells]) for index in range(len(headings))]
    if not console.is_terminal:
        console.width = max(console.width, _width(widths))
    kept = _kept(headings, widths, drop, console.width)
    if title:
        console.print(Text(title, "italic"), no_wrap=True, overflow="ellipsis", crop=True)
    table = Table()
    for index in kept:
        justify = "left" if headings[index] in words else "right"
        table.add_column(headings[index], justify=justify, no_wrap=True, overflow="ellipsis")
    for row in cells:
        table.add_row(*(Text(row[index]) for index in kept))
    console.print(table)
    if missing := [heading for index, heading in enumerate(headings) if index not in kept]:
        console.print(
            Text(f"columns left out: {', '.join(missing)}", "dim"), no_wrap=True, overflow="ellipsis", crop=True
        )


def _width(widths: Sequence[int]) -> int:
    return sum(widths) + BESIDE * len(widths) + 1


def _kept(headings: Sequence[str], widths: Sequence[int], drop: Sequence[str], room: int) -> list[int]:
    """The columns that fit, in their order."""
    kept = list(range(len(headings)))
    last = [index for index in kept if headings[index] not in drop][::-1]
    for index in [*(headings.index(heading) for heading in drop), *last]:
        if _width([widths[each] for each in kept]) <= room or len(kept) <= FEWEST:
            break
        kept.remove(index)
    return kept

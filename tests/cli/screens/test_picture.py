"""What fits on a terminal: the keys and what stops everything stay longest; a picture never raises."""

from __future__ import annotations

import io

import pytest
from rich.console import Console
from rich.text import Text

from teleop.cli.screens.picture import Picture, Rows


def rows(*names: str) -> list[Text]:
    return [Text(name) for name in names]


ROWS = Rows(Text("title"), Text("banner"), rows("heading", "pan"), rows("state", ""), rows("old", "new"), rows("keys"))


@pytest.mark.parametrize(
    ("height", "shown"),
    [
        (1, "keys"),
        (2, "banner keys"),
        (3, "banner pan keys"),
        (4, "banner heading pan keys"),
        (5, "title banner heading pan keys"),
        (6, "title banner heading pan state keys"),
        (8, "title banner heading pan state  old keys"),
        (10, "title banner heading pan state  old new  keys"),
    ],
)
def test_the_least_important_rows_go_first(height: int, shown: str):
    fitted = ROWS.fitted(80, height)
    assert len(fitted) == height
    assert " ".join(row.plain for row in fitted) == shown


def test_a_row_that_is_too_long_is_cut_and_the_original_is_not():
    assert ROWS.fitted(3, 10)[0].plain == "tit"
    assert ROWS.title.plain == "title"


def picture(encoding: str, draw) -> Picture:
    stream = io.TextIOWrapper(io.BytesIO(), encoding=encoding)
    return Picture(draw, Console(file=stream, width=40, height=4, force_terminal=True))


def test_a_terminal_without_unicode_gets_ascii_in_the_same_cells():
    marks = Text("━─●○│█é")
    assert picture("ascii", lambda *_: Rows(marks)).text().plain.splitlines()[0] == "=-*o|#?"
    assert picture("utf-8", lambda *_: Rows(marks)).text().plain.splitlines()[0] == marks.plain


def test_a_drawing_that_fails_is_a_line_that_says_so():
    def broken(_width: int, _height: int) -> Rows:
        raise ZeroDivisionError("oops")

    text = picture("utf-8", broken).text().plain
    assert text.startswith("cannot draw the view (ZeroDivisionError")


def test_no_picture_is_possible_without_a_terminal():
    assert not Picture(lambda *_: ROWS, Console(file=io.StringIO())).possible
    assert picture("utf-8", lambda *_: ROWS).possible

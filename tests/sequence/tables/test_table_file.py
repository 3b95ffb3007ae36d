"""Tables as programs and people write them, and what is wrong with one, by line and column."""

from __future__ import annotations

from pathlib import Path

import pytest

from teleop.config.documents.document import DocumentError
from teleop.sequence.tables.table_file import MOST_FRAMES, Table, read_table


def read(folder: Path, text: str | bytes, name: str = "track.csv") -> Table:
    file = folder / name
    file.write_bytes(text if isinstance(text, bytes) else text.encode())
    return read_table(file, name)


@pytest.mark.parametrize(
    "text",
    [
        "frame,rx,ry\n1,2.5,-3\n2,2.6,-4\n",
        "\ufeffframe;rx;ry\r\n1;2.5;-3\r\n2;2.6;-4\r\n",
        "frame\trx\try\n1\t2.5\t-3\n2\t2.6\t-4\n",
        "# a track\n# frame rx ry\n1 2.5 -3\n2 2.6 -4\n",
        "A Kuper move\n\n  frame   rx      ry\n  1       2.5     -3.0\n  2       2.6     -4.0\n",
        '"frame","rx","ry"\n1, 2.5, -3,\n\n2, 2.6, -4,\n',
        "frame rx ry\n1 25e-1 -.3e1\n; a remark\n2 2.6 -4.\n",
        "frame,rx,ry\n,deg,deg\n1,2.5,-3\n2,2.6,-4\n",
    ],
)
def test_separators_names_comments_and_marks_of_byte_order(text: str, tmp_path: Path) -> None:
    for raw in (text.encode(), text.lstrip("\ufeff").encode("utf-16")):
        table = read(tmp_path, raw)
        assert table.values(table.index("rx")).tolist() == [2.5, 2.6]
        assert table.values(table.index("RY")).tolist() == [-3, -4]
        assert table.values(table.index(1)).tolist() == [1, 2]


def test_a_chan_file_has_the_columns_of_nuke(tmp_path: Path) -> None:
    table = read(tmp_path, "1001 0 0 0 1.5 2.5 3.5 40\n1002 0 0 0 1.6 2.6 3.6 40\n", "camera.chan")
    assert table.values(table.index("ry")).tolist() == [2.5, 2.6]
    assert table.values(table.index("frame")).tolist() == [1001, 1002]


@pytest.mark.parametrize(
    ("column", "wrong"),
    [
        ("rz", "track.csv has no column 'rz'; it has frame, rx, rx"),
        ("zoom", "track.csv has no column 'zoom'; it has frame, rx, rx"),
        ("rx", "track.csv has 2 columns 'rx'; use the number of one, from 1"),
        (4, "track.csv has 3 columns"),
    ],
)
def test_a_column_that_is_not_there(column: str | int, wrong: str, tmp_path: Path) -> None:
    table = read(tmp_path, "frame,rx,rx\n1,2,3\n")
    with pytest.raises(ValueError, match="column") as error:
        table.index(column)
    assert str(error.value) == wrong


def test_a_table_without_names_has_numbers(tmp_path: Path) -> None:
    table = read(tmp_path, "1 2\n2 3\n", "track.txt")
    with pytest.raises(ValueError, match=r"track\.txt has no names; use a number from 1 to 2"):
        table.index("rx")


@pytest.mark.parametrize(
    ("text", "problems"),
    [
        (
            "a,b\n1,2\n1,x\n1\n",
            ["track.csv:3:3: 'b' must be a number, not 'x'", "track.csv:4:1: has 1 values, and line"],
        ),
        ("a;b\n1;2\n1;20,5\n", ["track.csv:3:3: 20,5: write 20.5"]),
        ("a b\n1 2\n1 nan\n", ["track.csv:3:3: 'b' must be a number, not 'nan'"]),
        ("a,b\n1,2\n1\n2\n", ["track.csv:3:1: has 1 values", "track.csv:4:1: has 1 values"]),
        ("a,b\n1,2\n1,\n", ["track.csv:3:3: 'b' must be a number, not empty"]),
    ],
)
def test_a_cell_that_is_no_number_is_named_by_line_and_column(text: str, problems: list[str], tmp_path: Path) -> None:
    with pytest.raises(DocumentError) as error:
        read(tmp_path, text).values(1)
    assert [line.startswith(wrong) for line, wrong in zip(error.value.problems, problems, strict=True)] == [True] * len(
        problems
    )


@pytest.mark.parametrize(
    ("text", "wrong"),
    [
        ("", "track.csv:1:1: has no row of numbers"),
        ("frame,rx\n", "track.csv:1:1: has no row of numbers"),
        (b"\x00\x01\x02", "track.csv:1:1: is not text; save the table as CSV"),
        ("1\n" * (MOST_FRAMES + 1), f"track.csv:{MOST_FRAMES + 1}:1: is too much: at most {MOST_FRAMES} frames"),
    ],
)
def test_what_is_no_table_is_refused(text: str | bytes, wrong: str, tmp_path: Path) -> None:
    with pytest.raises(DocumentError) as error:
        read(tmp_path, text)
    assert error.value.problems == [wrong]


def test_a_folder_cannot_be_read(tmp_path: Path) -> None:
    with pytest.raises(DocumentError, match="cannot be read"):
        read_table(tmp_path, "folder")

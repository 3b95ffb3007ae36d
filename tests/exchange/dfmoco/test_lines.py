"""Lines of DFMoco: what is a command, what is a bad argument, and what is not answered."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from teleop.exchange.dfmoco.lines import LONGEST, Line, LineReader, parsed


@pytest.mark.parametrize(
    ("line", "wanted"),
    [
        (b"hi", Line("hi")),
        (b"hi there", Line("hi")),
        (b"  ms ", Line("ms")),
        (b"mm 1 600", Line("mm", (1, 600))),
        (b"mm 1 -600", Line("mm", (1, -600))),
        (b"mm 1 +600", Line("mm", (1, 600))),
        (b"mm  1   600 ", Line("mm", (1, 600))),
        (b"mm", Line("mm", ())),
        (b"mm 1 6x0", Line("mm", None)),
        (b"mm 1 6.0", Line("mm", None)),
        (b"mm1 600", Line("mm", None)),
        (b"mm\x1e1 600", Line("mm", None)),
        (b"mm 1 99999999999", Line("mm", None)),
        (b"mm 1 3000000000", Line("mm", None)),
        (b"bf" + b" 1" * 40, Line("bf", None)),
        (b"HI", None),
        (b"xx", None),
        (b"", None),
        (b"\xff\xfe", None),
    ],
)
def test_a_line(line, wanted):
    assert parsed(line) == wanted


@pytest.mark.parametrize("end", [b"\r\n", b"\n", b"\r", b"\n\r"])
def test_any_end_of_a_line_will_do_and_a_line_may_come_in_pieces(end):
    reader = LineReader()
    data = b"mm 1 600" + end + b"hi" + end
    assert [line for byte in data for line in reader.feed(bytes([byte]))] == [Line("mm", (1, 600)), Line("hi")]
    assert reader.feed(data) == [Line("mm", (1, 600)), Line("hi")]


def test_a_line_without_end_is_bounded():
    reader = LineReader()
    for _ in range(1000):
        assert reader.feed(b"mm 1 1" + b"2" * 1000) == []
    assert len(reader._rest) <= LONGEST + 1
    assert reader.feed(b"\r\nhi\r\n") == [Line("mm", None), Line("hi")]


@given(st.lists(st.binary(max_size=40), max_size=8))
def test_no_bytes_raise(pieces):
    reader = LineReader()
    for piece in pieces:
        for line in reader.feed(piece):
            assert line.name

"""Lines are written where there is room for them, and wait where there is none."""

from __future__ import annotations

import os
import select
from collections.abc import Iterator
from contextlib import contextmanager, redirect_stderr

from teleop.cli.screens.stderr_writer import LONGEST, MOST, StderrWriter


class Pipe:
    """A pipe as stderr, which can be full."""

    def __init__(self) -> None:
        self.out, self.into = os.pipe()
        os.set_blocking(self.into, False)
        os.set_blocking(self.out, False)
        self.stream = os.fdopen(self.into, "w", buffering=1)

    def fill(self) -> None:
        while select.select([], [self.into], [], 0)[1]:
            os.write(self.into, b"x" * LONGEST)

    def read(self) -> str:
        parts = []
        while select.select([self.out], [], [], 0)[0]:
            parts.append(os.read(self.out, 1 << 20))
        return b"".join(parts).decode().lstrip("x")


@contextmanager
def pipe_as_stderr() -> Iterator[Pipe]:
    pipe = Pipe()
    with pipe.stream, redirect_stderr(pipe.stream):
        yield pipe
    os.close(pipe.out)


def test_where_there_is_room_a_line_is_there_at_once() -> None:
    with pipe_as_stderr() as pipe:
        StderrWriter().notify("a line")
        assert pipe.read() == "a line\n"


def test_a_full_pipe_holds_nothing_up_and_gets_its_lines_in_order_once_it_is_read() -> None:
    with pipe_as_stderr() as pipe:
        pipe.fill()
        writer = StderrWriter()
        writer.notify("first")
        writer.notify("second")
        assert pipe.read() == "", "both wait"
        writer.notify("third")
        assert pipe.read() == "first\nsecond\nthird\n"


def test_what_still_waits_is_written_at_the_end() -> None:
    with pipe_as_stderr() as pipe:
        pipe.fill()
        writer = StderrWriter()
        writer.notify("the last word")
        assert pipe.read() == ""
        writer.finish()
        assert pipe.read() == "the last word\n"


def test_of_too_many_lines_the_oldest_are_left_out() -> None:
    with pipe_as_stderr() as pipe:
        pipe.fill()
        writer = StderrWriter()
        for number in range(MOST + 2):
            writer.notify(str(number))
        pipe.read()
        writer.finish()
        assert pipe.read().split() == [str(number) for number in range(2, MOST + 2)]


def test_the_longest_line_fits_where_there_is_room_for_one() -> None:
    with pipe_as_stderr() as pipe:
        pipe.fill()
        os.read(pipe.out, LONGEST)
        StderrWriter().notify("\N{GRINNING FACE}" * LONGEST)
        line = pipe.read()
        assert line.endswith("\N{GRINNING FACE}\n")
        assert len(line) == LONGEST // 4

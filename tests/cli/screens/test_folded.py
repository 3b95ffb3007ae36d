"""Lines are folded for a terminal only, and never in the middle of a word."""

from __future__ import annotations

import io

import pytest

from teleop.cli.screens.folded import NARROWEST, after_the_run, folded

LINE = "the gimbal on socketcan:can0 did not answer within one second"


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


@pytest.fixture(autouse=True)
def _narrow(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("COLUMNS", "30")


def test_a_pipe_gets_the_line_as_it_is() -> None:
    closed = Terminal()
    closed.close()
    assert folded(LINE, io.StringIO()) == LINE
    stream = io.StringIO()
    stream.close()
    assert folded(LINE, stream) == LINE


def test_a_terminal_gets_lines_that_fit_with_what_is_left_indented() -> None:
    lines = folded(f"short\n{LINE}", Terminal()).split("\n")
    assert lines[:2] == ["short", "the gimbal on socketcan:can0"]
    assert max(map(len, lines)) <= 30
    assert all(line.startswith("  ") for line in lines[2:])
    assert " ".join(" ".join(lines[1:]).split()) == LINE


def test_what_is_longer_than_a_line_stays_whole_so_that_it_can_be_copied() -> None:
    path = "/home/somebody/moves/a-very-long-name-of-a-move.yaml"
    assert path in folded(f"cannot be read: {path}", Terminal()).split("\n  ")


def test_no_terminal_is_so_narrow_that_words_stand_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("COLUMNS", "3")
    first = folded(LINE, Terminal()).split("\n")[0]
    assert first == "the gimbal on"
    assert len(first) <= NARROWEST


@pytest.mark.parametrize("fails", [False, True])
def test_what_came_during_a_run_is_told_after_it_and_fits_too(fails: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    stderr = Terminal()
    monkeypatch.setattr("sys.stderr", stderr)

    def run() -> None:
        with after_the_run() as notify:
            notify("short")
            notify(LINE)
            assert stderr.getvalue() == ""
            if fails:
                raise ZeroDivisionError

    if fails:
        with pytest.raises(ZeroDivisionError):
            run()
    else:
        run()
    assert stderr.getvalue() == f"short\n{folded(LINE, Terminal())}\n"

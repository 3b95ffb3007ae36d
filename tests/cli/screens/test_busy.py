"""A sign of life is one line of a terminal, and gone afterwards."""

from __future__ import annotations

import io
import os
import pty
from contextlib import closing

import pytest
from waiting import wait_until

from teleop.cli.screens.busy import ERASE, busy


@pytest.fixture
def terminal(monkeypatch: pytest.MonkeyPatch):
    """The far end of a terminal, and a stream into it."""
    monkeypatch.setenv("TERM", "xterm")
    far, near = pty.openpty()
    with os.fdopen(near, "w") as stream:
        yield far, stream
    os.close(far)


def test_work_that_lasts_is_named_with_its_seconds_and_then_erased(terminal) -> None:
    far, stream = terminal
    seen = b""

    def counted() -> bool:
        nonlocal seen
        seen += os.read(far, 1000)
        return b"Planning: 0 s" in seen

    with busy("Planning", stream, patience=0.01):
        wait_until(counted, "a sign of life")
    while not seen.endswith(ERASE.encode()):
        seen += os.read(far, 1000)
    assert b"\n" not in seen


def test_what_is_soon_over_says_nothing(terminal) -> None:
    far, stream = terminal
    with busy("Planning", stream, patience=100):
        pass
    stream.write("end")
    stream.flush()
    assert os.read(far, 1000) == b"end"


def test_a_pipe_and_a_dumb_terminal_have_nothing(terminal, monkeypatch: pytest.MonkeyPatch) -> None:
    far, stream = terminal
    monkeypatch.setenv("TERM", "dumb")
    with closing(io.StringIO()) as pipe:
        for each in (pipe, stream):
            with busy("Planning", each, patience=0):
                pass
        assert pipe.getvalue() == ""
    stream.write("end")
    stream.flush()
    assert os.read(far, 1000) == b"end"

"""The keys of a terminal: what was typed between two looks, and a terminal that closes or is another's."""

from __future__ import annotations

import os
import pty
import sys
import termios
from typing import cast

import pytest

from teleop.core.axes import Axis
from teleop.core.errors import LinkError
from teleop.core.events import Tick
from teleop.core.operator_input import Command, Press
from teleop.inputs import keyboard as module
from teleop.inputs.keyboard import Keyboard, is_ours, terminal
from teleop.inputs.keymaps import KeyReader

TICK = cast(Tick, None)  # a keyboard looks only whether anybody is left to see it


class ReaderThatEnds(KeyReader):
    """Types `then` when an escape sequence is given up, and closes the line."""

    def __init__(self, far: int, then: bytes) -> None:
        super().__init__()
        self._far, self._then = far, then
        self.asked: list[str] = []

    def settle(self) -> None:
        self.asked.append(self.question)
        super().settle()
        self.asked.append(self.question)
        os.write(self._far, self._then)
        os.close(self._far)


def run_to_its_end(keyboard: Keyboard) -> None:
    """What its thread does, in this one, until the line is closed."""
    keyboard._wake = os.pipe()
    try:
        keyboard._run()
    finally:
        for descriptor in keyboard._wake:
            os.close(descriptor)


def typed(keys: bytes) -> Keyboard:
    """A keyboard on a line that was closed behind these keys."""
    near, far = os.pipe()
    os.write(far, keys)
    os.close(far)
    keyboard = Keyboard(near)
    run_to_its_end(keyboard)
    os.close(near)
    return keyboard


def test_all_keys_since_the_last_look_are_handed_over_once() -> None:
    keyboard = typed(b" \x1b[C\x1b[C\x1b[1;2Dkq")
    held = keyboard.read(0.0)
    assert held.presses == [Press(Command.STOP), Press(Command.QUIT)]
    assert held.steps == {Axis.PAN: -8.0, Axis.TILT: pytest.approx(0.1)}
    assert held.click == {Axis.PAN: 10.0, Axis.TILT: pytest.approx(0.1)}, "the longest step of each axis"
    again = keyboard.read(0.1)
    assert (again.presses, again.steps) == ([], {})


def test_a_terminal_that_closes_is_trouble_and_ends_the_run() -> None:
    keyboard = Keyboard(-1)
    keyboard.observe(TICK)
    assert keyboard.read(0.0).trouble == ""
    closed = typed(b" ")
    assert closed.read(0.0).trouble == "the terminal was closed"
    with pytest.raises(LinkError, match="the terminal was closed"):
        closed.observe(TICK)


def test_an_escape_that_nothing_follows_takes_a_question_back(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "ESCAPE_TIME", 0)
    near, far = os.pipe()
    os.write(far, b"s\x1b")
    reader = ReaderThatEnds(far, b"1")
    keyboard = Keyboard(near, reader)
    run_to_its_end(keyboard)
    os.close(near)
    assert reader.asked == ["store which preset? 0-9", ""]
    assert keyboard.read(0.0).presses == [Press(Command.RECALL, 1)]


def test_while_it_is_entered_no_key_freezes_the_program_or_its_view() -> None:
    far, near = pty.openpty()
    with Keyboard(near):
        inward, _, _, local, _, _, characters = termios.tcgetattr(near)
        assert not inward & termios.IXON
        assert not local & (termios.ICANON | termios.ECHO)
        assert local & termios.ISIG, "Ctrl-C still ends the program"
        assert characters[termios.VSUSP] == bytes([os.fpathconf(near, "PC_VDISABLE")])
    os.close(far)
    os.close(near)


def test_one_whose_terminal_hangs_up_meanwhile_is_left_quietly() -> None:
    far, near = pty.openpty()
    keyboard = Keyboard(near)
    with keyboard:
        os.close(far)
    os.close(near)
    with pytest.raises(LinkError, match="the terminal was closed"):
        keyboard.observe(TICK)


def test_keys_are_read_only_from_a_terminal_and_in_the_foreground(monkeypatch: pytest.MonkeyPatch) -> None:
    far, near = pty.openpty()
    line = os.pipe()
    group = os.getpgrp()
    with open(near, closefd=False) as stdin:
        monkeypatch.setattr(sys, "stdin", stdin)
        monkeypatch.setattr(os, "tcgetpgrp", lambda _descriptor: group)
        assert terminal() == near
        assert not is_ours(line[0]), "no terminal"
        monkeypatch.setattr(os, "tcgetpgrp", lambda _descriptor: group + 1)
        assert terminal() is None
    assert terminal() is None, "it is closed"
    monkeypatch.setattr(sys, "stdin", None)
    assert terminal() is None
    for descriptor in (far, near, *line):
        os.close(descriptor)

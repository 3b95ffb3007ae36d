"""A run leaves the process as it found it: what a program that imports teleop would notice."""

from __future__ import annotations

import faulthandler
import gc
import logging
import os
import pty
import signal
import sys
import termios
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, nullcontext
from pathlib import Path

import pytest

import teleop.cli
from teleop.app.run import undisturbed
from teleop.cli.signals import process, signals_to
from teleop.core.control_loop import ControlLoop
from teleop.core.errors import LeaveAtOnce

MOVE = "keyframes: [{at: 0, pan: 0}, {at: 2, pan: 10}]\n"
SHOOT = """
fps: 24
keyframes: [{at: 0, pan: 0}, {at: 3, pan: 5}]
timelapse: {frames: 4, interval: 2s, exposure: 0.2s}
"""
STICKS = "time,pan\n0,0.3\n1,0\n2,0\n"
COMMANDS = {
    "play": ["play", "move.yaml", "--fast", "--speed", "90%"],
    "play with a take": ["play", "move.yaml", "--fast", "--take", "OUT.mcap"],
    "shoot": ["play", "shoot.yaml", "--fast", "--restart"],
    "live": ["live", "--sticks", "sticks.csv", "--fast"],
    "calibrate": ["calibrate", "delay", "--fast"],
}


def state() -> dict[str, object]:
    """Everything of this process that a run could change for good."""
    return {
        "handlers": {number: signal.getsignal(number) for number in signal.valid_signals()},
        "wakeup": _wakeup(),
        "switch interval": sys.getswitchinterval(),
        "collector": (gc.isenabled(), gc.get_threshold(), gc.get_freeze_count()),
        "threads": sorted(thread.name for thread in threading.enumerate()),
        "descriptors": sorted(os.listdir("/proc/self/fd")),
        "logging": (list(logging.root.handlers), logging.root.level, logging.getLogger("can").level),
        "faulthandler": faulthandler.is_enabled(),
        "hooks": (sys.excepthook, sys.unraisablehook, threading.excepthook),
        "streams": (sys.stdin, sys.stdout, sys.stderr),
        "folder": Path.cwd(),
        "mask": signal.pthread_sigmask(signal.SIG_BLOCK, ()),
        "environment": {name: value for name, value in os.environ.items() if name != "PYTEST_CURRENT_TEST"},
    }


def _wakeup() -> int:
    descriptor = signal.set_wakeup_fd(-1)
    signal.set_wakeup_fd(descriptor)
    return descriptor


def run(arguments: list[str], folder: Path, number: int = 0) -> int:
    return teleop.cli.run([word.replace("OUT", str(folder / f"take{number}")) for word in arguments])


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    for name, text in (("move.yaml", MOVE), ("shoot.yaml", SHOOT), ("sticks.csv", STICKS)):
        (tmp_path / name).write_text(text)
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.mark.parametrize("name", COMMANDS)
def test_five_runs_in_one_process_leave_it_as_they_found_it(name: str, folder: Path) -> None:
    assert run(COMMANDS[name], folder) == 0  # what is loaded once stays loaded
    before = state()
    for number in range(1, 5):
        assert run(COMMANDS[name], folder, number) == 0
        assert state() == before


def fails(error: BaseException) -> Callable[..., None]:
    def call(*_arguments: object) -> None:
        raise error

    return call


@pytest.mark.parametrize("name", COMMANDS)
@pytest.mark.parametrize("error", [ZeroDivisionError("a defect"), KeyboardInterrupt(), LeaveAtOnce("SIGINT")])
def test_a_run_that_ends_in_an_exception_leaves_it_too(
    error: BaseException, name: str, folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    run(COMMANDS[name], folder)
    before = state()
    monkeypatch.setattr(ControlLoop, "run", fails(error))
    try:
        code = run(COMMANDS[name], folder, 1)
    except ZeroDivisionError:
        code = 1
    assert code == (1 if isinstance(error, ZeroDivisionError) else 130)
    assert state() == before


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGQUIT])
def test_a_run_that_a_signal_ends_leaves_it_too(
    number: signal.Signals, folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    before = state()
    turn, turns = ControlLoop.turn, iter(range(1 << 30))

    def turned(self: ControlLoop) -> None:
        if next(turns) == 60:
            signal.raise_signal(number)
        turn(self)

    monkeypatch.setattr(ControlLoop, "turn", turned)
    assert run(COMMANDS["play"], folder) == 130
    assert state() == before


def test_what_is_frozen_before_a_run_stays_frozen() -> None:
    gc.freeze()
    try:
        before = gc.get_freeze_count()
        with undisturbed():
            assert sys.getswitchinterval() < 0.001
        assert gc.get_freeze_count() == before > 0
    finally:
        gc.unfreeze()


@contextmanager
def on_a_terminal() -> Iterator[int]:
    """Stdin is a terminal for a while; its descriptor."""
    far, near = pty.openpty()
    kept = os.dup(0)
    os.dup2(near, 0)
    try:
        yield near
    finally:
        os.dup2(kept, 0)
        for descriptor in (far, near, kept):
            os.close(descriptor)


@pytest.mark.parametrize("error", [None, ZeroDivisionError(), LeaveAtOnce("SIGINT")])
def test_a_terminal_is_left_as_it_was(error: BaseException | None) -> None:
    from teleop.inputs.keyboard import Keyboard

    with on_a_terminal() as near:
        before, threads = termios.tcgetattr(near), threading.active_count()
        with pytest.raises(type(error)) if error else nullcontext(), Keyboard(near):
            assert termios.tcgetattr(near) != before
            if error:
                raise error
        assert termios.tcgetattr(near) == before
        assert threading.active_count() == threads


def test_three_signals_in_a_program_that_imports_teleop_end_the_run_and_not_the_program() -> None:
    assert not process.owned
    before, asked = state(), []

    def press() -> None:
        with signals_to(asked.append):
            for _ in range(3):
                signal.raise_signal(signal.SIGTERM)

    with pytest.raises(LeaveAtOnce, match="SIGTERM"):
        press()
    assert asked == ["SIGTERM received"] * 3
    assert state() == before


def test_signals_that_come_while_the_main_thread_is_held_up_are_counted_all_the_same() -> None:
    """Its handler is called once for several that have come together."""
    main = threading.get_ident()

    def three() -> None:
        for _ in range(3):
            signal.pthread_kill(main, signal.SIGINT)

    def hung() -> None:
        with signals_to(lambda _reason: None):
            signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
            three()  # held back, and one when they are let through
            signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGINT})
            presses = threading.Thread(target=lambda: [(time.sleep(0.01), three()) for _ in range(3)])
            presses.start()
            try:
                threading.Event().wait()
            finally:
                presses.join()  # none of them may come when the handlers are put back

    with pytest.raises(LeaveAtOnce, match="SIGINT"):
        hung()

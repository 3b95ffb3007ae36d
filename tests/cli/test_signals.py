"""Signals in a run, in this process: the first asks it to stop, the third leaves; handlers are put back."""

from __future__ import annotations

import os
import signal
import threading
import time

import pytest
from waiting import wait_until

from teleop.cli.signals import signals_to
from teleop.core.errors import LeaveAtOnce


def raise_signal(number: signal.Signals) -> None:
    os.kill(os.getpid(), number)
    time.sleep(0.01)  # its handler is called between two lines of this thread


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGQUIT])
def test_a_signal_asks_the_run_to_stop_by_its_name(number: signal.Signals):
    asked: list[str] = []
    with signals_to(asked.append):
        raise_signal(number)
    assert len(asked) == 1
    assert number.name in asked[0] or (number, asked[0]) == (signal.SIGINT, "Ctrl-C")


def test_the_third_leaves_at_once_and_the_second_does_not():
    asked: list[str] = []

    @signals_to(asked.append)
    def work() -> None:
        raise_signal(signal.SIGINT)
        raise_signal(signal.SIGTERM)
        assert len(asked) == 2
        raise_signal(signal.SIGINT)
        raise AssertionError("it went on")

    with pytest.raises(LeaveAtOnce):
        work()


def test_a_hang_up_does_not_count_as_one_of_the_three():
    asked: list[str] = []
    with signals_to(asked.append):
        for _ in range(4):
            raise_signal(signal.SIGHUP)
    assert len(asked) == 4


def test_handlers_are_put_back_whatever_is_raised():
    numbers = [signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGQUIT]
    before = [signal.getsignal(number) for number in numbers]

    @signals_to(lambda _name: None)
    def work() -> None:
        assert all(signal.getsignal(number) != each for number, each in zip(numbers, before, strict=True))
        raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        work()
    assert [signal.getsignal(number) for number in numbers] == before
    wait_until(lambda: "signals" not in [thread.name for thread in threading.enumerate()])


def test_a_signal_that_was_ignored_before_stays_ignored():
    before = signal.signal(signal.SIGHUP, signal.SIG_IGN)
    asked: list[str] = []
    try:
        with signals_to(asked.append):
            raise_signal(signal.SIGHUP)
    finally:
        signal.signal(signal.SIGHUP, before)
    assert asked == []

"""Every sink is released by its own steps; one that fails is tried for a while; none keeps a run from ending."""

from __future__ import annotations

import math
import threading
from collections.abc import Callable
from typing import Any

import pytest

from teleop.core.errors import LinkError, TeleopError
from teleop.core.events import Tick
from teleop.core.shutdown import RELEASE_LONGEST, RELEASE_PATIENCE, Shutdown

PERIOD = 0.01


class Released:
    """A sink whose `release` does `step` and keeps the times."""

    def __init__(self, step: Callable[[float], Any]) -> None:
        self.times: list[float] = []
        self._step = step

    def write(self, tick: Tick) -> None: ...

    def release(self, now: float) -> float | None:
        self.times.append(now)
        return self._step(now)


def failing(_now: float) -> float:
    raise LinkError("full")


def guarded(call: Callable[..., Any], *arguments: Any, default: Any = None) -> Any:
    try:
        return call(*arguments)
    except LinkError:
        return default


def stepped(shutdown: Shutdown, until: float) -> float:
    """The time of the step at which all is released."""
    for tick in range(round(until / PERIOD) + 1):
        if shutdown.step(tick * PERIOD, guarded):
            return tick * PERIOD
    return math.inf


def test_each_sink_is_called_at_its_own_times():
    one, other = Released(lambda _now: None), Released(lambda now: now + 0.05 if now < 0.09 else None)
    assert stepped(Shutdown([one, other], PERIOD), 1.0) == pytest.approx(0.1)
    assert one.times == [0.0]
    assert other.times == pytest.approx([0.0, 0.05, 0.1])


def test_a_sink_that_fails_is_tried_again_for_a_while_and_then_left():
    sink = Released(failing)
    ended = stepped(Shutdown([sink], PERIOD), 2.0)
    assert ended == pytest.approx(RELEASE_PATIENCE, abs=2 * PERIOD)
    assert len(sink.times) == pytest.approx(RELEASE_PATIENCE / PERIOD, abs=2)


def test_a_link_that_comes_back_meanwhile_releases_its_device():
    sink = Released(lambda now: failing(now) if now < 0.1 else None)
    assert stepped(Shutdown([sink], PERIOD), 1.0) == pytest.approx(0.1, abs=PERIOD)


def test_a_sink_that_never_ends_is_left_with_one_error():
    sink = Released(lambda now: now + PERIOD)
    shutdown = Shutdown([sink], PERIOD)
    with pytest.raises(TeleopError, match="timed out after 10 s"):
        stepped(shutdown, 2 * RELEASE_LONGEST)
    calls = len(sink.times)
    assert shutdown.step(2 * RELEASE_LONGEST, guarded)
    assert len(sink.times) == calls


def test_at_once_what_fails_is_not_tried_again():
    bad, good = Released(failing), Released(lambda _now: None)
    assert Shutdown([bad, good], PERIOD).once(0.0, guarded)
    assert (len(bad.times), len(good.times)) == (1, 1)


def test_a_step_that_hangs_in_another_thread_is_left_to_it():
    inside, end = threading.Event(), threading.Event()

    def hang(_now: float) -> None:
        inside.set()
        end.wait(10)

    hung, other = Released(hang), Released(lambda _now: None)
    shutdown = Shutdown([hung, other], PERIOD)
    thread = threading.Thread(target=shutdown.step, args=(0.0, guarded), daemon=True)
    thread.start()
    assert inside.wait(10)
    try:
        assert not shutdown.once(0.0, guarded)  # returns although the other thread is still inside
        assert (len(hung.times), len(other.times)) == (1, 1)
    finally:
        end.set()
        thread.join(10)

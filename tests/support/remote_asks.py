"""What a client of a `RemoteBench` asks for, and waits for."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

from remote_bench import RemoteBench

PATIENCE = 5.0  # s of the loop's time


def done(bench: RemoteBench, do: str, **fields: Any) -> dict[str, Any]:
    """How it ended, once it has."""
    number = bench.say(do, **fields)
    end = bench.now + PATIENCE
    while number not in bench.ends and bench.now < end:
        bench.tick()
        if "error" in bench.answers.get(number, {}):
            return bench.answers[number]
    return bench.ends[number]


def played(bench: RemoteBench, do: str = "play", **fields: Any) -> int:
    """A move that is planned in this process, and has begun."""
    number = bench.say(do, **fields)
    planned_or_not(bench, number)
    assert bench.answers[number].get("ok"), bench.answers[number]
    return number


def planned_or_not(bench: RemoteBench, number: int) -> dict[str, Any]:
    """The plan is made in a thread: real time too has to go by. The answer."""
    until(bench, lambda: bench.answers.get(number, {"planning": True}).get("planning") is None)
    return bench.answers[number]


def ended(bench: RemoteBench, do: str, **fields: Any) -> None:
    number = bench.say(do, **fields)
    until(bench, lambda: number in bench.ends or "error" in bench.answers.get(number, {}))
    assert bench.ends[number].get("ok"), (bench.answers[number], bench.ends.get(number))


def until(bench: RemoteBench, holds: Callable[[], object]) -> None:
    """A change of speed is searched for in a thread: real time too has to go by."""
    for _ in range(2000):
        if holds():
            return
        bench.tick()
        time.sleep(0.0005)
    raise AssertionError(bench.state["move"])

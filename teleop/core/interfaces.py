"""The stages of the pipeline, as the loop sees them: source, planner, sink, reporter, observer; links and the clock.

Protocols, not base classes: a fake in a test is any object of the right shape, and no class inherits a stub.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Protocol

from teleop.core.axes import Axis, Motion, Reading, State
from teleop.core.events import SourceEvent, Tick
from teleop.core.setpoints import Demand


@dataclass(frozen=True, slots=True)
class Feedback:
    """What a source knows of the axes: `motion` as the tick before commanded it, `readings` the last of each axis."""

    motion: Motion
    readings: Mapping[Axis, Reading]


class Source(Protocol):
    """Decides what the axes should do. Times are the loop's clock, in seconds."""

    def start(self, now: float, motion: Motion) -> None:
        """The run begins at `now`, with the axes where `motion` says."""
        ...

    def read(self, now: float, feedback: Feedback, /) -> tuple[Demand, Sequence[SourceEvent]]:
        """The demand for the tick that ends at `now`, and the events due since the last read.

        What is raised here ends the run, without losing the tick: the ramp to rest begins in it.
        """
        ...

    def next_change(self, now: float) -> float:
        """When to read again: `now` while every tick matters, a later time while resting, inf when done."""
        ...


class Observer(Protocol):
    """Looks at each tick, after every sink has sent it, and sends nothing. What it raises ends the run."""

    def observe(self, tick: Tick) -> None: ...


class Sink(Protocol):
    """Makes a device do it."""

    def write(self, tick: Tick) -> None: ...

    def release(self, now: float) -> float | None:
        """Do the next step of releasing the device; when to do the one after, or None when there is none left.

        Safe to call at any time and again after it is done.
        """
        ...


class Planner(Protocol):
    """Turns a demand into the next legal motion; `teleop.planner.live.Live`, or a fake of it."""

    @property
    def at_rest(self) -> bool: ...

    def reset(self, motion: Motion) -> None: ...

    def step(self, demand: Demand, dt_steps: int = 1) -> Mapping[Axis, State]:
        """The motion `dt_steps` periods later, within the limits of every axis."""
        ...


class Reporter(Protocol):
    """Measures where the axes are."""

    def report(self, now: float) -> Mapping[Axis, Reading]:
        """The last reading of each axis; an axis that has none yet is absent.

        Raises LinkError when the device has been silent for too long.
        """
        ...


class Link(Protocol):
    """Carries bytes, whole frames out and whatever has arrived in. Neither call waits."""

    def send(self, data: bytes) -> None:
        """Raises LinkError when the bytes cannot leave."""
        ...

    def receive(self) -> bytes:
        """What has arrived since the last call, b"" for nothing. Raises LinkError when nothing ever will again."""
        ...


class Clock(Protocol):
    """Seconds from an arbitrary start, never backwards."""

    def now(self) -> float: ...

    def sleep_until(self, time: float) -> None: ...

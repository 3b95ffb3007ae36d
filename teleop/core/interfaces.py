"""What the stages of the pipeline are to each other.

Protocols, not base classes: a fake in a test is any object of the right shape, and nobody inherits a stub.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Protocol

from teleop.core.axes import Axis, Motion, Reading
from teleop.core.events import Tick, TickEvent
from teleop.core.setpoints import Demand


class Source(Protocol):
    """Says what the axes should do. Times are the loop's clock, in seconds."""

    def start(self, now: float, motion: Motion) -> None:
        """The run begins at `now`, with the axes where `motion` says."""
        ...

    def read(self, now: float) -> tuple[Demand, Sequence[TickEvent]]:
        """The demand for the tick that ends at `now`, and the actions due since the last read."""
        ...

    def next_change(self, now: float) -> float:
        """When to read again: `now` while every tick matters, a later time while resting, inf when done."""
        ...


class Sink(Protocol):
    """Makes a device do it."""

    def write(self, tick: Tick) -> None: ...

    def release(self, now: float) -> float | None:
        """Do the next step of giving the device back; when to do the one after, or None when there is none left.

        Safe to call at any time and again after it is done.
        """
        ...


class Reporter(Protocol):
    """Says where the axes are."""

    def report(self, now: float) -> Mapping[Axis, Reading]:
        """The last reading of each axis; an axis not yet heard of is absent.

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

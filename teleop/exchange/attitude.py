"""The camera's measured attitude for those who send it on: at an instant, whole, and never an old one."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Mapping
from time import monotonic
from typing import Any, NamedTuple

from teleop.core.axes import Axis
from teleop.core.errors import TeleopError
from teleop.exchange.measured import Measured
from teleop.exchange.pace import slots
from teleop.exchange.served import Served

ANGLES = (Axis.PAN, Axis.TILT, Axis.ROLL)
OLD = 0.5  # s without a reading, after which nothing is sent: a receiver must not believe a camera that hangs
LENS = 1.0  # s that the focus may take to its first reading; after that the rest goes without it
LOOK = 0.01  # s between two looks for a new state
OFTEN = 0.2  # share of messages beyond the newest reading that says the latency is too short
WATCHED = 250  # messages that the share is taken of


class Attitude(NamedTuple):
    """Degrees, and the focus 0 (near) to 1 (far); None for a rig without one."""

    pan: float
    tilt: float
    roll: float
    focus: float | None


class AttitudeFeed:
    """`name` begins what is told to the operator; `latency` in s. Raises TeleopError for a rig without angles."""

    def __init__(self, served: Served, name: str, latency: float) -> None:
        self._served, self._name, self._latency = served, name, latency
        self._measured = Measured()
        self._angles = [axis for axis in ANGLES if axis in served.rig.limits]
        self._has_focus = Axis.FOCUS in served.rig.limits
        if not self._angles:
            raise TeleopError("the rig has no pan, tilt or roll")
        self._state: Mapping[str, Any] = {}
        self._known_since: float | None = None
        self._sends = False
        self._began = False
        self._sent = self._beyond = 0
        self._hinted = False

    @property
    def state(self) -> Mapping[str, Any]:
        """The state that was taken last."""
        return self._state

    async def each(self, rate: float, send: Callable[[float, Attitude], object]) -> None:
        """Until cancelled: `rate` times a second `send` the instant `latency` ago, and the attitude then if known."""
        watching = asyncio.create_task(self._watch())
        try:
            async for due in slots(rate):
                instant = due - self._latency
                if (at := self.at(instant)) is not None:
                    send(instant, at)
        finally:
            watching.cancel()

    async def _watch(self) -> None:
        """Take each state as it comes."""
        while True:
            self.take()
            await asyncio.sleep(LOOK)

    def take(self) -> None:
        state = self._served.door.newest()
        if state is not self._state:
            self._state = state
            self._measured.take(state)
            known = state.get("axes", {})
            if not all(axis.value in known for axis in self._angles):  # the run does not move all of them
                for axis, reading in self._served.door.readings().items():
                    self._measured.add(axis, reading.time, reading.position)

    def at(self, instant: float) -> Attitude | None:
        """Where the camera was at `instant` (s, monotonic clock); None where that is not known, or no longer."""
        self.take()
        found = [self._measured.at(axis, instant) for axis in self._angles]
        newest = self._measured.newest(self._angles)
        now = monotonic()
        if newest is None or not self._measured.knows(self._angles) or None in found:
            return None
        if now - newest > OLD:
            self._pause(now - newest)
            return None
        self._known_since = now if self._known_since is None else self._known_since
        focus = self._measured.at(Axis.FOCUS, instant) if self._has_focus else None
        if self._has_focus and focus is None and now - self._known_since < LENS:
            return None
        self._begin()
        by_axis = dict(zip(self._angles, found, strict=True))
        self._count(any(each is not None and each.beyond for each in found))
        places = [at.position if (at := by_axis.get(axis)) is not None else 0.0 for axis in ANGLES]
        pan, tilt, roll = places
        return Attitude(pan, tilt, roll, None if focus is None else min(max(focus.position, 0.0), 1.0))

    def _begin(self) -> None:
        if self._began and not self._sends:
            self._served.notify(f"{self._name}: the gimbal reports again: messages go on")
        self._sends = self._began = True

    def _pause(self, age: float) -> None:
        if self._sends:
            self._served.notify(
                f"{self._name}: the newest reading is {age:.1f} s old: nothing is sent until the gimbal reports again"
            )
        self._sends = False

    def _count(self, beyond: bool) -> None:
        self._sent += 1
        self._beyond += beyond
        if self._sent < WATCHED:
            return
        if self._beyond > OFTEN * self._sent and not self._hinted:
            self._hinted = True
            self._served.notify(
                f"{self._name}: {self._beyond / self._sent:.0%} of the messages are ahead of the newest reading and"
                f" were estimated: a latency above {self._latency:g} s would have them measured"
            )
        self._sent = self._beyond = 0

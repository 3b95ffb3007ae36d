"""Frames on their way out through a port that may be full for a moment.

A CAN interface queues ten frames by default (Linux txqueuelen), fewer than one tick's commands to gimbal, focus and
camera, so "full" is normal and lasts a millisecond. Waiting would delay the control loop, and giving up in the middle
of a frame would put damage on the bus. So what does not fit stays here, whole and in order, and is offered again on
every later call.

Of a stream only the latest frame of each kind waits, in the place of the one before it: what a gimbal is
sent is then never old, however slow the bus is, only rarer. Orders are never overtaken: a stream frame does not go
ahead of an order that was given before it. A frame for which there is no room is dropped whole, a question before an
order. A port that goes on taking less than it is given is `behind`.

Only a port that takes nothing at all for 250 ms
is an error, which is half the time for which a DJI gimbal obeys its last speed command; and unlike an unplugged
adapter it may work again, so each later frame is a new attempt.
"""

from __future__ import annotations

import math
import threading
from collections import Counter
from collections.abc import Callable, Hashable
from dataclasses import dataclass
from enum import Enum, auto

from teleop.core.errors import LinkError

BUSY_TIMEOUT = 0.25  # s for which a bus may be full or off before the link counts as lost
CAPACITY = 1024  # bytes held back: one frame of the greatest length (1023), or some forty commands

BEHIND = 2.0  # s for which frames have to be superseded or dropped again and again
BREAK = 1.0  # s without that, after which it is over


class Traffic(Enum):
    """What a frame is to its link."""

    ORDER = auto()  # leaves, in its turn
    QUESTION = auto()  # the same, but may be overtaken, and is dropped first where there is no room
    STREAM = auto()  # is worthless once there is a newer one of its kind


@dataclass(slots=True)
class _Waiting:
    data: bytes
    traffic: Traffic
    kind: Hashable


class StalledError(LinkError):
    """A bus that has been full or off for BUSY_TIMEOUT; it may come back."""


class Stall:
    """Since when something has been going wrong without a break, by the clock `now` in seconds.

    `proved` says that `check` has raised, and that it has not ended since.
    """

    def __init__(self, now: Callable[[], float]) -> None:
        self.proved = False
        self._now = now
        self._since: float | None = None

    def begin(self) -> None:
        """It goes wrong now; that it already did is remembered."""
        if self._since is None:
            self._since = self._now()

    def end(self) -> None:
        self._since = None
        self.proved = False

    def check(self, text: str) -> None:
        """Raises StalledError(text) once it has lasted for BUSY_TIMEOUT."""
        if self._since is not None and self._now() - self._since >= BUSY_TIMEOUT:
            self.proved = True
            raise StalledError(text)


class Outbox:
    """Cuts frames into pieces and puts them, in order, into a port that may refuse.

    `put` takes a piece of at most `piece` bytes and returns how many of them the port accepted, 0 for none; what it
    raises passes through. `now` is a clock in seconds. `counts` gets `full` (times the port refused), `superseded`
    (frames of a stream that a newer one replaced before they left), `dropped` (other frames of which nothing left) and
    `cut` (frames that were given up after a part of them had left). `behind` says that it was, for a while.
    """

    def __init__(self, name: str, put: Callable[[bytes], int], piece: int, now: Callable[[], float]) -> None:
        self.counts: Counter[str] = Counter()
        self.behind = False
        self._name = name
        self._put = put
        self._piece = piece
        self._now = now
        self._lock = threading.Lock()  # over a whole frame: two must never interleave on the bus
        self._frames: list[_Waiting] = []  # of the first, a part may have left: see _begun
        self._begun = False
        self._held = 0  # bytes in _frames
        self._full = Stall(now)
        self._behind_since = self._behind_last = -math.inf

    def send(self, frame: bytes, traffic: Traffic = Traffic.ORDER, kind: Hashable = None) -> bool:
        """Sends the frame, or as much of it as the port takes now; whether it replaced one of its `kind`.

        Raises StalledError while the port takes nothing.
        """
        with self._lock:
            replaced = traffic is Traffic.STREAM and self._replace(frame, kind)
            if not replaced:
                self._frames.append(_Waiting(frame, traffic, kind))
                self._held += len(frame)
            self._flush()
            self._make_room()
        return replaced

    def flush(self) -> None:
        """Offers what is held back again. Raises StalledError while the port takes nothing."""
        if self._frames:
            with self._lock:
                self._flush()

    def abandon(self) -> None:
        """Gives up what is held back: the port is stalled, lost or closed, and it would be stale afterwards."""
        with self._lock:
            self.counts += Counter(cut=int(self._begun), dropped=len(self._frames) - self._begun)  # in place, no zeros
            self._frames.clear()
            self._held, self._begun = 0, False

    def _replace(self, frame: bytes, kind: Hashable) -> bool:
        """Put a stream's frame in the place of the one that waits, unless an order waits behind that."""
        for index in range(len(self._frames) - 1, int(self._begun) - 1, -1):
            waiting = self._frames[index]
            if waiting.traffic is Traffic.ORDER:
                return False
            if waiting.traffic is Traffic.STREAM and waiting.kind == kind:
                self._held += len(frame) - len(waiting.data)
                waiting.data = frame
                self._lose("superseded")
                return True
        return False

    def _make_room(self) -> None:
        while len(self._frames) > 1 and self._held > CAPACITY:
            places = range(len(self._frames) - 1, 0, -1)  # the newest first; the first may have begun to leave
            by_traffic = {self._frames[place].traffic: place for place in reversed(places)}
            place = by_traffic.get(Traffic.QUESTION, by_traffic.get(Traffic.ORDER))
            if place is None:
                return
            self._held -= len(self._frames.pop(place).data)
            self._lose("dropped")

    def _lose(self, how: str) -> None:
        self.counts[how] += 1
        now = self._now()
        if now - self._behind_last > BREAK:
            self._behind_since = now
        self._behind_last = now
        self.behind |= now - self._behind_since >= BEHIND

    def _flush(self) -> None:
        while self._frames:
            first = self._frames[0]
            accepted = self._put(first.data[: self._piece])
            if not accepted:
                self.counts["full"] += 1
                self._full.begin()
                self._full.check(
                    f"{self._name}: nothing has left for {BUSY_TIMEOUT * 1000:.0f} ms, the bus is full or off"
                )
                return
            self._full.end()
            self._held -= accepted
            self._begun = accepted < len(first.data)
            if self._begun:
                first.data = first.data[accepted:]
            else:
                self._frames.pop(0)

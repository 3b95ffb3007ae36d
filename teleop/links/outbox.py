"""Frames on their way out through a port that may be full for a moment.

A CAN interface queues ten frames by default (Linux txqueuelen), fewer than one tick's commands to gimbal, focus and
camera, so "full" is normal and lasts a millisecond. Waiting would delay the control loop, and giving up in the middle
of a frame would put damage on the bus. So what does not fit stays here, whole and in order, and is offered again on
every later call; a frame for which there is no room is dropped whole. Only a port that takes nothing at all for 250 ms
is an error, which is half the time for which a DJI gimbal obeys its last speed command; and unlike an unplugged
adapter it may work again, so each later frame is a new attempt.
"""

from __future__ import annotations

import threading
from collections import Counter, deque
from collections.abc import Callable

from teleop.ports import LinkError

PATIENCE = 0.25  # s for which a bus may be full or off before the link counts as lost
CAPACITY = 1024  # bytes held back: one frame of the greatest length (1023), or some forty commands


class StalledError(LinkError):
    """A bus that has been full or off for PATIENCE; it may come back."""


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
        """Raises StalledError(text) once it has lasted for PATIENCE."""
        if self._since is not None and self._now() - self._since >= PATIENCE:
            self.proved = True
            raise StalledError(text)


class Outbox:
    """Cuts frames into pieces and puts them, in order, into a port that may refuse.

    `put` takes a piece of at most `piece` bytes and returns how many of them the port accepted, 0 for none; what it
    raises passes through. `now` is a clock in seconds. `counts` gets `full` (times the port refused), `dropped` (frames
    of which nothing left) and `cut` (frames that were given up after a part of them had left).
    """

    def __init__(self, name: str, put: Callable[[bytes], int], piece: int, now: Callable[[], float]) -> None:
        self.counts: Counter[str] = Counter()
        self._name = name
        self._put = put
        self._piece = piece
        self._lock = threading.Lock()  # over a whole frame: two must never interleave on the bus
        self._frames: deque[bytes] = deque()  # of the first, a part may have left: see _begun
        self._begun = False
        self._held = 0  # bytes in _frames
        self._full = Stall(now)

    def send(self, frame: bytes) -> None:
        """Sends the frame, or as much of it as the port takes now. Raises StalledError while the port takes nothing."""
        with self._lock:
            self._frames.append(frame)
            self._held += len(frame)
            self._flush()
            if len(self._frames) > 1 and self._held > CAPACITY:
                self._held -= len(self._frames.pop())
                self.counts["dropped"] += 1

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

    def _flush(self) -> None:
        while self._frames:
            rest = self._frames[0]
            accepted = self._put(rest[: self._piece])
            if not accepted:
                self.counts["full"] += 1
                self._full.begin()
                self._full.check(f"{self._name}: nothing has left for {PATIENCE * 1000:.0f} ms, the bus is full or off")
                return
            self._full.end()
            self._held -= accepted
            self._begun = accepted < len(rest)
            if self._begun:
                self._frames[0] = rest[accepted:]
            else:
                self._frames.popleft()

"""What links over a real port have in common: an outbox, and a first fatal error that is never forgotten.

The libraries below do not repeat themselves (an unplugged CAN adapter raises once, then reads as silence), so the error
that ended a link is kept here and raised on every later call. A bus that is full or off is no such end: the error lasts
as long as the fault, and what could not leave meanwhile is given up, because a stale command is worse than none. A
transport supplies three things: put, take and shut.
"""

from __future__ import annotations

import contextlib
from abc import ABC, abstractmethod
from collections import Counter
from collections.abc import Callable, Hashable, Iterator

from teleop.core.errors import LinkError
from teleop.links.faults import link_failed
from teleop.links.outbox import Outbox, StalledError, Traffic
from teleop.links.url import LinkAddress


class BufferedLink(ABC):
    """A `Link` whose sends may be held back for a moment, and its counts: see Outbox."""

    _failures: tuple[type[Exception], ...] = (OSError,)  # of the library below, meaning that the link is lost

    def __init__(self, address: LinkAddress, piece: int, now: Callable[[], float]) -> None:
        self.address = address
        self._outbox = Outbox(str(address), self._put, piece, now)
        self.counts: Counter[str] = self._outbox.counts
        self._lost: str | None = None

    def send(self, data: bytes) -> None:
        """Sends one whole frame. Raises LinkError when the link is lost or closed, and while the bus is full or off.

        What could not be sent when it raises is dropped.
        """
        with self._latching():
            self._outbox.send(data)

    def send_as(self, data: bytes, traffic: Traffic, kind: Hashable) -> bool:
        """Sends one whole frame as `send` does; whether it replaced one of its `kind` that had not left: see Outbox."""
        with self._latching():
            return self._outbox.send(data, traffic, kind)

    @property
    def behind(self) -> bool:
        """Whether it has been taking less than it was given, for seconds."""
        return self._outbox.behind

    def receive(self) -> bytes:
        """What has arrived, b"" for nothing. Raises LinkError when the link is lost or closed, or the bus is off.

        A full bus shows only while something waits to be sent.
        """
        with self._latching():
            self._outbox.flush()
            return self._take()

    def close(self) -> None:
        """Offers what was held back once more, then closes. Any later call raises LinkError; closing again is fine."""
        if self._lost is None:
            with contextlib.suppress(LinkError), self._latching():  # counted as cut or dropped; no caller is left
                self._outbox.flush()
        self._outbox.abandon()
        self._lost = f"{self.address}: closed"
        with contextlib.suppress(*self._failures):  # the port may be gone, which is as good as closed
            self._shut()

    @contextlib.contextmanager
    def _latching(self) -> Iterator[None]:
        if self._lost is not None:
            raise LinkError(self._lost)
        try:
            yield
        except StalledError:
            self._outbox.abandon()
            raise
        except (LinkError, *self._failures) as error:
            fault = error if isinstance(error, LinkError) else link_failed(self.address, error)
            self._lost = str(fault)
            self._outbox.abandon()
            raise fault from error

    @abstractmethod
    def _put(self, piece: bytes) -> int:
        """How many bytes of the piece the port accepted, without waiting."""

    @abstractmethod
    def _take(self) -> bytes:
        """What has arrived, without waiting."""

    @abstractmethod
    def _shut(self) -> None:
        """Closes the port; a port that is closed stays so."""

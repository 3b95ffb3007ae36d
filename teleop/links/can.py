"""A DJI frame on a CAN bus: consecutive 8-byte standard frames, the last one short, nothing that counts them.

The ids are all that tells a gimbal's frames from the rest: two processes on one host see each other's marked as sent,
and udp_multicast echoes one's own unmarked. What differs from adapter to adapter is behind `Adapter`: python-can
knows every adapter but slcan's is done here (see `slcan`), and each is imported only when a link to one is opened.
"""

from __future__ import annotations

import contextlib
from collections import Counter
from collections.abc import Callable, Collection
from typing import NamedTuple, Protocol

from teleop.links.buffered import BufferedLink
from teleop.links.faults import link_failed
from teleop.links.url import LinkAddress

HOST_ID = 0x223  # what the host sends: DJI R SDK Protocol V2.5, section 3.1, figure 38
GIMBAL_ID = 0x222

ECHOING = ("udp_multicast",)  # the interfaces on which one's own frames come back
_PIECE = 8  # bytes in a CAN frame


class Arrival(NamedTuple):
    """A CAN frame that arrived. `ordinary` means: with a standard id, and carrying data."""

    id: int
    ordinary: bool
    data: bytes


class BusFrame(NamedTuple):
    """Any frame of a bus, for a capture. `stamp` is when the adapter received it, s since 1970, None if unknown."""

    id: int
    data: bytes
    extended: bool = False
    remote: bool = False
    error: bool = False  # a report of the adapter's, not a frame of the bus; its id has the classes of error
    stamp: float | None = None


Tap = Callable[[BusFrame], object]


class Adapter(Protocol):
    """One CAN adapter, open. Calls raise LinkError, OSError or one of `failures` when it is lost, and never wait.

    They raise StalledError while the bus is off: both calls do, and either notices when it is back. `tap` is called
    with every frame that is read, those that are no Arrival too.
    """

    tap: Tap | None

    @property
    def failures(self) -> tuple[type[Exception], ...]: ...

    def put(self, can_id: int, data: bytes) -> bool:
        """Sends a standard frame of up to 8 bytes; whether it was accepted, False for a queue that is full."""
        ...

    def take(self) -> list[Arrival]:
        """What has arrived, up to a number of frames that does not hold up the control loop."""
        ...

    def close(self) -> None: ...


class CanLink(BufferedLink):
    """DJI frames over CAN: sends on `transmit_id`, receives `receive_id`, counts the frames of other ids in `foreign`.

    `with_own_id` counts what arrives with `transmit_id`: its own frames, where the bus echoes them, or another host's.

    The defaults are the host's ids; a simulated gimbal has them the other way round. `counts` has the outbox's and the
    adapter's: `damage` (what arrived was no CAN frame), `error frames`, `bus off`, `refused`. `now` is a clock in
    seconds. Raises LinkError when the bus cannot be opened. `tap` is called with every frame of the bus, those sent
    here too.
    """

    def __init__(
        self,
        address: LinkAddress,
        transmit_id: int = HOST_ID,
        receive_id: int = GIMBAL_ID,
        *,
        now: Callable[[], float],
    ) -> None:
        super().__init__(address, _PIECE, now)
        self.foreign: Counter[int] = Counter()
        self.with_own_id = 0
        self._transmit_id, self._receive_id = transmit_id, receive_id
        self._adapter = _open(address, self.counts, now)
        self._failures = self._adapter.failures

    @property
    def tap(self) -> Tap | None:
        return self._adapter.tap

    @tap.setter
    def tap(self, tap: Tap | None) -> None:
        self._adapter.tap = tap

    def send_foreign(self, can_id: int, data: bytes) -> None:
        """Sends one CAN frame of another id; a full queue drops it. Raises LinkError when the link is lost."""
        with self._latching():
            self._adapter.put(can_id, data)

    def send_error(self) -> None:
        """Sends an error frame, where the adapter can. Raises LinkError when the link is lost."""
        if send := getattr(self._adapter, "put_error", None):
            with self._latching():
                send()

    def _put(self, piece: bytes) -> int:
        if not self._adapter.put(self._transmit_id, piece):
            return 0
        if self._adapter.tap and self.address.interface not in ECHOING:  # an echo is heard when it comes back
            self._adapter.tap(BusFrame(self._transmit_id, piece))
        return len(piece)

    def _take(self) -> bytes:
        return b"".join(arrival.data for arrival in self._adapter.take() if self._is_ours(arrival))

    def _shut(self) -> None:
        self._adapter.close()

    def _is_ours(self, arrival: Arrival) -> bool:
        if arrival.ordinary and arrival.id == self._receive_id:
            return True
        if arrival.ordinary and arrival.id == self._transmit_id:
            self.with_own_id += 1
        else:
            self.foreign[arrival.id] += 1
        return False


class CanListener:
    """Hears what others say on a CAN bus, in both directions, and transmits nothing (an adapter may still acknowledge).

    Frames of other ids than `ids` are counted in `foreign`. `tap` is called with every frame, in their order. `counts`
    and `now` are as for CanLink. Raises LinkError when the bus cannot be opened.
    """

    def __init__(
        self,
        address: LinkAddress,
        ids: Collection[int] = (HOST_ID, GIMBAL_ID),
        *,
        now: Callable[[], float],
        tap: Tap | None = None,
    ) -> None:
        self.foreign: Counter[int] = Counter()
        self.counts: Counter[str] = Counter()
        self._address, self._ids = address, ids
        self._adapter = _open(address, self.counts, now)
        self._adapter.tap = tap

    def receive(self) -> list[tuple[int, bytes]]:
        """The id and data of each CAN frame since the last call, in their order. Raises LinkError when it is lost."""
        try:
            arrived = self._adapter.take()
        except (OSError, *self._adapter.failures) as error:
            raise link_failed(self._address, error) from error
        heard = []
        for arrival in arrived:
            if arrival.ordinary and arrival.id in self._ids:
                heard.append((arrival.id, arrival.data))
            else:
                self.foreign[arrival.id] += 1
        return heard

    def close(self) -> None:
        with contextlib.suppress(OSError, *self._adapter.failures):  # the port may be gone, which is as good as closed
            self._adapter.close()


def _open(address: LinkAddress, counts: Counter[str], now: Callable[[], float]) -> Adapter:
    if address.interface == "slcan":
        from teleop.links.slcan import open_slcan

        return open_slcan(address, counts, now)
    from teleop.links.python_can import PythonCanAdapter

    return PythonCanAdapter(address, counts, now)

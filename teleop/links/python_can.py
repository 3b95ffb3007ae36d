"""Every CAN adapter that python-can knows, with its habits ended here.

- `recv` says None for "nothing there" and for "something that is no CAN frame" alike, so whether to read on is asked of
  the file descriptor, where there is one;
- bytes that make no CAN frame raise (a stranger's datagram on udp_multicast): counted, and reading goes on;
- a bus that is off still takes frames into its queue, so its error frame starts the 250 ms that a full bus has; only
  what is read can say that it is back, so after that a sender looks too.
"""

from __future__ import annotations

import contextlib
import errno
import logging
import select
from collections import Counter
from collections.abc import Callable, Iterator, Mapping
from typing import Any

import can

from teleop.links.can import Arrival, BusFrame, Tap
from teleop.links.faults import driver_missing, opening_failed, system_error
from teleop.links.outbox import Stall
from teleop.links.url import LinkAddress

_BURST = 512  # reads in one call: a babbling bus must not hold up the control loop
_BUS_OFF, _RESTARTED = 0x40, 0x100  # classes of an error frame, in its id: Linux's can/error.h
_MOMENTARY = (None, errno.ENOBUFS, errno.EAGAIN)  # a full queue; None: no number, as in socketcan's "buffer full"
_OPTIONS: Mapping[str, Mapping[str, Any]] = {
    "udp_multicast": {"hop_limit": 0, "fd": False},  # programs on this host talk, nothing leaves it
}


class PythonCanAdapter:
    """A teleop.links.can.Adapter. Counts `damage`, `error frames` and `bus off`.

    Raises LinkError when the bus cannot be opened.
    """

    failures = (can.CanError, OSError)

    def __init__(self, address: LinkAddress, counts: Counter[str], now: Callable[[], float]) -> None:
        self._address = address
        self._counts = counts
        self._off = Stall(now)
        self._arrived: list[Arrival] = []
        self.tap: Tap | None = None
        self._bus = _open(address)
        try:
            self._descriptor = self._bus.fileno()
        except NotImplementedError:
            self._descriptor = None

    def put(self, can_id: int, data: bytes) -> bool:
        if self._off.proved:
            self._read()
            self._check()
        message = can.Message(arbitration_id=can_id, is_extended_id=False, data=data)
        try:
            self._bus.send(message, timeout=0)
        except self.failures as error:
            cause = system_error(error)
            if cause is None or cause.errno in _MOMENTARY:
                return False
            raise
        return True

    def put_error(self) -> None:
        """Send an error frame; one that cannot be sent is left out."""
        with contextlib.suppress(can.CanError, NotImplementedError):
            self._bus.send(can.Message(is_error_frame=True), timeout=0)

    def take(self) -> list[Arrival]:
        self._read()
        self._check()
        arrived, self._arrived = self._arrived, []
        return arrived

    def close(self) -> None:
        self._bus.shutdown()

    def _read(self) -> None:
        for message in self._messages():
            if self.tap:
                self.tap(_bus_frame(message))
            if message.is_error_frame:
                self._note_state(message.arbitration_id)
                continue
            self._off.end()
            ordinary = not (message.is_extended_id or message.is_remote_frame)
            self._arrived.append(Arrival(message.arbitration_id, ordinary, bytes(message.data)))

    def _check(self) -> None:
        self._off.check(f"{self._address}: the bus is off: check wiring, bit rate and the 120 ohm termination")

    def _messages(self) -> Iterator[can.Message]:
        for _ in range(_BURST):
            if self._descriptor is not None and not select.select([self._descriptor], [], [], 0)[0]:
                return
            try:
                message = self._bus.recv(timeout=0)
            except (*self.failures, ValueError, IndexError) as error:
                if not _is_damage(error):
                    raise
                self._counts["damage"] += 1
                continue
            if message is not None:
                yield message
            elif self._descriptor is None:
                return

    def _note_state(self, classes: int) -> None:
        if classes & _BUS_OFF:
            self._counts["bus off"] += 1
            self._off.begin()
        elif classes & _RESTARTED:
            self._off.end()
        else:
            self._counts["error frames"] += 1


def _bus_frame(message: can.Message) -> BusFrame:
    return BusFrame(
        message.arbitration_id,
        bytes(message.data),
        message.is_extended_id and not message.is_error_frame,
        message.is_remote_frame,
        message.is_error_frame,
        message.timestamp or None,
    )


def _open(address: LinkAddress) -> can.BusABC:
    logger = logging.getLogger("can")
    if not logger.isEnabledFor(logging.DEBUG):
        logger.setLevel(logging.CRITICAL)  # what it logs as an error it also raises, and our line says it better
    channel = int(address.channel) if address.channel.isdecimal() else address.channel
    options = _OPTIONS.get(address.interface, {})
    try:
        return can.Bus(channel, interface=address.interface, bitrate=address.bitrate, ignore_config=True, **options)
    except (ImportError, NameError, can.CanInterfaceNotImplementedError) as error:  # NameError: kvaser's own way
        raise driver_missing(address) from error
    except (can.CanError, OSError, ValueError) as error:
        raise opening_failed(address, error) from error


def _is_damage(error: Exception) -> bool:
    """Whether what arrived was at fault: the error is a parser's, or wraps one, and no port failed behind it."""
    parser_failed = isinstance(error, (ValueError, IndexError)) or error.__cause__ is not None
    return parser_failed and system_error(error) is None

"""A plain serial line, for devices that speak DJI frames without CAN, and the port under it.

pyserial's own zero write timeout spins for ever on a full port, so writability is asked first; `in_waiting` after an
unplug raises past pyserial's exceptions, so it is never asked. The port is locked: a second program on the same line
would mix its bytes into our frames.
"""

from __future__ import annotations

import errno
import select
from collections import Counter
from collections.abc import Callable
from typing import Protocol

import serial

from teleop.links import FAR_END, NEAR_END
from teleop.links.buffered import BufferedLink
from teleop.links.faults import opening_failed
from teleop.links.url import LinkAddress

_PIECE = 4096  # bytes in one write, more than the longest frame
_WAITING = 256  # bytes the kernel may hold: at 115200 bit/s 22 ms of commands, of which none can be made newer
_READ = 65536  # bytes in one call, more than a kernel buffers


class Port(Protocol):
    """A stream of bytes that never waits. Every call may raise OSError."""

    def write(self, data: bytes) -> int:
        """How many of the bytes it took."""
        ...

    def read(self) -> bytes:
        """What has arrived."""
        ...

    def close(self) -> None: ...


class SerialPort:
    """A Port on a serial line of 8 bits and one stop bit, opened exclusively; `parity` is pyserial's letter.

    While more than `most_waiting` bytes wait in the kernel it takes none. Raises OSError or ValueError when it cannot
    be opened.
    """

    def __init__(self, path: str, baud: int, parity: str = serial.PARITY_NONE, most_waiting: int = _WAITING) -> None:
        self._port = serial.Serial(path, baud, parity=parity, timeout=0, write_timeout=0, exclusive=True)
        self._most_waiting = most_waiting

    def write(self, data: bytes) -> int:
        if not select.select([], [self._port], [], 0)[1] or self._waiting() > self._most_waiting:
            return 0
        return self._port.write(data) or 0

    def _waiting(self) -> int:
        """Bytes that the kernel has taken and the line has not; 0 where it does not say."""
        try:
            return self._port.out_waiting
        except OSError as error:
            if error.errno in (errno.ENOTTY, errno.EINVAL):
                return 0
            raise

    def read(self) -> bytes:
        return self._port.read(_READ)

    def fileno(self) -> int:
        """What an event loop waits for. Raises OSError where the system has none."""
        return self._port.fileno()

    def close(self) -> None:
        self._port.close()


class SerialLink(BufferedLink):
    """Bytes over a serial line, at the address's baud rate. Raises LinkError when it cannot be opened.

    `tap` is called with all bytes that pass, and before them NEAR_END or FAR_END, which sent them.
    """

    def __init__(self, address: LinkAddress, *, now: Callable[[], float]) -> None:
        super().__init__(address, _PIECE, now)
        self.tap: Callable[[int, bytes], object] | None = None
        try:
            self._port = SerialPort(address.channel, address.bitrate)
        except (OSError, ValueError) as error:
            raise opening_failed(address, error) from error

    def _put(self, piece: bytes) -> int:
        count = self._port.write(piece)
        if count and self.tap:
            self.tap(NEAR_END, piece[:count])
        return count

    def _take(self) -> bytes:
        data = self._port.read()
        if data and self.tap:
            self.tap(FAR_END, data)
        return data

    def _shut(self) -> None:
        self._port.close()


class SerialListener:
    """Hears what the far end of a serial line says, and transmits nothing: the other direction has a wire of its own.

    It needs the port for itself. `foreign` stays empty. `tap` is called with all bytes that arrive. Raises LinkError
    when it cannot be opened.
    """

    def __init__(
        self, address: LinkAddress, *, now: Callable[[], float], tap: Callable[[bytes], object] | None = None
    ) -> None:
        self.foreign: Counter[int] = Counter()
        self._link = SerialLink(address, now=now)
        if tap:
            self._link.tap = lambda _sender, data: tap(data)
        self.counts = self._link.counts

    def receive(self) -> list[tuple[int, bytes]]:
        """What has arrived since the last call. Raises LinkError when the line is lost."""
        data = self._link.receive()
        return [(FAR_END, data)] if data else []

    def close(self) -> None:
        self._link.close()

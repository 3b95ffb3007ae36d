"""The far end of a serial line that exists in this computer alone: a pseudo-terminal, for a simulated device.

Both ends are kept open, so that the program at the near end may come, be killed and come again as on a real line. What
is not read is dropped, as a UART drops it: a device must never wait for its listener.
"""

from __future__ import annotations

import os
from collections import Counter

_READ = 65536  # bytes in one call, more than a kernel buffers


class PtyLink:
    """A link to the program that opens the serial port `path`. Raises OSError where there are no pseudo-terminals."""

    def __init__(self) -> None:
        try:
            import tty
        except ImportError:
            raise OSError("this system has no pseudo-terminals") from None
        self.counts: Counter[str] = Counter()
        self._master, self._slave = os.openpty()
        tty.setraw(self._slave)  # before anybody opens it: an echo would come back as received
        os.set_blocking(self._master, False)
        self.path = os.ttyname(self._slave)

    def send(self, data: bytes) -> None:
        try:
            sent = os.write(self._master, data)
        except BlockingIOError:
            sent = 0
        self.counts["dropped"] += len(data) - sent

    def receive(self) -> bytes:
        try:
            return os.read(self._master, _READ)
        except BlockingIOError:
            return b""

    def close(self) -> None:
        for descriptor in {self._master, self._slave} - {-1}:
            os.close(descriptor)
        self._master = self._slave = -1

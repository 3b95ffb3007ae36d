"""Datagrams between the control process and its clients. Neither side ever waits for the other.

A queue that is full is the sender's to deal with: the control process drops an answer and counts it, a client keeps
what it has to send and tries again.
"""

from __future__ import annotations

import os
import socket
from collections.abc import Iterator
from typing import NamedTuple

LARGEST = 2000  # bytes of a datagram: macOS takes 2048 at most


class Datagram(NamedTuple):
    data: bytes
    address: str  # where an answer goes, "" for a sender without a name


class CommandSocket:
    """Where the control process takes commands; `lost` counts answers that did not fit into a client's queue."""

    def __init__(self, path: str) -> None:
        self._socket = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)
        self._socket.setblocking(False)
        self._socket.bind(path)
        os.chmod(path, 0o600)
        self.lost = 0

    def receive(self, most: int) -> Iterator[Datagram]:
        """What has arrived, `most` datagrams of it."""
        for _ in range(most):
            try:
                data, address = self._socket.recvfrom(LARGEST + 1)
            except OSError:  # nothing there, or a socket whose other end fails: both are nothing to take
                return
            yield Datagram(data, address if isinstance(address, str) else "")

    def answer(self, data: bytes, address: str) -> None:
        if not address:
            return
        try:
            self._socket.sendto(data, address)
        except OSError:  # its queue is full, or it is gone
            self.lost += 1

    def close(self) -> None:
        self._socket.close()


def client_socket(own: str, commands: str) -> socket.socket:
    """A socket that sends to `commands` and gets the answers. Raises OSError where there is no control process."""
    made = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)
    try:
        made.setblocking(False)
        made.bind(own)
        os.chmod(own, 0o600)
        made.connect(commands)
    except OSError:
        made.close()
        raise
    return made

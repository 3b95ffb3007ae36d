"""Datagrams between the control process and its clients. Neither side ever waits for the other.

A queue that is full is the sender's to deal with: the control process drops an answer and counts it, a client keeps
what it has to send and tries again. They are sockets in the door's folder, which only this user can reach. Where a
system has none (Windows), they are UDP of 127.0.0.1, which every user of the computer reaches: so each of them begins
with a secret, which stands in a file of the door's folder (mode 0600); what has another one is dropped and counted.

A client in the folder is not connected: to one that is, Linux sends until the *sender's* memory is used up, so a client
that reads nothing kept all answers from all others. One that is not has room for ten answers (`max_dgram_qlen`).
"""

from __future__ import annotations

import os
import secrets
import socket
import sys
from collections.abc import Iterator
from hmac import compare_digest
from pathlib import Path
from typing import NamedTuple

LARGEST = 2000  # bytes of a datagram: macOS takes 2048 at most
SECRET = 16  # bytes: cannot be guessed
LOOPBACK = "127.0.0.1"
FORCED = "TELEOP_DOOR"  # of the environment: "udp" has UDP everywhere


def by_udp() -> bool:
    """Whether doors are UDP here."""
    return os.environ.get(FORCED) == "udp" or sys.platform == "win32" or not hasattr(socket, "AF_UNIX")


class Datagram(NamedTuple):
    data: bytes
    address: str  # where an answer goes, "" for a sender without a name


class CommandSocket:
    """Where the control process takes commands; `path` is the socket, or the file with port and secret.

    `lost` counts answers that did not fit into a client's queue, `foreign` what had not the secret.
    """

    def __init__(self, path: str) -> None:
        self.lost = self.foreign = 0
        self._secret = b""
        if by_udp():
            self._secret = secrets.token_bytes(SECRET)
            self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
            self._socket.bind((LOOPBACK, 0))
            _write_secret(path, self._socket.getsockname()[1], self._secret)
        else:
            self._socket = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)
            self._socket.bind(path)
            os.chmod(path, 0o600)
        self._socket.setblocking(False)

    def receive(self, most: int) -> Iterator[Datagram]:
        """What has arrived, `most` datagrams of it."""
        for _ in range(most):
            try:
                data, address = self._socket.recvfrom(SECRET + LARGEST + 1)
            except BlockingIOError:
                return
            except OSError:  # UDP tells of a client that is gone
                continue
            if (inner := _opened(data, self._secret)) is None:
                self.foreign += 1
            else:
                yield Datagram(inner, _written(address))

    def answer(self, data: bytes, address: str) -> None:
        if not address:
            return
        try:
            self._socket.sendto(self._secret + data, _read(address) if self._secret else address)
        except OSError:  # its queue is full, or it is gone
            self.lost += 1

    def close(self) -> None:
        self._socket.close()


class ClientSocket:
    """Sends to the control process, and gets its answers. `commands` is as for `CommandSocket`, `own` a name for it.

    Raises OSError where there is no control process.
    """

    def __init__(self, own: str, commands: str) -> None:
        port, self._secret = _read_secret(commands) if by_udp() else (0, b"")
        if self._secret:
            self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        else:
            self._socket = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)
        self._commands = commands
        try:
            self._socket.setblocking(False)
            if self._secret:
                self._socket.connect((LOOPBACK, port))  # answers of others are none
                return
            with socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as probe:
                probe.connect(commands)
            self._socket.bind(own)
            os.chmod(own, 0o600)
        except OSError:
            self._socket.close()
            raise

    def fileno(self) -> int:
        return self._socket.fileno()

    def setblocking(self, waits: bool) -> None:
        self._socket.setblocking(waits)

    def send(self, data: bytes) -> None:
        """Raises BlockingIOError while the queue is full, OSError where nobody is there."""
        if self._secret:
            self._socket.send(self._secret + data)
        else:
            self._socket.sendto(data, self._commands)

    def recv(self, size: int) -> bytes:
        """An answer. Raises BlockingIOError where there is none, OSError where nobody is there."""
        while (data := _opened(self._socket.recv(SECRET + size), self._secret)) is None:
            pass
        return data

    def close(self) -> None:
        self._socket.close()


def _opened(data: bytes, secret: bytes) -> bytes | None:
    """What a datagram says that has the secret, None of any other; how long it takes tells nothing of the secret."""
    return data[len(secret) :] if compare_digest(data[: len(secret)], secret) else None


def _write_secret(path: str, port: int, secret: bytes) -> None:
    descriptor = os.open(path, os.O_CREAT | os.O_EXCL | os.O_WRONLY, 0o600)
    with os.fdopen(descriptor, "w", encoding="ascii") as file:
        file.write(f"{port} {secret.hex()}\n")


def _read_secret(path: str) -> tuple[int, bytes]:
    """Raises OSError where there is no such file, or not one of these."""
    try:
        port, secret = Path(path).read_text(encoding="ascii").split()
        found = int(port), bytes.fromhex(secret)
    except (ValueError, UnicodeError):
        raise OSError(f"{path}: is no address of a door") from None
    if len(found[1]) != SECRET:
        raise OSError(f"{path}: is no address of a door")
    return found


def _written(address: object) -> str:
    """The address of a sender as text: the path of its socket, or host and port."""
    if isinstance(address, tuple):
        return f"{address[0]}:{address[1]}"
    return address if isinstance(address, str) else ""


def _read(address: str) -> tuple[str, int]:
    host, _, port = address.rpartition(":")
    return host, int(port)

"""Datagrams that are sent at a steady rate to a receiver, a broadcast address or a multicast group."""

from __future__ import annotations

import asyncio
import errno
import socket
from collections.abc import Callable

from teleop.config.exchange.address import address
from teleop.core.errors import TeleopError

LOOPBACK = "127.0.0.1"
NO_WAY = (errno.ENETUNREACH, errno.EHOSTUNREACH, errno.EADDRNOTAVAIL, errno.ENETDOWN)


class UdpSender:
    """Closed by `close`. What cannot be sent is told once by `notify`, and that it can again."""

    def __init__(
        self, made: socket.socket, to: tuple[object, ...], to_group: bool, name: str, notify: Callable[[str], None]
    ) -> None:
        self._socket, self._to, self._to_group, self._name, self._notify = made, to, to_group, name, notify
        self._failed = 0

    @property
    def header(self) -> int:
        """Bytes that the network's own headers take of a packet."""
        return 48 if self._socket.family == socket.AF_INET6 else 28

    def send(self, data: bytes) -> None:
        try:
            self._socket.sendto(data, self._to)
        except BlockingIOError:  # the next one is newer anyway
            return
        except OSError as error:
            if error.errno in NO_WAY and self._reaches_itself():
                self.send(data)
                return
            if error.errno != self._failed:
                self._notify(f"{self._name}: cannot be sent: {error.strerror or error}; it is tried on")
            self._failed = error.errno or -1
            return
        if self._failed:
            self._failed = 0
            self._notify(f"{self._name}: can be sent again")

    def _reaches_itself(self) -> bool:
        """Without a network a multicast group is there for this computer's own programs. Whether that is new."""
        if self._failed or not self._to_group or self._socket.family != socket.AF_INET:
            return False
        try:
            self._socket.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_IF, socket.inet_aton(LOOPBACK))
        except OSError:
            return False
        self._failed = -1
        self._notify(f"{self._name}: there is no network for multicast: it is sent on this computer alone")
        self._failed = 0
        return True

    def close(self) -> None:
        self._socket.close()


async def socket_for(to: str) -> tuple[socket.socket, tuple[object, ...]]:
    """A socket for datagrams to HOST:PORT, and where they go. Raises TeleopError where the host is unknown."""
    try:
        found = await asyncio.get_running_loop().getaddrinfo(*address(to), type=socket.SOCK_DGRAM)
    except (socket.gaierror, UnicodeError) as error:
        raise TeleopError(f"to {to}: unknown host: {getattr(error, 'strerror', None) or error}") from None
    family, kind, protocol, _, where = found[0]
    made = socket.socket(family, kind, protocol)
    made.setblocking(False)
    return made, where


async def udp_sender(
    to: str, name: str, notify: Callable[[str], None], interface: str | None = None, ttl: int = 1
) -> UdpSender:
    """Raises TeleopError where the host is unknown, OSError where there is no socket for it."""
    made, where = await socket_for(to)
    try:
        made.setsockopt(socket.SOL_SOCKET, socket.SO_BROADCAST, 1)
        if made.family == socket.AF_INET:
            made.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_TTL, ttl)
            if interface is not None:
                made.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_IF, socket.inet_aton(interface))
        else:
            made.setsockopt(socket.IPPROTO_IPV6, socket.IPV6_MULTICAST_HOPS, ttl)
    except OSError:
        made.close()
        raise
    return UdpSender(made, where, address(to).is_group, name, notify)

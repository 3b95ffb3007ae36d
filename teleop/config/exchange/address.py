"""Addresses in an `exchange` entry: where it listens or sends, and who may command it."""

from __future__ import annotations

import ipaddress
from typing import Annotated, NamedTuple

from pydantic import AfterValidator

from teleop.config.documents.messages import shown


class Address(NamedTuple):
    """A host, by name or number, and a port."""

    host: str
    port: int

    def __str__(self) -> str:
        """As it is written: an IPv6 host in brackets."""
        return f"[{self.host}]:{self.port}" if ":" in self.host else f"{self.host}:{self.port}"

    @property
    def is_loopback(self) -> bool:
        """Whether only this computer can reach it."""
        return is_loopback(self.host)

    @property
    def is_group(self) -> bool:
        """Whether it is a multicast group."""
        try:
            return ipaddress.ip_address(self.host).is_multicast
        except ValueError:
            return False


def address(text: str) -> Address:
    """The address that `HOST:PORT` is, an IPv6 host in brackets. Raises ValueError."""
    host, colon, port = text.rpartition(":")
    if host.startswith("[") and host.endswith("]"):
        host = host[1:-1]
        ipaddress.IPv6Address(host)
    elif ":" in host:
        colon = ""
    if not (colon and host and host.isprintable() and " " not in host and port.isascii() and port.isdigit()):
        raise ValueError(f"must be HOST:PORT, as in 192.168.1.20:9000, not {shown(text)}")
    if int(port) > 65535:
        raise ValueError(f"must have a port up to 65535, not {port}")
    return Address(host, int(port))


def is_loopback(host: str) -> bool:
    """Whether only this computer can reach the address."""
    if host == "localhost":
        return True
    try:
        return ipaddress.ip_address(host).is_loopback
    except ValueError:
        return False


def _checked(text: str) -> str:
    address(text)
    return text


def _target(text: str) -> str:
    if address(text).port == 0:
        raise ValueError("must have the receiver's port, not 0")
    return text


def _network(text: str) -> str:
    try:
        ipaddress.ip_network(text)
    except ValueError:
        raise ValueError(
            f"must be an address or a network, as in 192.168.1.20 or 192.168.1.0/24, not {shown(text)}"
        ) from None
    return text


Listen = Annotated[str, AfterValidator(_checked)]
"""HOST:PORT to listen at; port 0 picks one."""
To = Annotated[str, AfterValidator(_target)]
"""HOST:PORT to send to."""
Allowed = Annotated[str, AfterValidator(_network)]
"""An address, or a network, whose commands are taken."""


def is_allowed(peer: str, allow: list[str]) -> bool:
    """Whether commands from the address `peer` are taken: from this computer always, from others as `allow` says."""
    found = ipaddress.ip_address(peer.partition("%")[0])
    if isinstance(found, ipaddress.IPv6Address) and found.ipv4_mapped is not None:
        found = found.ipv4_mapped
    return found.is_loopback or any(found in ipaddress.ip_network(each) for each in allow)

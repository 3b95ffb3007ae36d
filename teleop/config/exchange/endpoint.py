"""Endpoints of Zenoh in a profile and on the command line: `tcp/HOST:PORT` and `tls/HOST:PORT`."""

from __future__ import annotations

from typing import Annotated, NamedTuple

from pydantic import AfterValidator

from teleop.config.documents.messages import shown
from teleop.config.exchange.address import Address, address

PROTOCOLS = ("tcp", "tls")


class Endpoint(NamedTuple):
    """How and where another Zenoh process is reached."""

    protocol: str
    address: Address

    @property
    def is_loopback(self) -> bool:
        """Whether only this computer can reach it."""
        return self.address.is_loopback


def endpoint(text: str) -> Endpoint:
    """The endpoint that `tcp/HOST:PORT` or `tls/HOST:PORT` is. Raises ValueError."""
    protocol, slash, place = text.partition("/")
    if not slash or protocol not in PROTOCOLS or set("#?/") & set(place):
        raise ValueError(f"must be tcp/HOST:PORT or tls/HOST:PORT, as in tls/192.168.1.20:7447, not {shown(text)}")
    return Endpoint(protocol, address(place))


def _checked(text: str) -> str:
    endpoint(text)
    return text


def _target(text: str) -> str:
    if endpoint(text).address.port == 0:
        raise ValueError("must have the port of the other side, not 0")
    return text


ListenAt = Annotated[str, AfterValidator(_checked)]
"""An endpoint to listen at; port 0 picks one."""
ConnectTo = Annotated[str, AfterValidator(_target)]
"""An endpoint to connect to."""

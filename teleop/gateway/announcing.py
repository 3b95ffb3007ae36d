"""What a run announces of itself: its console and its place in a fleet, as far as others can reach them."""

from __future__ import annotations

import socket
from collections.abc import Iterable
from contextlib import suppress
from typing import Any, NamedTuple

from teleop.config.exchange import ExchangeSection
from teleop.config.exchange.address import is_loopback
from teleop.config.exchange.endpoint import endpoint
from teleop.config.exchange.zenoh import ZenohSection
from teleop.gateway.discovery import ZENOH, Announcement


class ConsoleAt(NamedTuple):
    """Where a console listens; `host` is a number."""

    host: str
    port: int
    tls: bool


def announcement(rig: str, console: ConsoleAt | None, exchange: Iterable[ExchangeSection] = ()) -> dict[str, Any]:
    """For the settings of the gateway: nothing of what only this computer reaches."""
    fleet = next((found for entry in exchange if (found := _of_a_fleet(entry))), None)
    more = {} if fleet is None else dict(fleet.more)
    if console is not None and not is_loopback(console.host):
        what = Announcement(rig, *console, more=more)
    elif fleet is not None:
        what = fleet
    else:
        return {}
    return {"announcement": what.as_settings()}


def _of_a_fleet(entry: ExchangeSection) -> Announcement | None:
    """What operators of a fleet connect to. A port 0 is chosen later, and announced by nobody."""
    if not isinstance(entry, ZenohSection) or entry.listen is None:
        return None
    found = endpoint(entry.listen)
    with suppress(OSError, UnicodeError):
        host = socket.getaddrinfo(*found.address, type=socket.SOCK_STREAM)[0][4][0]
        if found.address.port and not found.is_loopback and not is_loopback(str(host)):
            return Announcement(
                entry.name, str(host), found.address.port, found.protocol == "tls", {ZENOH: entry.listen}, console=False
            )
    return None

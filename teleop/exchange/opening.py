"""The exchange of a run as its gateway is told it: sockets open before the rig does, and stay over a new gateway."""

from __future__ import annotations

import socket
from collections.abc import Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import astuple, dataclass
from typing import Any

from teleop.config.exchange import ENTRIES, ExchangeSection
from teleop.config.exchange.address import Address, address
from teleop.config.profile import Profile
from teleop.core.errors import DeviceError

KINDS = {"udp": socket.SOCK_DGRAM, "tcp": socket.SOCK_STREAM}
BACKLOG = 16  # connections that wait to be accepted


@dataclass(frozen=True)
class Exchange:
    """What the gateway is told, the descriptors that it inherits, and a line on what is served; "" for nothing."""

    settings: Mapping[str, Any]
    passed: Sequence[int] = ()
    greeting: str = ""


NOTHING = Exchange({})


@contextmanager
def opened(profile: Profile) -> Iterator[Exchange]:
    """Every `listen` of the profile's exchange listens within. Raises DeviceError with the entry and why not."""
    if not profile.exchange:
        yield NOTHING
        return
    with ExitStack() as stack:
        listeners = [_listener(stack, number, entry) for number, entry in enumerate(profile.exchange)]
        descriptors = [None if each is None else each.fileno() for each in listeners]
        told = {
            "entries": ENTRIES.dump_python(profile.exchange, mode="json", by_alias=True),
            "listeners": descriptors,
            "rig": {
                "name": profile.name,
                "limits": {axis.value: astuple(limits) for axis, limits in profile.limits.items()},
            },
        }
        words = [_words(entry, listener) for entry, listener in zip(profile.exchange, listeners, strict=True)]
        passed = [each for each in descriptors if each is not None]
        yield Exchange({"exchange": told}, passed, f"exchange: {', '.join(words)}")


def _listener(stack: ExitStack, number: int, entry: ExchangeSection) -> socket.socket | None:
    listen, transport, where = getattr(entry, "listen", None), entry.TRANSPORT, getattr(entry, "listen", None)
    if transport is None and listen is not None:  # it begins with its transport, as in tcp:HOST:PORT
        transport, _, where = listen.partition(":")
    if listen is None or where is None or transport not in KINDS:
        return None
    place = f"exchange[{number}] ({entry.type}): listen {listen}"
    try:
        return stack.enter_context(_bound(address(where), KINDS[transport]))
    except (OSError, UnicodeError) as error:
        why = getattr(error, "strerror", None) or error
        raise DeviceError(f"{place}: cannot listen: {why}; choose another port, or end what has it") from None


def _bound(place: Address, kind: socket.SocketKind) -> socket.socket:
    family, _, protocol, _, where = socket.getaddrinfo(*place, type=kind, flags=socket.AI_PASSIVE)[0]
    listener = socket.socket(family, kind, protocol)
    try:
        if kind is socket.SOCK_STREAM or place.is_group:
            listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        listener.bind(where)
        if kind is socket.SOCK_STREAM:
            listener.listen(BACKLOG)
    except OSError:
        listener.close()
        raise
    listener.setblocking(False)
    return listener


def _words(entry: ExchangeSection, listener: socket.socket | None) -> str:
    parts = [entry.type]
    if listener is not None:
        host, port = listener.getsockname()[:2]
        parts.append(f"at {host}:{port}")
    elif listen := getattr(entry, "listen", None):
        parts.append(f"at {listen}")
    if to := getattr(entry, "to", None):
        parts.append(f"to {to}")
    return " ".join(parts)

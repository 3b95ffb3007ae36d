"""What the console is started with: where it listens, who may log in, which folders it serves.

The control process makes these once and gives them to every gateway that it starts, so that a browser stays logged in
when the gateway is started again. Nothing here imports a server.
"""

from __future__ import annotations

import base64
import json
import pickle
import secrets
import socket
from collections.abc import Mapping
from dataclasses import asdict, dataclass, replace
from typing import TYPE_CHECKING, Any, Literal

from teleop.config.exchange.address import is_loopback
from teleop.config.exchange.zenoh import ZenohSection
from teleop.console import DEFAULT_BIND
from teleop.core.errors import DeviceError, UsageError

if TYPE_CHECKING:
    from teleop.config.profile import Profile

GIVEN = "profile:"  # begins a rig that is the profile itself: no name and no file does
Role = Literal["operate", "watch"]
TOKEN_BYTES = 16  # 128 bits: cannot be guessed
BACKLOG = 64  # connections that wait to be accepted
SEND_BUFFER = 65_536  # bytes in the kernel for a client: a larger buffer would only hold states that are too old


@dataclass(frozen=True)
class ConsoleSettings:
    """`host` and `port` to listen at; without tokens nobody has to log in, which only loopback allows.

    Who has the `token` operates, who has the `watch_token` only watches and may press STOP. `moves` and `takes` are
    the only folders that are served, and of `results` the three files of a commissioning. `certificate` and `key` are
    files (PEM) for TLS, "" without. `rig` is what plans are made for: a shipped profile's name, a file, or the profile
    itself as `planned_for` writes it, which is what a run gives: its limits are then those that the rig keeps, whatever
    has become of the file since. `fleet` is the rig's zenoh entry, None for a rig that is alone.
    """

    host: str = "127.0.0.1"
    port: int = 8470
    token: str = ""
    watch_token: str = ""
    moves: str = "."
    takes: str = "."
    results: str = ""
    rig: str = "sim"
    certificate: str = ""
    key: str = ""
    fleet: Mapping[str, Any] | None = None

    @property
    def is_open(self) -> bool:
        """Whether no login is needed."""
        return not self.token

    @property
    def has_tls(self) -> bool:
        return bool(self.certificate)

    @property
    def fleet_section(self) -> ZenohSection | None:
        return None if self.fleet is None else ZenohSection.model_validate(self.fleet)

    def as_json(self) -> str:
        return json.dumps(asdict(self))

    @classmethod
    def from_json(cls, text: str) -> ConsoleSettings:
        return cls(**json.loads(text))


def planned_for(profile: Profile) -> str:
    """A profile as `rig` of the settings; both ends are ours, so it is pickled."""
    return GIVEN + base64.b64encode(pickle.dumps(profile)).decode()


def given(rig: str) -> Profile | None:
    """The profile that `planned_for` has written; None for the name of one."""
    return pickle.loads(base64.b64decode(rig.removeprefix(GIVEN))) if rig.startswith(GIVEN) else None


def parse_bind(text: str) -> tuple[str, int]:
    """Host and port of `HOST:PORT`, `:PORT` or `HOST`; IPv6 in brackets. Raises UsageError."""
    host, colon, port = text.rpartition(":")
    if not colon or text.endswith("]"):
        host, port = text, DEFAULT_BIND.rpartition(":")[2]
    host = host.removeprefix("[").removesuffix("]") or "127.0.0.1"
    if not (port.isascii() and port.isdigit() and int(port) < 65536):
        raise UsageError(f"--bind {text}: write HOST:PORT, as in {DEFAULT_BIND}; port 0 picks one")
    return host, int(port)


def with_tokens(settings: ConsoleSettings) -> ConsoleSettings:
    """The same with the tokens that are missing: an address that others can reach always needs them."""
    if not settings.token and is_loopback(settings.host):
        return settings
    token = settings.token or secrets.token_urlsafe(TOKEN_BYTES)
    watch = settings.watch_token or secrets.token_urlsafe(TOKEN_BYTES)
    if token == watch:
        raise UsageError("the token to operate and the token to watch must differ")
    return replace(settings, token=token, watch_token=watch)


def listen(settings: ConsoleSettings) -> tuple[socket.socket, ConsoleSettings]:
    """A socket that listens, and the settings with the port that it has. Raises UsageError and DeviceError.

    A process that starts the gateway again keeps the socket, so that the port stays the same.
    """
    try:
        found = socket.getaddrinfo(settings.host, settings.port, type=socket.SOCK_STREAM, flags=socket.AI_PASSIVE)
    except (OSError, UnicodeError):
        raise UsageError(f"--bind {settings.host}: no such address; write HOST:PORT, as in {DEFAULT_BIND}") from None
    family, kind, protocol, _, address = found[0]
    listener = socket.socket(family, kind, protocol)
    try:
        listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        listener.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, SEND_BUFFER)
        listener.bind(address)
        listener.listen(BACKLOG)
    except OSError as error:
        listener.close()
        place = f"{settings.host}:{settings.port}"
        raise DeviceError(
            f"--bind {place}: cannot listen: {error.strerror or error}; choose another port, or port 0"
        ) from None
    listener.setblocking(False)
    return listener, replace(settings, port=listener.getsockname()[1])

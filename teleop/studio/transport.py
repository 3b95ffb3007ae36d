"""A Zenoh session as teleop opens it: no scouting, a lease of 400 ms, bounded messages, TLS and access lists.

A rig is a peer: it listens, connects to routers, and passes on between those that are linked to it. An operator has one
client session for each endpoint, because two peers do not see each other through a router. Every session must be closed
or the process never ends.
"""

from __future__ import annotations

import json
import threading
from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from teleop.core.errors import DeviceError, UsageError
from teleop.studio.wire import LARGEST_LOAD

if TYPE_CHECKING:
    import zenoh

    from teleop.studio.credentials import Credentials

LEASE = 400  # ms without a word after which a link is lost
KEEP_ALIVES = 4  # in a lease
STATES = 8  # that wait for a link: as many as the rig sends in a lease. With Zenoh's 2 a busy machine loses some
RING = 256  # messages that wait for a reader
OPENING = 1000  # ms that one try to connect may take
RETRY = {"period_init_ms": 200, "period_max_ms": 1000, "period_increase_factor": 1.5}
MISSING = "several rigs need the package eclipse-zenoh: pip install 'rs-teleop[fleet]'"


def require() -> Any:
    """The package. Raises UsageError where it is not installed."""
    try:
        import zenoh
        import zenoh.handlers
    except ImportError:
        raise UsageError(MISSING) from None
    return zenoh


def opened(
    mode: str,
    listen: Sequence[str] = (),
    connect: Sequence[str] = (),
    credentials: Credentials | None = None,
    access: Mapping[str, Any] | None = None,
) -> zenoh.Session:
    """A session. A "client" has to reach its endpoint now, and comes back by itself later; a "peer" need not.

    Raises DeviceError with the reason.
    """
    package = require()
    config = package.Config()
    for name, value in _settings(mode, listen, connect, credentials, access).items():
        config.insert_json5(name, json.dumps(value))
    try:
        return package.open(config)
    except package.ZError as error:
        raise DeviceError(f"{', '.join([*listen, *connect])}: {_reason(error)}") from None


class Reader:
    """Hands what a subscriber or queryable receives to `handle`, in a thread that has ended when `close` returns.

    Zenoh's own callbacks have a thread too, but none that can be waited for: one that is still there when Python ends
    aborts the process. `declared` has to have a channel: `ring`.
    """

    def __init__(self, declared: Any, handle: Callable[[Any], object]) -> None:
        self._declared, self._receive, self._handle = declared, declared.handler.recv, handle
        self._over = require().ZError
        self._thread = threading.Thread(target=self._run, name="zenoh", daemon=True)
        self._thread.start()

    def _run(self) -> None:
        while True:
            try:
                item = self._receive()
            except self._over:  # undeclared, or the session is closed
                return
            self._handle(item)
            del item  # a query is over when nobody has it any more

    def close(self) -> None:
        """Undeclare it."""
        self._declared.undeclare()
        self._thread.join()


def ring() -> Any:
    """A channel that keeps the newest: a reader that is slow loses the oldest, and holds nothing up."""
    return require().handlers.RingChannel(RING)


def _settings(
    mode: str,
    listen: Sequence[str],
    connect: Sequence[str],
    credentials: Credentials | None,
    access: Mapping[str, Any] | None,
) -> Mapping[str, Any]:
    client = mode == "client"
    settings: dict[str, Any] = {
        "mode": mode,
        "listen/endpoints": list(listen),
        "listen/exit_on_failure": True,
        "connect/endpoints": list(connect),
        "connect/timeout_ms": OPENING if client else -1,
        "connect/exit_on_failure": client,
        "connect/retry": RETRY,
        "scouting/multicast/enabled": False,
        "scouting/gossip/enabled": False,
        "scouting/delay": 0,
        "open/return_conditions/connect_scouted": False,
        "transport/link/tx/lease": LEASE,
        "transport/link/tx/keep_alive": KEEP_ALIVES,
        "transport/link/tx/queue/size/data_high": STATES,
        "transport/link/rx/max_message_size": LARGEST_LOAD,
        "transport/link/protocols": ["tls"] if credentials else ["tcp"],
        "transport/unicast/open_timeout": OPENING,
        "transport/unicast/accept_timeout": OPENING,
        "transport/shared_memory/enabled": False,
    }
    if credentials is not None:
        settings["transport/link/tls"] = credentials.tls()
    if access is not None:
        settings["access_control"] = access
    return settings


def _reason(error: Exception) -> str:
    """Without the place in Zenoh's source."""
    return str(error).split(" at /", 1)[0].rstrip(".! ")

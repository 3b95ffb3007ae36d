"""Connections that ask for nothing: closed after a while, few of one computer, the first to go where there is no room.

Who has no token can still open connections. Without these bounds some hundred idle ones would keep out everyone else,
and a STOP by HTTP with them. So a new one always gets in, as long as one is idle.
"""

from __future__ import annotations

from asyncio import TimerHandle, Transport
from typing import Any

from uvicorn.protocols.http.h11_impl import H11Protocol

LONGEST_IDLE = 10.0  # s without a whole request
MOST_OF_ONE = 64  # connections of one computer
MOST = 300  # of all: uvicorn refuses everyone at 400


class BoundedProtocol(H11Protocol):
    """HTTP on one connection, until it is closed or becomes a WebSocket."""

    _look: TimerHandle | None = None
    _seen: Any = None
    _began = 0.0

    def connection_made(self, transport: Transport) -> None:  # type: ignore[override]
        super().connection_made(transport)
        self._began = self.loop.time()
        if not self._has_room():
            transport.abort()
            return
        self._look = self.loop.call_later(LONGEST_IDLE, self._close_idle)

    def connection_lost(self, exc: Exception | None) -> None:
        if self._look is not None:
            self._look.cancel()
        super().connection_lost(exc)

    def _has_room(self) -> bool:
        """Whether there is room for this one, if need be by ending the oldest that is idle."""
        address = self.client and self.client[0]
        own = [each for each in self.connections if (getattr(each, "client", None) or ("",))[0] == address]
        crowd = own if address and len(own) > MOST_OF_ONE else self.connections if len(self.connections) > MOST else ()
        idle = [each for each in crowd if isinstance(each, BoundedProtocol) and each is not self and each.is_idle]
        if crowd and idle:
            min(idle, key=lambda each: each._began).transport.abort()
        return bool(idle) or not crowd

    @property
    def is_idle(self) -> bool:
        """Whether nothing is being answered."""
        return self.cycle is None or self.cycle.response_complete

    def _close_idle(self) -> None:
        """Close the connection unless something was asked for since the last look, or is being answered."""
        if self.transport.is_closing() or self.transport.get_protocol() is not self:
            return
        if self.is_idle and (self.cycle is None or self.cycle is self._seen):
            self.transport.close()
            return
        self._seen = self.cycle
        self._look = self.loop.call_later(LONGEST_IDLE, self._close_idle)

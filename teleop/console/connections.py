"""Connections that ask for nothing: closed after a while, and few of one computer.

Who has no token can still open connections. Without these bounds some hundred idle ones would keep out everyone else,
and a STOP by HTTP with them.
"""

from __future__ import annotations

from asyncio import TimerHandle, Transport
from typing import Any

from uvicorn.protocols.http.h11_impl import H11Protocol

LONGEST_IDLE = 10.0  # s without a whole request
MOST_OF_ONE = 64  # connections of one computer


class BoundedProtocol(H11Protocol):
    """HTTP on one connection, until it is closed or becomes a WebSocket."""

    _look: TimerHandle | None = None
    _seen: Any = None

    def connection_made(self, transport: Transport) -> None:  # type: ignore[override]
        super().connection_made(transport)
        clients = [getattr(each, "client", None) or ("",) for each in self.connections]
        if self.client and sum(client[0] == self.client[0] for client in clients) > MOST_OF_ONE:
            transport.abort()
            return
        self._look = self.loop.call_later(LONGEST_IDLE, self._close_idle)

    def connection_lost(self, exc: Exception | None) -> None:
        if self._look is not None:
            self._look.cancel()
        super().connection_lost(exc)

    def _close_idle(self) -> None:
        """Close the connection unless something was asked for since the last look, or is being answered."""
        if self.transport.is_closing() or self.transport.get_protocol() is not self:
            return
        is_idle = self.cycle is None or (self.cycle.response_complete and self.cycle is self._seen)
        if is_idle:
            self.transport.close()
            return
        self._seen = self.cycle
        self._look = self.loop.call_later(LONGEST_IDLE, self._close_idle)

"""Sessions of HTTP clients: one for each computer and role, because a script has no connection that stays.

The door is told whenever it asks for something, and again while it waits for an answer: a move that it started pauses
when it is gone.
"""

from __future__ import annotations

import asyncio
import secrets
from collections import OrderedDict
from collections.abc import Awaitable, Mapping
from dataclasses import dataclass, field
from typing import Any

from starlette.requests import Request

from teleop.console.door import Door
from teleop.console.gate import client_address
from teleop.console.json_body import Refusal

SEEN = 0.4  # s from one word to the door about a request that waits to the next
MOST = 200  # sessions that are remembered


@dataclass(frozen=True)
class HttpSession:
    """A client's `session` at the door, and what screens call it."""

    name: str
    session: str = field(default_factory=lambda: f"http-{secrets.token_hex(4)}")


class HttpSessions:
    """Finds the session of a request."""

    def __init__(self, door: Door) -> None:
        self._door = door
        self._sessions: OrderedDict[tuple[str, str], HttpSession] = OrderedDict()

    def of(self, request: Request) -> HttpSession:
        """The session of a request, which is thereby seen."""
        address, role = client_address(request.scope), str(request.scope["state"]["role"])
        found = self._sessions.setdefault((address, role), HttpSession(f"HTTP {address}"[:40]))
        self._sessions.move_to_end((address, role))
        while len(self._sessions) > MOST:
            _, oldest = self._sessions.popitem(last=False)
            self._door.closed(oldest.session)
        self._door.seen(found.session)
        return found

    async def waiting(
        self, request: Request, session: HttpSession, work: Awaitable[Mapping[str, Any]]
    ) -> Mapping[str, Any]:
        """What `work` gives; the client is present until then, or until it hangs up. The request has been read."""
        task = asyncio.ensure_future(work)
        try:
            while not (await asyncio.wait([task], timeout=SEEN))[0]:
                if await request.is_disconnected():
                    raise Refusal(408, "the client has hung up")  # which it does not hear
                self._door.seen(session.session)
            return task.result()
        finally:
            task.cancel()

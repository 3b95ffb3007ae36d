"""What operators ask a rig by Zenoh: each command becomes one of the door, or is answered here."""

from __future__ import annotations

import asyncio
import time
from contextlib import suppress
from time import monotonic
from typing import Any

from teleop.door.messages import INTERNAL
from teleop.exchange.zenoh.sent_moves import SentMoves
from teleop.gateway.door_client import DoorClient
from teleop.studio.clocks import clock_error
from teleop.studio.wire import SESSION

PREFIX = "fleet."  # of sessions at the door: those of a page cannot be taken for one of these
NOT_HERE = (*INTERNAL, "stick", "plan")
LOOKS, LOOK = 50, 0.01  # looks at the state after a STOP, and s between two


def door_session(session: Any) -> str:
    """The session at the door of an operator's own. Raises ValueError for one that is none."""
    if not isinstance(session, str) or not SESSION.fullmatch(session):
        raise ValueError("session: must be 1 to 32 letters, digits, `-` and `_`")
    return f"{PREFIX}{session}"


class Commands:
    """Each takes a message and when it arrived, and returns the answer."""

    def __init__(self, door: DoorClient) -> None:
        self._door, self._sent = door, SentMoves(door)

    async def do(self, message: dict[str, Any], arrived: float) -> dict[str, Any]:  # noqa: ARG002
        """Any command of the door. With `wait` the answer comes when what was accepted has ended."""
        do = message.get("do")
        try:
            session, name = _sender(message)
        except ValueError as error:
            return _invalid(error)
        if do == "leave":
            self._door.closed(session)
            return {"ok": True}
        if do in NOT_HERE:
            return _invalid(f"do: unknown command {str(do)[:40]!r}")
        waits, brief = message.pop("wait", False), message.pop("brief", False)
        found = await self._door.command(message, session, name, brief is True)
        if waits is True and "ok" in found:
            return {**await self._door.finished(found["id"]), "id": found["id"]}
        return found

    async def load(self, message: dict[str, Any], arrived: float) -> dict[str, Any]:  # noqa: ARG002
        """Plan a move that came as text, and hold it until it is started."""
        try:
            session, name = _sender(message)
        except ValueError as error:
            return _invalid(error)
        return await self._sent.load(message, session, name)

    async def stop(self, message: dict[str, Any], arrived: float) -> dict[str, Any]:  # noqa: ARG002
        """STOP, by anybody: whatever else the message has, and whether or not it is well formed."""
        try:
            session, name = _sender(message)
        except ValueError:
            session, name = f"{PREFIX}stop", "fleet"
        found = await self._door.command({"do": "stop"}, session, name)
        for _ in range(LOOKS if found.get("ok") else 0):
            if self._door.state().get("stopped"):
                break
            await asyncio.sleep(LOOK)
        return {**found, "stopped": bool(self._door.state().get("stopped"))}

    async def clock(self, message: dict[str, Any], arrived: float) -> dict[str, Any]:
        """What the rig's clocks show; who asks with its session says thereby that it is there."""
        with suppress(ValueError):
            self._door.seen(door_session(message.get("session")))
        taken = monotonic() - arrived
        return {"time": monotonic(), "clock": time.time(), "taken": taken, "clock_error": clock_error()}


def _sender(message: dict[str, Any]) -> tuple[str, str]:
    """The session at the door and the name of who asks, taken out of the message. Raises ValueError."""
    session, name = door_session(message.pop("session", None)), message.pop("name", None)
    if not isinstance(name, str) or not 0 < len(name) <= 40 or not name.isprintable():
        raise ValueError("name: must be printable text of at most 40 characters")
    return session, name


def _invalid(why: object) -> dict[str, Any]:
    return {"error": str(why), "kind": "invalid"}

"""What the console needs of the door to the control process; `gateway.door_client.DoorClient` is one."""

from __future__ import annotations

from collections.abc import AsyncIterator, Mapping
from typing import Any, Protocol

KINDS = {"busy": 409, "stale": 409, "refused": 422, "invalid": 400, "forbidden": 403, "lost": 503}
"""HTTP status by the kind of error in an answer."""


class Door(Protocol):
    """States out, commands in."""

    def state(self) -> Mapping[str, Any]:
        """The newest state, with its ages as of now; empty before the first one."""
        ...

    def states(self) -> AsyncIterator[Mapping[str, Any]]:
        """Each new state; a slow reader gets only the newest."""
        ...

    async def command(
        self, command: Mapping[str, Any], session: str, name: str, brief: bool = False
    ) -> Mapping[str, Any]:
        """The answer: `ok` and an `id`, or `error` with its `kind` and for "busy" the `holder`.

        With `brief` the session takes control for this action alone.
        """
        ...

    def stick(self, message: Mapping[str, Any], session: str) -> None:
        """One message of a stream of sticks; there is no answer. Raises ValueError for a malformed one."""
        ...

    async def finished(self, number: int, /) -> Mapping[str, Any]:
        """How the accepted action with this id has ended, once it has."""
        ...

    def seen(self, session: str) -> None:
        """The client of this session has just been heard: its own script, not merely its connection."""
        ...

    def closed(self, session: str) -> None:
        """The client of this session is gone."""
        ...

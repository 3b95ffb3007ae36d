"""The wheels with a spring as the stick of a client: control is taken while they are deflected, and freed after it."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Mapping

from teleop.exchange.client import Client
from teleop.gateway.door_client import DoorClient

RELEASED = 3  # messages in the center, after which a stick is silent


class WheelStick:
    """Call `step` 50 times a second. `say` is told why control is not given."""

    def __init__(self, door: DoorClient, client: Client, say: Callable[[str], object]) -> None:
        self._door, self._client, self._say = door, client, say
        self._seq = 0
        self._left = 0  # messages in the center that are still to be sent
        self._refused = False
        self._asking: asyncio.Task[None] | None = None
        self._holds = False

    def step(self, deflections: Mapping[str, float]) -> None:
        deflected = any(deflections.values())
        self._refused = self._refused and deflected
        if self._holds:
            if deflected or self._left > 0:
                self._left = RELEASED if deflected else self._left - 1
                self._send(deflections)
            else:
                self._holds = False
                self._client.post({"do": "release_control"})
        elif deflected and not self._refused and self._asking is None:
            self._asking = asyncio.get_running_loop().create_task(self._take())

    def close(self) -> None:
        if self._asking is not None:
            self._asking.cancel()

    async def _take(self) -> None:
        answer = await self._client.command({"do": "take_control"})
        if "ok" in answer:
            self._holds, self._left = True, RELEASED
        else:
            self._refused = True
            self._say(answer.get("error", ""))
        self._asking = None

    def _send(self, deflections: Mapping[str, float]) -> None:
        self._seq += 1
        self._door.stick({"seq": self._seq, "axes": dict(deflections)}, self._client.session)

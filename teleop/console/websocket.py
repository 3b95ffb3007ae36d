"""The page's WebSocket: states out, commands and sticks in.

One task reads, one writes. The writer holds the newest state and the answers that are due; it waits for each send, so
that a slow client gets fewer states and never a backlog. A client that takes nothing for a while is dropped.
"""

from __future__ import annotations

import asyncio
import time
from collections import deque
from collections.abc import Callable, Coroutine, Mapping
from typing import Any

from starlette.websockets import WebSocket, WebSocketDisconnect, WebSocketState

from teleop.console.answers import json_text
from teleop.console.commands import WATCHERS, check_command, pass_stick
from teleop.console.door import Door
from teleop.console.json_body import MOST_BYTES, Refusal, parse_object
from teleop.console.merge_patch import changes
from teleop.console.moves import MoveRoutes
from teleop.console.settings import Role
from teleop.console.stopping import stop
from teleop.gateway.bucket import Bucket

STATE_PERIOD = 1 / 30  # s from one state to the next
LONGEST_SEND = 5.0  # s that a client may take nothing
MOST_UNSENT = 200  # answers that wait to be sent
MOST_COMMANDS = 32  # of a client under way at once
RATE, BURST = 200.0, 400.0  # messages/s and at once; sticks are 50 a second
MOST_IGNORED = 2000  # messages above the rate, after which the connection is closed
FLOODED, UNREADABLE, TOO_LARGE = 1008, 1003, 1009  # codes of RFC 6455


class GoneError(Exception):
    """The client takes nothing more, or sends what no page sends."""

    def __init__(self, code: int) -> None:
        super().__init__(code)
        self.code = code


class Client:
    """One connection of a page. `name` is what screens call it; `clock` (s) measures its rate."""

    def __init__(
        self,
        websocket: WebSocket,
        door: Door,
        session: str,
        name: str,
        role: Role,
        moves: MoveRoutes,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self._websocket, self._door = websocket, door
        self._session, self._name, self._role, self._moves = session, name, role, moves
        self._outbox: deque[Mapping[str, Any]] = deque()
        self._newest: Mapping[str, Any] | None = None
        self._sent: Mapping[str, Any] | None = None
        self._wake = asyncio.Event()
        self._commands: set[asyncio.Task[None]] = set()
        self._loop = asyncio.get_running_loop()
        self._clock, self._bucket = clock, Bucket(RATE, BURST, BURST, clock())
        self._ignored = 0

    async def run(self) -> None:
        """Serve the client until it is gone."""
        await self._websocket.accept()
        tasks = [asyncio.create_task(each) for each in (self._read(), self._write(), self._watch())]
        try:
            done, _ = await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
            for task in done:
                task.result()
        except (WebSocketDisconnect, ConnectionError):
            pass
        except GoneError as gone:
            await self._close(gone.code)
        finally:
            self._door.closed(self._session)
            for task in (*tasks, *self._commands):
                task.add_done_callback(_ended)
                task.cancel()

    async def _close(self, code: int) -> None:
        if self._websocket.application_state is WebSocketState.CONNECTED:
            try:
                async with asyncio.timeout(1):
                    await self._websocket.close(code)
            except (TimeoutError, RuntimeError, WebSocketDisconnect):
                return  # it is gone already, or takes not even that: the server drops the connection

    async def _watch(self) -> None:
        self._newest = self._door.state() or None
        self._wake.set()
        async for state in self._door.states():
            self._newest = state
            self._wake.set()

    async def _write(self) -> None:
        state = self._door.state()
        hello = {"type": "hello", "role": self._role, "session": self._session, "name": self._name}
        await self._send({**hello, "rig": state.get("rig", "")})
        due = self._loop.time()
        while True:
            await self._wake.wait()
            self._wake.clear()
            while self._outbox:
                if len(self._outbox) > MOST_UNSENT:
                    raise GoneError(FLOODED)
                await self._send(self._outbox.popleft())
            if self._newest is None:
                continue
            now = self._loop.time()
            if now < due:
                self._loop.call_later(due - now, self._wake.set)
                continue
            due = max(due + STATE_PERIOD, now + STATE_PERIOD / 2)
            newest, self._newest = self._newest, None
            if self._sent is None:
                await self._send({"type": "state", "state": newest})
            else:
                await self._send({"type": "delta", "changes": changes(self._sent, newest)})
            self._sent = newest

    async def _send(self, message: Mapping[str, Any]) -> None:
        text = json_text(message)
        try:
            async with asyncio.timeout(LONGEST_SEND):
                await self._websocket.send_text(text)
        except TimeoutError:
            raise GoneError(FLOODED) from None
        except RuntimeError:  # starlette's, for a connection that is closed
            raise GoneError(1000) from None

    def _answer(self, message: Mapping[str, Any]) -> None:
        self._outbox.append(message)
        self._wake.set()

    async def _read(self) -> None:
        while True:
            message = await self._websocket.receive()
            if message["type"] == "websocket.disconnect":
                raise WebSocketDisconnect(message.get("code", 1000))
            text = message.get("text")
            if text is None:
                raise GoneError(UNREADABLE)
            if len(text) > MOST_BYTES:
                raise GoneError(TOO_LARGE)
            self._door.seen(self._session)
            self._take(text)
            await asyncio.sleep(0)  # a burst of messages does not keep the answers

    def _take(self, text: str) -> None:
        """One message. Above the rate only STOP is obeyed."""
        is_over = not self._bucket.take(self._clock())
        if is_over:
            self._ignored += 1
            if self._ignored > MOST_IGNORED:
                raise GoneError(FLOODED)
            if '"stop"' not in text:
                return
        id_ = None
        try:
            message = parse_object(text)
            id_ = message.pop("id", None)
            if not isinstance(id_, int | str | None) or len(str(id_)) > 40:
                id_ = None
                raise Refusal(400, "id: must be a number or a short text")
            check_command(message)
            self._obey(message, id_, is_over)
        except Refusal as refusal:
            kind = "forbidden" if refusal.status == 403 else "invalid"
            self._answer({"type": "answer", "id": id_, "error": str(refusal), "kind": kind})

    def _obey(self, message: dict[str, Any], id_: int | str | None, is_over: bool) -> None:
        do = message["do"]
        if do == "stop":
            self._start(self._stop(id_), id_)
        elif is_over:
            return
        elif do == "ping":
            self._answer({"type": "pong", "id": id_})
        elif self._role != "operate" and do != "plan":
            raise Refusal(403, WATCHERS)
        elif do == "stick":
            pass_stick(self._door, message, self._session)
        elif len(self._commands) >= MOST_COMMANDS:
            raise Refusal(429, "too many commands at once")
        elif do == "plan":
            self._start(self._plan(message, id_), id_)
        else:
            self._start(self._command(message, id_), id_)

    def _start(self, work: Coroutine[Any, Any, None], id_: int | str | None) -> None:
        task = asyncio.create_task(self._answered(work, id_))
        self._commands.add(task)
        task.add_done_callback(self._commands.discard)

    async def _answered(self, work: Coroutine[Any, Any, None], id_: int | str | None) -> None:
        try:
            await work
        except Exception as error:  # noqa: BLE001 - a fault of this program: no command stays without an answer
            text = f"the console failed: {type(error).__name__}"
            self._answer({"type": "answer", "id": id_, "error": text, "kind": "lost"})

    async def _stop(self, id_: int | str | None) -> None:
        self._answer_door(id_, await stop(self._door, self._session, self._name))

    async def _command(self, message: Mapping[str, Any], id_: int | str | None) -> None:
        accepted = await self._door.command(message, self._session, self._name)
        self._answer_door(id_, accepted)
        if accepted.get("ok") and "id" in accepted:
            ended = await self._door.finished(accepted["id"])
            self._answer({**ended, "type": "done", "id": id_})

    async def _plan(self, message: Mapping[str, Any], id_: int | str | None) -> None:
        try:
            found = await self._moves.planned(message)
        except Refusal as refusal:
            found = {**refusal.content, "kind": "invalid"}
        self._answer({**found, "type": "answer", "id": id_})

    def _answer_door(self, id_: int | str | None, found: Mapping[str, Any]) -> None:
        self._answer({**found, "type": "answer", "id": id_})


def _ended(task: asyncio.Task[None]) -> None:
    """What a task of a client that is gone raises concerns nobody."""
    if not task.cancelled():
        task.exception()

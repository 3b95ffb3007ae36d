"""The door from the side of the gateway: the newest state, and commands with their answers, in asyncio.

A command is sent again until it is answered, and executed once all the same. A STOP goes on being sent until the state
shows it. What cannot leave at once is kept; of a stick only its newest message is, because an older one is no use.
"""

from __future__ import annotations

import asyncio
import itertools
import os
from collections import OrderedDict, deque
from collections.abc import AsyncIterator, Mapping
from contextlib import suppress
from time import monotonic
from typing import Any, Self

from teleop.core.axes import Axis, Reading
from teleop.core.errors import TeleopError
from teleop.core.events import Tick
from teleop.door.address import DoorAddress
from teleop.door.messages import MOST_SEEN, CommandError, checked, packed, unpacked
from teleop.door.ring import SLOTS, RingReader
from teleop.door.sockets import LARGEST, ClientSocket
from teleop.door.states import StateUnpacker
from teleop.door.ticks import from_plain

REPEAT = 0.2  # s until a command that is not answered is sent again
STOP_REPEAT = 0.05
TIMEOUT = 2.0  # s until it is lost
ROOM = 0.002  # s between two looks whether a full queue has room: five in a tick of the rig
PLANNING = 60.0  # s for the answer to a command that the rig has first to plan
ALIVE = 0.25  # s between two words about who is there
LOOK = 0.01  # s between two looks at the ring
KEPT = 512  # actions whose ends are kept
FORGOTTEN = 10.0  # s after which a session that is silent is no longer told of
LOST = "the rig does not answer: its control process is gone or hangs"


class DoorClient:
    """A client of the door at `address`; enter it in the event loop. Raises TeleopError where there is no door."""

    def __init__(self, address: DoorAddress) -> None:
        self.address = address
        self._ids = itertools.count(1)
        self._answers: dict[int, asyncio.Queue[dict[str, Any]]] = {}
        self._ends: OrderedDict[int, asyncio.Future[dict[str, Any]]] = OrderedDict()
        self._unpacker = StateUnpacker()
        self._number, self._decoded, self._beside = 0, {}, None
        self._outbox: deque[bytes] = deque()
        self._sticks: dict[str, bytes] = {}  # the newest of each stream that could not leave yet
        self._writing: asyncio.TimerHandle | None = None  # the next attempt to send what could not leave yet
        self._seen: dict[str, float] = {}
        self._tasks: set[asyncio.Task[None]] = set()

    async def __aenter__(self) -> Self:
        self._loop = asyncio.get_running_loop()
        own = self.address.client(os.getpid())
        with suppress(FileNotFoundError):
            os.unlink(own)  # of a process that had the same number
        try:
            self._ring = RingReader(self.address.ring)
            self._socket = ClientSocket(own, self.address.commands)
        except OSError as error:
            raise TeleopError(f"{self.address.folder}: {error.strerror or error}: is the rig still running?") from None
        self._loop.add_reader(self._socket, self._receive)
        self._start(self._tell_alive())
        return self

    async def __aexit__(self, *_: object) -> None:
        for task in self._tasks:
            task.cancel()
        await asyncio.gather(*self._tasks, return_exceptions=True)
        self._loop.remove_reader(self._socket)
        if self._writing is not None:
            self._writing.cancel()
        self._socket.close()
        with suppress(OSError):
            os.unlink(self.address.client(os.getpid()))
        self._ring.close()

    # --- state

    def newest(self) -> Mapping[str, Any]:
        """The newest state as the rig wrote it, its ages as of its `time`; {} before there is one. Never waits."""
        if self._ring.number != self._number and (newest := self._ring.newest()) is not None:
            self._number = newest.number
            self._decoded, self._beside = self._unpacker.both(newest.data)
        return self._decoded

    def readings(self) -> Mapping[Axis, Reading]:
        """Where each axis was measured by the newest state's tick, those that the run does not move among them."""
        self.newest()
        return {} if self._beside is None else from_plain(self._beside[0]).reported

    def state(self) -> dict[str, Any]:
        """The newest state, with every age as of now. Never waits. {} before there is one."""
        state = self.newest()
        if not state:
            return {}
        since = max(0.0, (monotonic() - state["time"]) * 1000)
        axes = {
            name: {**axis, "measured_age_ms": _older(axis["measured_age_ms"], since)}
            for name, axis in state["axes"].items()
        }
        links = {name: {**link, "age_ms": _older(link["age_ms"], since)} for name, link in state["links"].items()}
        sticks = {**state["sticks"], "age_ms": _older(state["sticks"]["age_ms"], since)}
        return {**state, "age_ms": round(since, 1), "axes": axes, "links": links, "sticks": sticks}

    async def states(self) -> AsyncIterator[dict[str, Any]]:
        """Each new state, as it comes; those that come while the last one is dealt with are left out."""
        before = 0
        while True:
            if self.newest() and self._number != before:
                state = self.state()  # which may be a newer one again
                before = self._number
                yield state
            await asyncio.sleep(LOOK)

    async def ticks(self) -> AsyncIterator[tuple[dict[str, Any], Tick, dict[str, float]]]:
        """Every tick from now on, with its state as it was written, and what came of all sticks (-1..1) in it."""
        unpacker, last = StateUnpacker(), self._ring.number
        while True:
            newest = self._ring.number
            for number in range(max(last + 1, newest - SLOTS // 2), newest + 1):
                data = self._ring.read(number)
                state, beside = ({}, None) if data is None else unpacker.both(data)
                if beside is not None:
                    yield state, from_plain(beside[0]), beside[1]
            last = newest
            await asyncio.sleep(LOOK)

    # --- commands

    async def command(self, command: Mapping[str, Any], session: str, name: str, brief: bool = False) -> dict[str, Any]:
        """The answer: `{"ok": True, "id": ...}`, or `{"error": ..., "kind": ..., "holder": ...}`.

        `kind` is "busy" (another holds control), "refused" (the rig cannot), "invalid" or "lost". With `brief` the
        session takes control for this action alone, where nobody has it. The id is for `finished`.
        """
        self.seen(session)
        number = next(self._ids)
        said = {key: value for key, value in command.items() if key not in ("wait", "brief")}
        message = {"time": monotonic() * 1000, **said, "id": number, "session": session, "person": name}
        if brief:
            message["brief"] = True
        try:
            do = checked(message).do
            data = packed(message)
        except CommandError as error:
            return {"error": str(error), "kind": "invalid"}
        self._answers[number], self._ends[number] = asyncio.Queue(), self._loop.create_future()
        try:
            found = await self._answered(number, data, do == "stop")
        finally:
            del self._answers[number]
        if "ok" not in found:
            del self._ends[number]
        while len(self._ends) > KEPT:
            self._ends.popitem(last=False)
        return found

    async def _answered(self, number: int, data: bytes, stops: bool) -> dict[str, Any]:
        answers = self._answers[number]
        end = monotonic() + TIMEOUT
        while monotonic() < end:
            self._send(data, first=stops)
            with suppress(TimeoutError):
                found = await asyncio.wait_for(answers.get(), STOP_REPEAT if stops else REPEAT)
                if found.get("planning"):
                    return await self._planned(answers)
                if stops:
                    self._start(self._repeat_stop(data))
                return found
        return {"error": LOST, "kind": "lost"}

    async def _planned(self, answers: asyncio.Queue[dict[str, Any]]) -> dict[str, Any]:
        """The answer proper, of a command that had to be planned; it may have come together with the first one."""
        with suppress(TimeoutError):
            async with asyncio.timeout(PLANNING):
                while (found := await answers.get()).get("planning"):
                    pass  # the command was sent twice, and so was this
                return found
        return {"error": "the rig has not planned it in time", "kind": "lost"}

    async def _repeat_stop(self, data: bytes) -> None:
        """The answer says that it is taken; only the state says that the rig is stopped."""
        end = monotonic() + TIMEOUT
        while not self.newest().get("stopped") and monotonic() < end:
            self._send(data, first=True)
            await asyncio.sleep(STOP_REPEAT)

    def stick(self, message: Mapping[str, Any], session: str) -> None:
        """Pass a stick's message on; there is no answer. Raises CommandError for a malformed one."""
        self.seen(session)
        self._send_newest(session, {"time": monotonic() * 1000, **message, "do": "stick", "id": 0, "session": session})

    def aim(self, source: int, axes: Mapping[str, float], time: float) -> None:
        """Where the camera would look at what tracking source `source` reported at `time` (s, monotonic clock)."""
        message = {"do": "aim", "id": 0, "session": "gateway", "time": time * 1000, "source": source, "axes": axes}
        self._send_newest(f"aim {source}", message)

    def _send_newest(self, stream: str, message: Mapping[str, Any]) -> None:
        checked(message)
        data = packed(message)
        if self._outbox or self._sticks:
            self._sticks[stream] = data
        elif not self._sent(data):
            self._sticks[stream] = data
            self._watch()

    async def finished(self, number: int) -> dict[str, Any]:
        """How an accepted action ended: `{"ok": True}`, or `{"error": ..., "kind": "refused"}`. Waits until then."""
        end = self._ends.get(number)
        if end is None:
            return {"error": f"there is no action {number}", "kind": "invalid"}
        return await asyncio.shield(end)

    def seen(self, session: str) -> None:
        """The client itself has just said something: for a page, its script, and not merely its connection.

        A move that a session has started pauses when it is not seen for 2 s, once it was seen here for more than a
        command: call it for each message of a page, and once a second while a request waits.
        """
        self._seen[session] = monotonic()

    def closed(self, session: str) -> None:
        """The client's connection is gone."""
        self._seen.pop(session, None)
        with suppress(CommandError):
            self._send(packed({"do": "closed", "id": next(self._ids), "session": session}))

    # --- the socket

    async def _tell_alive(self) -> None:
        while True:
            now = monotonic()
            self._seen = {session: at for session, at in self._seen.items() if now - at < FORGOTTEN}
            newest = sorted(self._seen.items(), key=lambda item: -item[1])[:MOST_SEEN]
            ages = {session: round((now - at) * 1000, 1) for session, at in newest}
            with suppress(CommandError):
                self._send(packed({"do": "alive", "id": next(self._ids), "session": "gateway", "seen": ages}))
            await asyncio.sleep(ALIVE)

    def _start(self, work: Any) -> None:
        task = self._loop.create_task(work)
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)

    def _send(self, data: bytes, first: bool = False) -> None:
        if not self._outbox and self._sent(data):
            return
        (self._outbox.appendleft if first else self._outbox.append)(data)
        while len(self._outbox) > KEPT:
            self._outbox.pop()
        self._watch()

    def _sent(self, data: bytes) -> bool:
        """Whether it has left, or never will; False while the queue is full."""
        try:
            self._socket.send(data)
        except BlockingIOError:
            return False
        except OSError:  # nobody is there: the command is lost, as its answer says
            return True
        return True

    def _watch(self) -> None:
        if self._writing is None:
            self._writing = self._loop.call_later(ROOM, self._flush)

    def _flush(self) -> None:
        self._writing = None
        if not self._all_sent():
            self._watch()

    def _all_sent(self) -> bool:
        """Whether all that waited has left."""
        while self._outbox:
            if not self._sent(self._outbox[0]):
                return False
            self._outbox.popleft()
        for session, data in list(self._sticks.items()):
            if not self._sent(data):
                return False
            del self._sticks[session]
        return True

    def _receive(self) -> None:
        while True:
            try:
                answer = unpacked(self._socket.recv(LARGEST + 1))
            except CommandError:
                continue
            except OSError:
                return
            if isinstance(answer, dict):
                self._take(answer)

    def _take(self, answer: dict[str, Any]) -> None:
        number = answer.get("id")
        if not isinstance(number, int):
            return
        if not answer.pop("done", False):
            if (answers := self._answers.get(number)) is not None:
                answers.put_nowait(answer)
        elif (end := self._ends.get(number)) is not None and not end.done():
            end.set_result(answer)


def _older(age: float | None, since: float) -> float | None:
    return None if age is None else round(age + since, 1)

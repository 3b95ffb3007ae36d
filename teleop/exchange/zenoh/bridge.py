"""Between Zenoh and the door: each message is checked, bounded, and passed on under the operator's session.

Threads read what Zenoh has received. They only put it into an `Intake`; everything else is done in the event loop of
the gateway. An operator whose token is gone, because it left or its link was cut, is closed at the
door, so it has to take control anew.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Coroutine
from contextlib import ExitStack, suppress
from hashlib import sha256
from time import monotonic
from typing import TYPE_CHECKING, Any

from teleop.config.exchange.zenoh import ZenohSection
from teleop.exchange.served import Served
from teleop.exchange.zenoh.commands import Commands, door_session
from teleop.exchange.zenoh.intake import Intake
from teleop.studio import wire
from teleop.studio.transport import LEASE, Reader, require, ring

if TYPE_CHECKING:
    import zenoh

WAITING = 64  # messages of a kind
LARGEST_STICK = 1024  # bytes
GAP = LEASE / 1000  # s of silence of a stick that is deflected, after which it has to take control again


class Bridge:
    """The rig of `served` at an open `session`, for as long as `run` runs."""

    def __init__(
        self, section: ZenohSection, served: Served, session: zenoh.Session, loop: asyncio.AbstractEventLoop
    ) -> None:
        self._name, self._period = section.name, 1 / section.rate
        self._door, self._session, self._loop = served.door, session, loop
        self._commands = Commands(served.door)
        self._tasks: set[asyncio.Task[None]] = set()
        self._states = self._events = 0  # that were sent
        self._said: float | None = None  # when the newest message that was sent was made
        self._deflected: dict[str, float] = {}  # sessions whose stick is, and when each was heard last
        self.malformed = 0

    async def run(self) -> None:
        """Until cancelled; the last state says that the run is over."""
        while not self._door.state():
            await asyncio.sleep(self._period)
        package = require()
        quick = {"congestion_control": package.CongestionControl.DROP, "express": True}
        with ExitStack() as stack:
            self._declare(stack, package)
            state, event = (
                self._session.declare_publisher(wire.key(self._name, what), priority=priority, **quick)
                for what, priority in (("state", package.Priority.DATA_HIGH), ("event", package.Priority.DATA))
            )
            stack.callback(self._session.liveliness().declare_token(wire.key(self._name, "alive")).undeclare)
            try:
                await self._push(state, event)
            finally:
                state.put(wire.encoded({**self._state(), "run": "over"}))
                for task in self._tasks:
                    task.cancel()

    # --- out

    async def _push(self, state: zenoh.Publisher, event: zenoh.Publisher) -> None:
        due = monotonic()
        while True:
            current = self._state()
            state.put(wire.encoded(current))
            for message in self._new(current["messages"]):
                self._events += 1
                event.put(wire.encoded({"seq": self._events, "event": "message", **message}))
            due = max(due + self._period, monotonic())
            await asyncio.sleep(due - monotonic())

    def _state(self) -> dict[str, Any]:
        """The newest state, numbered. A session is its operator's secret: of the holder's only a digest is sent."""
        state = self._door.state()
        self._states += 1
        holder = state["holder_session"]
        digest = None if holder is None else session_digest(holder)
        return {**state, "rig": self._name, "seq": self._states, "holder_session": digest}

    def _new(self, messages: list[dict[str, Any]]) -> list[dict[str, Any]]:
        newest = max((each["time"] for each in messages), default=0.0)
        before, self._said = self._said, newest
        return [] if before is None else [each for each in messages if each["time"] > before]

    # --- in

    def _declare(self, stack: ExitStack, package: Any) -> None:
        session, live = self._session, self._session.liveliness()
        stick, left = self._intake(self._stick, 400), self._intake(self._left, 100)
        deleted = package.SampleKind.DELETE

        def on_stick(sample: zenoh.Sample) -> None:
            if len(sample.payload) <= LARGEST_STICK:
                stick.offer(bytes(sample.payload))

        def on_left(sample: zenoh.Sample) -> None:
            if sample.kind == deleted:
                left.offer(str(sample.key_expr))

        stack.callback(Reader(session.declare_subscriber(wire.key(self._name, "stick"), ring()), on_stick).close)
        stack.callback(Reader(live.declare_subscriber(wire.key(self._name, "alive/*"), ring()), on_left).close)
        self._answer(stack, "command", wire.LARGEST, 100, self._commands.do)
        self._answer(stack, "command/load", wire.LARGEST_LOAD, 4, self._commands.load)
        self._answer(stack, "command/stop", wire.LARGEST, 200, self._commands.stop)
        self._answer(stack, "command/clock", wire.LARGEST, 400, self._commands.clock)

    def _answer(
        self,
        stack: ExitStack,
        what: str,
        most: int,
        rate: float,
        answer: Callable[[dict[str, Any], float], Coroutine[Any, Any, dict[str, Any]]],
    ) -> None:
        """Answer queries at a key: `rate` a second, of `most` bytes."""
        own = wire.key(self._name, what)

        def handle(item: tuple[zenoh.Query, bytes, float]) -> None:
            query, data, arrived = item
            task = self._loop.create_task(self._replied(query, own, data, most, arrived, answer))
            self._tasks.add(task)
            task.add_done_callback(self._tasks.discard)

        intake = self._intake(handle, rate)

        def on_query(query: zenoh.Query) -> None:
            payload = query.payload
            size = 0 if payload is None else len(payload)
            if size > most or not intake.offer((query, b"" if payload is None else bytes(payload), monotonic())):
                query.reply(own, wire.encoded({"error": "too much at once: try again", "kind": "refused"}))
                query.drop()

        stack.callback(Reader(self._session.declare_queryable(own, ring(), complete=True), on_query).close)

    async def _replied(
        self,
        query: zenoh.Query,
        own: str,
        data: bytes,
        most: int,
        arrived: float,
        answer: Callable[[dict[str, Any], float], Coroutine[Any, Any, dict[str, Any]]],
    ) -> None:
        try:
            message = wire.decoded(data or b"{}", most)
        except ValueError as error:
            self.malformed += 1
            found: dict[str, Any] = {"error": f"the command {error}", "kind": "invalid"}
        else:
            found = await answer(message, arrived)
        query.reply(own, wire.encoded(found), express=True)
        query.drop()  # so that who asks waits no longer

    def _intake(self, handle: Callable[[Any], object], rate: float) -> Intake:
        return Intake(self._loop, handle, WAITING, rate)

    def _stick(self, data: bytes) -> None:
        with suppress(ValueError):  # of what is no stick there is no answer
            message = wire.decoded(data, LARGEST_STICK)
            session, now = door_session(message.pop("session", None)), monotonic()
            if now - self._deflected.pop(session, now) > GAP:
                self._door.closed(session)  # the hand was lost: TCP hides a gap, and goes on after it without one
                return
            self._door.stick(message, session)
            if any(message["axes"].values()):
                self._deflected[session] = now
            while len(self._deflected) > WAITING:
                self._deflected.pop(next(iter(self._deflected)))
            return
        self.malformed += 1

    def _left(self, key: str) -> None:
        with suppress(ValueError):
            self._door.closed(door_session(key.rsplit("/", 1)[1]))


def session_digest(session: str) -> str:
    """What is told of a session: enough for its operator to know it as its own."""
    return sha256(session.encode()).hexdigest()[:16]

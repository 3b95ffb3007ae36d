"""The peer of a protocol as a client of the door: it takes control for one action at a time, and is bounded.

A peer has a session and a name that people read. It may give so many commands in a second and have so many unanswered;
what is beyond that is refused. STOP is counted nowhere. Why a command is refused, or ends before its end, is a text.
"""

from __future__ import annotations

import asyncio
import secrets
from collections import OrderedDict
from collections.abc import Callable, Coroutine, Mapping
from time import monotonic
from typing import Any, Protocol

from teleop.config.exchange.address import is_allowed
from teleop.gateway.bucket import Bucket

RATE = 100.0  # commands per second of one peer
BURST = 50  # that may come at once
UNANSWERED = 32  # commands of one peer at a time
SAID_AGAIN = 1.0  # s between two words about too many commands
PEERS = 32  # of an entry; the one that was silent for longest goes
REPLACED = "replaced by"  # how a way ends that the same peer has asked to be another one

Command = Mapping[str, Any]
Refused = Callable[[str], object]


class Door(Protocol):
    """What a client needs of the door: that of `DoorClient`."""

    async def command(self, command: Command, session: str, name: str, brief: bool = False) -> dict[str, Any]: ...

    async def finished(self, number: int) -> dict[str, Any]: ...

    def seen(self, session: str) -> None: ...

    def closed(self, session: str) -> None: ...


class Client:
    """`name` is what others see of it, as in "OSC 192.168.1.20". `refused` gets why a posted command was not done.

    One that is not `allowed` may press STOP only. Everything here is for the event loop's own thread.
    """

    def __init__(self, door: Door, name: str, refused: Refused, allowed: bool = True) -> None:
        self._door, self.name, self._refused, self.allowed = door, name[:40], refused, allowed
        self.session = f"{name.split(' ')[0].lower()}-{secrets.token_hex(8)}"
        self._bucket = Bucket(RATE, BURST, BURST, monotonic())
        self._unanswered = 0
        self._said = -SAID_AGAIN
        self._newest: dict[str, Command | None] = {}  # by fader: one under way, and the one that follows
        self._stopping = self._stop_again = False
        self._tasks: set[asyncio.Task[None]] = set()

    async def command(self, command: Command) -> dict[str, Any]:
        """The answer of the door, as `DoorClient.command` gives it; control is taken for this action alone."""
        if why := self._why_not():
            return {"error": why, "kind": "refused"}
        self._unanswered += 1
        return await self._answered(command)

    async def finished(self, number: int) -> dict[str, Any]:
        """How an accepted action ended."""
        return await self._door.finished(number)

    def post(self, command: Command) -> None:
        """Have it done and wait for nothing: commands arrive in the order in which they are posted."""
        if why := self._why_not():
            self._say(why)
        else:
            self._unanswered += 1
            self._start(self._posted(command))

    def newest(self, command: Command, fader: str = "") -> None:
        """As `post`, for a fader: while one of the same is unanswered, only the newest of them is kept.

        `fader` tells several apart whose commands do the same.
        """
        fader = fader or command["do"]
        if fader in self._newest:
            self._newest[fader] = command
        elif why := self._why_not():
            self._say(why)
        else:
            self._newest[fader] = None
            self._unanswered += 1
            self._start(self._follow(fader, command))

    def stop(self) -> None:
        """STOP, whoever has control and however much was sent: repeated until the state shows it."""
        if self._stopping:
            self._stop_again = True
        else:
            self._stopping = True
            self._start(self._stop())

    def seen(self) -> None:
        """It has just sent something: a move that it plays goes on for as long as that is so."""
        self._door.seen(self.session)

    def close(self) -> None:
        """It is gone: control that it has ends once the axes rest. A STOP on its way still arrives."""
        self._door.closed(self.session)

    # --- inside

    def _why_not(self) -> str:
        if not self.allowed:
            return f"{self.name} may only stop: its address is not in allow of the rig's profile"
        if self._unanswered >= UNANSWERED or not self._bucket.take(monotonic()):
            return f"too many commands: at most {RATE:g} in a second"
        return ""

    async def _answered(self, command: Command) -> dict[str, Any]:
        try:
            return await self._door.command(command, self.session, self.name, brief=True)
        finally:
            self._unanswered -= 1

    async def _posted(self, command: Command) -> None:
        answer = await self._answered(command)
        if "ok" in answer and "id" in answer:
            self._start(self._ending(answer["id"]))
        else:
            self._say(answer.get("error", ""))

    async def _ending(self, number: int) -> None:
        end = await self._door.finished(number)
        if not (why := end.get("error", "")).startswith(REPLACED):
            self._say(why)

    async def _follow(self, fader: str, command: Command) -> None:
        try:
            following: Command | None = command
            while following is not None:
                await self._posted(following)
                following, self._newest[fader] = self._newest[fader], None
                self._unanswered += following is not None
        finally:
            del self._newest[fader]

    async def _stop(self) -> None:
        try:
            while True:
                self._stop_again = False
                answer = await self._door.command({"do": "stop"}, self.session, self.name)
                self._say(answer.get("error", ""))
                if not self._stop_again:
                    return
        finally:
            self._stopping = False

    def _say(self, why: str) -> None:
        if why.startswith("too many commands"):
            now = monotonic()
            if now - self._said < SAID_AGAIN:
                return
            self._said = now
        if why:
            self._refused(why)

    def _start(self, work: Coroutine[Any, Any, None]) -> None:
        task = asyncio.get_running_loop().create_task(work)
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)


class Peers:
    """The clients of an entry that has no connections, one for each address; `refused` is told of all of them."""

    def __init__(self, door: Door, protocol: str, allow: list[str], refused: Refused) -> None:
        self._door, self._protocol, self._allow, self._refused = door, protocol, allow, refused
        self._known: Mapping[bool, OrderedDict[str, Client]] = {True: OrderedDict(), False: OrderedDict()}

    def of(self, host: str) -> Client:
        """The client at that address, which has just sent something."""
        allowed = is_allowed(host, self._allow)
        known = self._known[allowed]  # strangers never make one that is allowed be forgotten
        if host not in known:
            known[host] = Client(self._door, f"{self._protocol} {host}", self._refused, allowed)
        known.move_to_end(host)
        while len(known) > PEERS:
            known.popitem(last=False)[1].close()
        known[host].seen()
        return known[host]

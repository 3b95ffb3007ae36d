"""Has a move chase timecode, or start with it: plays it in time, tells it where the code is, and stops it.

A code that is there when the rig could move moves it, so there are rules. It is taken only near the move's own part of
it. After a STOP, and whatever else ends the move, it counts again only once it was lost and has come back. A move that
was paused because the code was lost goes on with the code.
"""

from __future__ import annotations

import asyncio
from collections.abc import Mapping
from contextlib import suppress
from time import monotonic
from typing import Any

from teleop.config.exchange.timecode import TimecodeSection, label
from teleop.core.errors import DeviceError
from teleop.exchange.client import Client
from teleop.exchange.served import Served
from teleop.exchange.timecode.input import INPUTS, Opener
from teleop.exchange.timecode.tracker import Tracker
from teleop.planner.chasing import Reference

STEP = 0.05  # s between two looks at the timecode
SAY = 0.1  # s between two words to the move of where it is
LOOK = 1.0  # s between two looks whether the port is there, and until it is opened again
SEEN = 0.5  # s between two words that somebody is there
GIVEN_UP = 10.0  # s without timecode, after which the move is over and control free
UNANSWERED = 4  # commands
AGAIN = 2.0  # s until the same line may come again


async def serve(section: TimecodeSection, served: Served) -> None:
    """Serve until cancelled. Raises UsageError without the packages that it needs."""
    await serve_input(section, served, INPUTS[section.source])


async def serve_input(section: TimecodeSection, served: Served, opener: Opener) -> None:
    """As `serve`, with what `opener` opens; it may block."""
    said = ""
    while True:
        try:
            heard = await asyncio.to_thread(opener, section)
            said = ""
            chaser = Chaser(section, served)
            try:
                looked = monotonic()
                while True:
                    now = monotonic()
                    heard.understand(chaser.tracker)
                    chaser.step(now)
                    if now - looked >= LOOK:
                        looked = now
                        if trouble := await asyncio.to_thread(heard.trouble):
                            raise DeviceError(trouble)
                    await asyncio.sleep(STEP)
            finally:
                chaser.close()
                await asyncio.to_thread(heard.close)
        except DeviceError as error:
            if str(error) != said:
                said = str(error)
                served.notify(f"timecode: {error}; tried again until it works")
        await asyncio.sleep(LOOK)


class Chaser:
    """The client that plays the move. Call `step` often; its times are `monotonic`."""

    def __init__(self, section: TimecodeSection, served: Served) -> None:
        self._section, self._served = section, served
        rate, latency = section.rate, section.latency / 1000
        self.tracker = Tracker(rate, label(section.at), latency)
        self._client = Client(served.door, f"{section.source.upper()} timecode", self._say)
        self._playing: asyncio.Task[None] | None = None
        self._done = 0  # the lock of the timecode with which the move has been played
        self._told = self._seen = self._locked_at = -1e9
        self._telling: set[asyncio.Task[None]] = set()
        self._paused = False  # by us
        self._why, self._said, self._said_at = "", "", -1e9

    def step(self, now: float) -> None:
        tracker = self.tracker
        tracker.look(now)
        if tracker.why != self._why:
            self._why = tracker.why
            if tracker.why:
                self._break()
        state = self._served.door.state()
        if not state:
            return
        if now - self._seen >= SEEN:
            self._seen = now
            self._client.seen()
        reference = tracker.reference(now)
        move = state["move"] if state["holder_session"] == self._client.session else None
        if reference is None:
            if move is not None and now - self._locked_at > GIVEN_UP and self._playing is not None:
                self._locked_at = now
                self._client.post({"do": "abort"})
            return
        self._locked_at = now
        if move is not None:
            self._chase(move, reference, now)
        elif self._playing is None and self._done != tracker.locks and reference.at >= -self._section.ready:
            self._done = tracker.locks
            self._playing = asyncio.get_running_loop().create_task(self._play(reference.at))

    def _chase(self, move: dict[str, Any], reference: Reference, now: float) -> None:
        if reference.at > move["duration"] + 1.0 and move["phase"] in ("easing", "preroll", "armed"):
            self._client.post({"do": "abort"})  # the code is past the move: there is nothing to play
            return
        if move["phase"] == "paused" and move["why"]:  # on the way to its path, where it can follow nothing yet
            if self._paused:
                self._tell({"do": "resume"})
                self._paused = False
        elif now - self._told >= SAY:
            self._told = now
            free = {"free": True} if self._section.start is not None else {}
            place = {"at": round(reference.at, 6), "time": now * 1000, "rate": round(reference.rate, 6), **free}
            self._tell({"do": "chase", **place})

    async def _play(self, place: float) -> None:
        """Until the move has ended."""
        move = self._section.move
        self._say(f"plays {move}: {-place:.1f} s to go" if place < 0 else f"plays {move}, {place:.1f} s in")
        try:
            answer = await self._client.command({"do": "play", "move": move, "chase": True, "preroll": 0.0})
            if "ok" in answer:
                answer = await self._client.finished(answer["id"])
            if why := answer.get("error", ""):
                self._say(f"{move}: {why}")
        finally:
            self._playing = None

    def _break(self) -> None:
        """The timecode is lost, or none: said, and a legal stop."""
        if self._playing is not None or self._why != "is lost":
            self._say(self._why)
        if self._playing is not None:
            self._paused = True
            self._tell({"do": "pause"})

    def _tell(self, command: Mapping[str, Any]) -> None:
        """A command that leaves control with the move, where another one's would end with what it does."""
        if len(self._telling) < UNANSWERED:
            task = asyncio.get_running_loop().create_task(self._told_to(command))
            self._telling.add(task)
            task.add_done_callback(self._telling.discard)

    async def _told_to(self, command: Mapping[str, Any]) -> None:
        answer = await self._served.door.command(command, self._client.session, self._client.name)
        if answer.get("kind") != "busy":
            self._say(answer.get("error", ""))

    def close(self) -> None:
        if self._playing is not None:
            self._playing.cancel()
        for task in self._telling:
            task.cancel()
        self._client.close()

    def _say(self, why: str) -> None:
        now = monotonic()
        if why and (why != self._said or now - self._said_at > AGAIN):
            self._said, self._said_at = why, now
            with suppress(OSError):
                self._served.notify(f"timecode {self._section.source}: {why}")

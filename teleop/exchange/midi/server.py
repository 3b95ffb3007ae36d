"""Serves a controller: opened by its name, again when it comes back, and what it moves ends when it goes."""

from __future__ import annotations

import asyncio
from collections import deque
from collections.abc import Callable, Sequence
from contextlib import suppress
from time import monotonic
from typing import Protocol

from teleop.config.exchange.midi import MidiSection
from teleop.core.errors import DeviceError
from teleop.exchange.client import Client
from teleop.exchange.midi.feedback import Feedback
from teleop.exchange.midi.stick import WheelStick
from teleop.exchange.midi.surface import STOP, Command, Surface
from teleop.exchange.served import Served
from teleop.links.midi_ports import MidiPort

STEP = 0.02  # s: sticks are sent 50 times a second
EARLY = 0.002  # s that a step may come before its time
FEEDBACK = 0.05  # s between two messages of a light or a motor
LOOK = 1.0  # s between two looks whether the port is there, and until a lost one is opened again
SEEN = 0.5  # s between two words that the controller is there
MOST = 4096  # messages that wait; the oldest goes, but never a STOP
ENDING = 0.5  # s for what it has begun to end

Listener = Callable[[Sequence[int]], object]


class Port(Protocol):
    """What a controller needs of its port."""

    @property
    def has_feedback(self) -> bool: ...

    @property
    def is_there(self) -> bool: ...

    def send(self, data: Sequence[int]) -> None: ...

    def close(self) -> None: ...


async def serve(section: MidiSection, served: Served) -> None:
    """Serve until cancelled. Raises UsageError without the packages."""

    def opener(listener: Listener) -> Port:
        return MidiPort(section.port, section.feedback or "", section.api, section.virtual, listener)

    await serve_port(section, served, opener)


async def serve_port(section: MidiSection, served: Served, opener: Callable[[Listener], Port]) -> None:
    """As `serve`, at the ports that `opener` opens; it may block."""
    said = ""
    while True:
        controller = Controller(section, served)
        try:
            port = await asyncio.to_thread(opener, controller.hear)
            try:
                said = ""
                served.notify(f"MIDI {section.port}: connected")
                await controller.run(port)
            finally:
                await asyncio.to_thread(port.close)
        except DeviceError as error:
            if str(error) != said:
                said = str(error)
                served.notify(f"MIDI {section.port}: {error}; tried again until it works")
        await asyncio.sleep(LOOK)


class Controller:
    """A controller that is connected."""

    def __init__(self, section: MidiSection, served: Served) -> None:
        self._section, self._served = section, served
        self._surface = Surface(section, served.rig.moved)
        self._feedback = Feedback(self._surface)
        self._client = Client(served.door, f"MIDI {section.port}", self._say)
        self._stick = WheelStick(served.door, self._client, self._say)
        self._heard: deque[tuple[float, Sequence[int]]] = deque(maxlen=MOST)
        self._stopped = False  # a STOP has come, which no queue may lose
        self._loop, self._wake, self._woken = asyncio.get_running_loop(), asyncio.Event(), False
        self._jogging: dict[str, asyncio.Task[None]] = {}
        self._late = False
        self._stepped = -1e9

    def hear(self, data: Sequence[int]) -> None:
        """A message, in the port's thread."""
        self._stopped = self._stopped or self._surface.stops(data)
        self._heard.append((monotonic(), data))
        if not self._woken:
            self._woken = True
            with suppress(RuntimeError):  # the loop is closed
                self._loop.call_soon_threadsafe(self._wake.set)

    async def run(self, port: Port) -> None:
        """Until the port is gone: raises DeviceError then."""
        seen = looked = fed = -1e9
        try:
            while True:
                now = monotonic()
                self._take(now)
                if now - seen >= SEEN:
                    seen = now
                    self._client.seen()
                if now - fed >= FEEDBACK:
                    fed = now
                    self._feed(port, now)
                if now - looked >= LOOK:
                    looked = now
                    if not await asyncio.to_thread(lambda: port.is_there):
                        raise DeviceError("the port is gone")
                await self._wait()
        except DeviceError:
            await self._end()
            raise
        finally:
            self._stick.close()
            self._client.close()
            with suppress(DeviceError):
                for message in self._feedback.out():
                    port.send(message)

    async def _wait(self) -> None:
        with suppress(TimeoutError):
            await asyncio.wait_for(self._wake.wait(), STEP)
        self._wake.clear()

    def _take(self, now: float) -> None:
        """What has come since the last time."""
        self._woken = False
        if self._stopped:
            self._stopped = False
            self._client.stop()
        while self._heard:
            at, data = self._heard.popleft()
            command = self._surface.take(data, at)
            if command is not None and command != STOP:
                self._press(command)
        state = self._served.door.state()
        if not state:
            return
        if goto := self._surface.goto(state, now, self._client.session):
            self._client.newest(goto)
        for axis, jog in self._surface.jogs().items():
            if axis in self._jogging:
                self._surface.turned(axis, jog["by"])
            else:
                self._jogging[axis] = self._loop.create_task(self._jog(axis, jog))
        if now - self._stepped >= STEP - EARLY:
            self._stepped = now
            self._stick.step(self._surface.deflections(now))
        if self._surface.late and not self._late:
            self._say("a wheel with a spring was held and not heard: its axis rests; center it")
        self._late = self._surface.late

    def _press(self, command: Command) -> None:
        if command["do"] == "play":
            self._feedback.played = command["move"]
        self._client.post(command)

    async def _jog(self, axis: str, command: Command) -> None:
        try:
            answer = await self._client.command(command)
        finally:
            del self._jogging[axis]
        if "ok" not in answer:
            self._say(answer.get("error", ""))

    def _feed(self, port: Port, now: float) -> None:
        state = self._served.door.state()
        if state and port.has_feedback:
            for message in self._feedback.messages(state, now):
                port.send(message)

    async def _end(self) -> None:
        """The controller is gone: what it moves comes to rest. A move that it plays pauses as its session closes."""
        state = self._served.door.state()
        if state and state["holder_session"] == self._client.session and state["move"] is None:
            with suppress(TimeoutError):
                await asyncio.wait_for(self._client.command({"do": "abort"}), ENDING)

    def _say(self, why: str) -> None:
        if why:
            self._served.notify(f"MIDI {self._section.port}: {why}")

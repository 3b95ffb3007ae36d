"""A rig with a door, on the virtual clock and in one process: clients send real datagrams, and time passes in `run`."""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Mapping
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Any

import msgpack
from hands import FakeInput
from wire import Tap, tapped

from teleop.app.beside import both
from teleop.app.run import commands
from teleop.config.presets import Presets
from teleop.config.profile import Profile, load_profile
from teleop.core.axes import Axis
from teleop.core.clock import VirtualClock
from teleop.core.control_loop import ControlLoop
from teleop.core.interfaces import Clock, Observer
from teleop.core.run_state import RunState
from teleop.core.timing import PERIOD
from teleop.devices.camera_answers import CameraAnswers
from teleop.devices.rig import open_rig
from teleop.door.messages import packed
from teleop.door.ring import RingReader
from teleop.door.sockets import ClientSocket
from teleop.door.states import StateUnpacker
from teleop.manual.operator import Operator
from teleop.remote.gateway_child import Gateway
from teleop.remote.remote_hands import RemoteHands

PROFILE = """
name: Bench
links: {gimbal: "sim:"}
axes:
  pan:  {min: -180, max: 180, velocity: 60, acceleration: 240, jerk: 2400}
  tilt: {min: -50, max: 90, velocity: 60, acceleration: 240, jerk: 2400}
sinks: [{type: gimbal, link: gimbal, mode: position, rate: 50}, {type: camera, link: gimbal}]
sticks: {start_range: 3, ramp: 0.1, low_pass: 0, expo: 0}
"""
ANNA, BOB = "anna", "bob"


class RemoteBench:
    """`pad` is at the rig. Answers are kept by the id of their command, and how each action ended in `ends`."""

    def __init__(
        self,
        loop: ControlLoop,
        hands: RemoteHands,
        operator: Operator,
        pad: FakeInput,
        clock: Clock,
        tap: Tap,
    ) -> None:
        self.loop, self.hands, self.operator, self.pad, self.clock, self.tap = loop, hands, operator, pad, clock, tap
        self.answers: dict[int, dict[str, Any]] = {}
        self.ends: dict[int, dict[str, Any]] = {}
        self.sent: dict[int, bytes] = {}
        self.quiet = False  # the gateway says nothing of itself
        self.seen: dict[str, float] = {}  # pages that live, by session: ms since they were heard
        self._ids = itertools.count(1)
        self._seq: dict[str, int] = {}
        self._reader, self._unpacker = RingReader(hands.door.address.ring), StateUnpacker()
        self._socket = ClientSocket(hands.door.address.client(1), hands.door.address.commands)
        self._told = -1.0

    def close(self) -> None:
        self._socket.close()
        self._reader.close()

    @property
    def now(self) -> float:
        return self.clock.now()

    @property
    def state(self) -> dict[str, Any]:
        newest = self._reader.newest()
        assert newest is not None
        return self._unpacker.unpack(newest.data)

    def send(self, data: bytes) -> None:
        self._socket.send(data)

    def say(self, do: str, session: str = ANNA, **fields: Any) -> int:
        """Send a command; its id. It is taken in the next tick."""
        number = next(self._ids)
        message: Mapping[str, Any] = {"do": do, "id": number, "session": session, "person": session.title(), **fields}
        self.sent[number] = packed(message)
        self.send(self.sent[number])
        return number

    def ask(self, do: str, session: str = ANNA, **fields: Any) -> dict[str, Any]:
        """The answer to a command, in the tick that takes it."""
        number = self.say(do, session, **fields)
        self.tick()
        return self.answers[number]

    def stick(self, session: str = ANNA, late: float = 0.0, skip: int = 0, **axes: float) -> None:
        """A message of a stick that was sent `late` s ago, with `skip` lost before it."""
        self._seq[session] = self._seq.get(session, -1) + 1 + skip
        sent = (self.now - late) * 1000 + 5e8  # by a clock of its own
        message = {"do": "stick", "id": 0, "session": session, "seq": self._seq[session], "time": sent, "axes": axes}
        self.send(packed(message))

    def hold(self, seconds: float, session: str = ANNA, **axes: float) -> None:
        """A finger down for so long: 50 messages a second."""
        end = self.now + seconds
        while self.now < end - 1e-6:
            self.stick(session, 0.0, 0, **axes)
            self.tick(2)

    def release(self, session: str = ANNA) -> None:
        self.hold(0.06, session, pan=0.0)

    def tick(self, ticks: int = 1) -> None:
        for _ in range(ticks):
            if not self.quiet and self.now - self._told > 0.2:
                self._told = self.now
                self.say("alive", "gateway", seen=self.seen)
            self.loop.turn()
            self._take()

    def run(self, seconds: float) -> None:
        self.tick(round(seconds / PERIOD))

    def _take(self) -> None:
        while True:
            try:
                answer = msgpack.unpackb(self._socket.recv(4096))
            except BlockingIOError:
                return
            (self.ends if answer.get("done") else self.answers)[answer["id"]] = answer

    def speed(self, axis: Axis = Axis.PAN) -> float:
        return self.state["axes"][axis.value]["speed"]

    def at(self, axis: Axis = Axis.PAN) -> float:
        return self.state["axes"][axis.value]["commanded"]

    @property
    def rests(self) -> bool:
        return all(not axis["speed"] for axis in self.state["axes"].values())

    @property
    def lines(self) -> list[str]:
        return [message.text for message in self.operator.status.messages]


@contextmanager
def remote_bench(
    folder: Path,
    clock: Clock | None = None,
    observer: Observer | None = None,
    gateway: Gateway | None = None,
    more: str = "",
) -> Iterator[RemoteBench]:
    """On the virtual clock unless another is given; `observer` sees each tick before the door does.

    `more` is added to the profile.
    """
    with ExitStack() as stack:
        clock, profile, pad = clock or VirtualClock(), _profile(folder, more), FakeInput()
        hands = RemoteHands(folder, gateway)
        hands.open(stack, profile, profile.limits)
        presets = Presets(folder / "presets.yaml")
        stack.callback(presets.close)
        operator = Operator(profile.limits, [pad, *hands.inputs], presets, profile.sticks, 2.0, hands.beneath)
        rig = stack.enter_context(open_rig(profile, clock))
        tap = tapped(rig)
        seen = [] if observer is None else [observer]
        own, sink = hands.attach(stack, operator, presets, rig)
        notify = both(operator.notify, hands.line)
        observers, sinks = commands(rig, list(profile.axes), notify, both(operator.confirmed, hands.confirmed))
        answered = both(operator.camera_answered, hands.camera_answered)
        observers.append(CameraAnswers(rig.camera, notify, answered, lenient=True))
        loop = rig.loop(list(profile.axes), [operator], [*observers, *seen, own], [*sinks, sink])
        bench = RemoteBench(loop, hands, operator, pad, clock, tap)
        stack.callback(bench.close)
        while loop.supervisor.state is RunState.WAITING:
            loop.turn()
        bench.tick(2)
        yield bench


def _profile(folder: Path, more: str) -> Profile:
    (folder / "rig.yaml").write_text(PROFILE + more)
    return load_profile(str(folder / "rig.yaml"))

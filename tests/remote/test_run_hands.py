"""The door of a run that moves by itself, on the virtual clock: clients see it, stop it, pause it and end it."""

from __future__ import annotations

import itertools
from collections.abc import Callable
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import msgpack
from silent_screen import SilentScreen, no_signals

from teleop.app.planning import plan_content
from teleop.app.play import source_of
from teleop.app.sequence_run import SequenceReport, SequenceRun
from teleop.config.profile import load_profile
from teleop.core.clock import VirtualClock
from teleop.core.events import Tick
from teleop.door.messages import packed
from teleop.door.ring import RingReader
from teleop.door.sockets import ClientSocket
from teleop.door.states import StateUnpacker
from teleop.remote.run_hands import RunHands
from teleop.sequence.cycle import Cycle

MOVE = {"title": "across", "keyframes": [{"at": 0, "pan": 0}, {"at": 3, "pan": 20}, {"at": 6, "pan": 0}]}


class Client(SilentScreen):
    """A screen of the run that is a client too: `script` says what to do at a time (s) of the run."""

    def __init__(self, hands: RunHands, script: dict[float, Callable[[Client], object]]) -> None:
        super().__init__()
        self._hands, self._script = hands, dict(script)
        self._ids = itertools.count(1)
        self.answers: dict[int, dict[str, Any]] = {}
        self.states: list[dict[str, Any]] = []
        self._begin: float | None = None

    def open(self) -> None:
        self._reader, self._unpacker = RingReader(self._hands.door.address.ring), StateUnpacker()
        self._socket = ClientSocket(self._hands.door.address.client(1), self._hands.door.address.commands)

    def say(self, do: str, session: str = "anna", **fields: Any) -> int:
        number = next(self._ids)
        self._socket.send(packed({"do": do, "id": number, "session": session, "person": session.title(), **fields}))
        return number

    def observe(self, tick: Tick) -> None:
        super().observe(tick)
        if self._begin is None:
            self._begin = tick.time
            self.open()
        newest = self._reader.newest()
        assert newest is not None
        self.states.append(self._unpacker.unpack(newest.data))
        while (at := min(self._script, default=1e9)) <= tick.time - self._begin:
            self._script.pop(at)(self)
        while True:
            try:
                answer = msgpack.unpackb(self._socket.recv(4096))
            except BlockingIOError:
                return
            self.answers.setdefault(answer["id"], answer)


def play(folder: Path, script: dict[float, Callable[[Client], object]]) -> tuple[Client, SequenceReport]:
    profile = load_profile("sim")
    sequence = plan_content(MOVE, profile).sequence
    source = source_of(sequence, profile, 1.0, 1.0, Cycle())
    hands = RunHands(None)
    client = Client(hands, script)
    nothing: Callable[[str], object] = lambda _line: None  # noqa: E731
    clock = VirtualClock()
    run = SequenceRun(profile, sequence, source, clock, None, nothing, nothing, patient=True, beside=hands)
    with ExitStack():
        report = run.perform(lambda *_: client, no_signals)
    return client, report


def test_everybody_sees_the_move_to_its_end(tmp_path: Path) -> None:
    client, report = play(tmp_path, {})
    assert not report.run.reasons
    moves = [state["move"] for state in client.states if state["move"]]
    assert {move["title"] for move in moves} == {"across"}
    assert [phase for phase, _ in itertools.groupby(move["phase"] for move in moves)][-2:] == ["playing", "resting"]
    at_peak = min(client.states, key=lambda state: abs((state["move"]["at"] or 0) - 3))
    assert abs(at_peak["axes"]["pan"]["measured"] - 20) < 0.5


def test_a_watcher_stops_it_and_the_holder_clears_and_goes_on(tmp_path: Path) -> None:
    asked: dict[str, int] = {}
    client, report = play(
        tmp_path,
        {
            2.0: lambda it: asked.update(stop=it.say("stop", "watcher")),
            4.0: lambda it: asked.update(early=it.say("clear", "bob"), take=it.say("take_control")),
            4.5: lambda it: it.say("stop", "bob"),
            5.5: lambda it: asked.update(busy=it.say("resume", "bob"), clear=it.say("clear")),
            6.0: lambda it: asked.update(resume=it.say("resume")),
        },
    )
    assert not report.run.reasons
    assert client.answers[asked["busy"]]["holder"] == "Anna"
    assert all("ok" in client.answers[asked[name]] for name in ("stop", "early", "take", "clear", "resume"))
    stopped = [state for state in client.states if state["stopped"]]
    assert {state["stopped_by"] for state in stopped} == {"Watcher", "Bob"}
    assert any(state["holder"] == "Anna" for state in client.states)


def test_what_moves_by_itself_takes_no_other_way(tmp_path: Path) -> None:
    asked: dict[str, int] = {}
    client, report = play(
        tmp_path,
        {
            1.0: lambda it: it.say("take_control"),
            1.5: lambda it: asked.update(goto=it.say("goto", axes={"pan": 1.0})),
            2.0: lambda it: asked.update(abort=it.say("abort")),
        },
    )
    assert client.answers[asked["goto"]]["kind"] == "refused"
    assert report.run.reasons == ["stopped by Anna"]

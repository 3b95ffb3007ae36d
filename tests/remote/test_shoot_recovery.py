"""A shoot that a client began outlasts a run of the rig that failed for a reason that passes, with door and take."""

from __future__ import annotations

import itertools
from collections.abc import Callable
from pathlib import Path
from typing import Any

import msgpack
import pytest
from fake_hid import FakeBackend
from silent_screen import SilentScreen, no_signals

from teleop.app import live as live_module
from teleop.app import operator_inputs
from teleop.app.live import LiveParts, LiveRun
from teleop.app.run import RunReport
from teleop.config.profile import load_profile
from teleop.core.clock import VirtualClock
from teleop.core.errors import LinkError
from teleop.core.events import Tick
from teleop.core.run_state import Result
from teleop.devices.connection import Connection
from teleop.door.messages import packed
from teleop.door.ring import RingReader
from teleop.door.sockets import ClientSocket
from teleop.door.states import StateUnpacker
from teleop.recording.reader import read_take
from teleop.remote.remote_hands import RemoteHands

FRAMES = 6
PROFILE = """
name: Bench
links: {gimbal: "sim:"}
axes: {pan: {min: -180, max: 180, velocity: 60, acceleration: 240, jerk: 2400}}
sinks: [{type: gimbal, link: gimbal, mode: position, rate: 50}, {type: camera, link: gimbal}]
timelapse: {wait_for_link: WAITS}
"""


class Operator:
    """One client over all runs. `loses` is the frame at which the link is lost, `absent` how often it is not found."""

    def __init__(self, folder: Path, monkeypatch: pytest.MonkeyPatch, waits: bool, absent: int = 2) -> None:
        self.loses, self.runs, self.tries = 3, 0, absent
        (folder / "rig.yaml").write_text(PROFILE.replace("WAITS", str(waits).lower()))
        self.clock, self.hands = VirtualClock(), RemoteHands(folder, None)
        self.folder, self.lines, self.waiting = folder, [], []
        self._ids = itertools.count(1)
        self.ends: dict[int, dict[str, Any]] = {}
        self.answers: dict[int, dict[str, Any]] = {}
        self.lost, self.over = False, 0
        self.while_lost: Callable[[], object] = lambda: None
        poll, present = Connection.poll, live_module.open_present

        def polled(connection: Connection, now: float) -> None:
            if self.lost:
                raise LinkError("gimbal on sim:: lost")
            poll(connection, now)

        def opened(*arguments: Any) -> Any:
            if self.lost and self.tries > 0:
                self.tries -= 1
                self.while_lost()
                raise LinkError("gimbal on sim:: cannot be opened")
            self.lost = False
            return present(*arguments)

        monkeypatch.setattr(Connection, "poll", polled)
        monkeypatch.setattr(live_module, "open_present", opened)

    def run(self) -> RunReport:
        profile = load_profile(str(self.folder / "rig.yaml"))
        return LiveRun(
            *(profile, "bench", self.clock, None), presets=self.folder / "p.yaml", take=self.folder / "a.mcap",
            beside=self.hands,
        ).by_hand(lambda parts: Watch(self, parts), no_signals)  # fmt: skip

    def say(self, do: str, **fields: Any) -> int:
        number = next(self._ids)
        self.socket.send(packed({"do": do, "id": number, "session": "anna", "person": "Anna", **fields}))
        return number

    def observe(self, tick: Tick) -> None:
        if self.runs == 1 and not hasattr(self, "socket"):
            address = self.hands.door.address
            self.socket, self._reader = ClientSocket(address.client(1), address.commands), RingReader(address.ring)
            self._unpacker = StateUnpacker()
            self.say("take_control")
            self.shoot = self.say("shoot", move="turn")
        self.take_answers()
        state = self.state
        if (shoot := state["shoot"]) and shoot["frames_done"] >= self.loses:
            self.loses, self.lost = FRAMES + 1, True
        self.over += self.shoot in self.ends or "error" in self.answers.get(self.shoot, {})
        if self.over > 3:  # ticks: what there is to tell is told
            raise KeyboardInterrupt

    def take_answers(self) -> None:
        while True:
            try:
                answer = msgpack.unpackb(self.socket.recv(4096))
            except BlockingIOError:
                return
            (self.ends if answer.get("done") else self.answers)[answer["id"]] = answer

    @property
    def state(self) -> dict[str, Any]:
        newest = self._reader.newest()
        assert newest is not None
        return self._unpacker.unpack(newest.data)


class Watch(SilentScreen):
    def __init__(self, operator: Operator, parts: LiveParts) -> None:
        super().__init__()
        self._operator, self._parts = operator, parts
        operator.runs += 1

    def observe(self, tick: Tick) -> None:
        super().observe(tick)
        new = [message.text for message in reversed(self._parts.operator.status.messages)]
        self._operator.lines += [line for line in new if line not in self._operator.lines]
        self._operator.observe(tick)


@pytest.fixture(autouse=True)
def no_devices(monkeypatch: pytest.MonkeyPatch, planned: None) -> None:
    monkeypatch.setattr(operator_inputs, "AllDevices", FakeBackend)


def test_a_link_that_is_lost_and_found_again_costs_slots_and_no_frame(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    operator = Operator(tmp_path, monkeypatch, waits=True)
    operator.while_lost = lambda: operator.waiting.append(
        (operator.state["run"], operator.say("goto", axes={"pan": 1}))
    )
    report = operator.run()
    assert operator.ends[operator.shoot]["ok"], operator.ends
    assert operator.runs == 2
    assert operator.tries == 0
    assert [run for run, _ in operator.waiting] == ["waiting", "waiting"]
    assert "the rig is not reached" in operator.answers[operator.waiting[0][1]]["error"]
    assert any("waiting for the link, then going on at frame 3" in line for line in operator.lines), operator.lines
    assert any("6 of 6 frames shot" in line for line in operator.lines)
    assert report.take is not None
    assert read_take(tmp_path / "a.mcap").about.title == "bench"


def test_an_abort_ends_the_wait_for_the_rig(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    operator = Operator(tmp_path, monkeypatch, waits=True, absent=99)
    operator.while_lost = lambda: operator.say("abort")
    report = operator.run()
    operator.take_answers()
    assert report.result is Result.FAILED
    assert operator.ends[operator.shoot]["error"] == "aborted by Anna"
    assert operator.runs == 1


def test_a_link_that_is_lost_ends_it_where_the_profile_does_not_wait_and_it_can_be_resumed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    operator = Operator(tmp_path, monkeypatch, waits=False)
    report = operator.run()
    assert report.result is Result.FAILED
    operator.take_answers()
    assert operator.ends[operator.shoot]["error"] == "the run has ended"
    again = Operator(tmp_path, monkeypatch, waits=False)
    operator.lost, again.loses = False, FRAMES + 1
    say = again.say
    again.say = lambda do, **fields: say(do, **(fields if do != "shoot" else {**fields, "resume": True}))  # type: ignore[method-assign]
    (tmp_path / "a.mcap").unlink()
    again.run()
    assert again.ends[again.shoot]["ok"]


def test_a_stop_that_is_not_cleared_outlasts_the_run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    operator = Operator(tmp_path, monkeypatch, waits=True)
    told: list[str] = []
    operator.while_lost = lambda: told or told.append(str(operator.say("stop")))
    observe = operator.observe

    def stopped(tick: Tick) -> None:
        observe(tick)
        if operator.runs == 2 and operator.state["stopped"]:
            told.append(operator.state["stopped_by"])
            raise KeyboardInterrupt

    operator.observe = stopped  # type: ignore[method-assign]
    operator.run()
    assert told[-1] == "Anna"

"""When timecode has its move played, and what it tells it: at a door that only remembers what it was asked."""

from __future__ import annotations

import asyncio
from collections.abc import Mapping
from typing import Any, cast

import pytest

from teleop.config.exchange.timecode import TimecodeSection
from teleop.core.errors import DeviceError
from teleop.exchange.served import Rig, Served
from teleop.exchange.timecode import server
from teleop.exchange.timecode.reading import Fault, Reading
from teleop.exchange.timecode.server import Chaser
from teleop.exchange.timecode.tracker import Tracker
from teleop.gateway.door_client import DoorClient

SECTION = {"type": "timecode", "source": "mtc", "port": "Tascam", "chase": "reveal", "at": "01:00:00:00"}


class Door:
    """Says yes to everything, and plays until `end` is set."""

    def __init__(self) -> None:
        self.asked: list[dict[str, Any]] = []
        self.holder: str | None = None
        self.end: asyncio.Future[dict[str, Any]] = asyncio.get_running_loop().create_future()
        self.error = ""
        self.phase, self.why = "armed", ""

    def state(self) -> dict[str, Any]:
        move = {"phase": self.phase, "why": self.why, "duration": 8.0} if self.holder else None
        return {"holder_session": self.holder, "move": move}

    async def command(self, command: Mapping[str, Any], session: str, name: str, brief: bool = False) -> dict[str, Any]:
        self.asked.append(dict(command))
        if command["do"] == "play":
            if self.error:
                return {"error": self.error, "kind": "busy"}
            self.holder = session
        return {"ok": True, "id": 1}

    async def finished(self, number: int) -> dict[str, Any]:
        return await asyncio.shield(self.end)

    def seen(self, session: str) -> None: ...

    def closed(self, session: str) -> None: ...

    def did(self, do: str) -> list[dict[str, Any]]:
        return [each for each in self.asked if each["do"] == do]


class Bench:
    def __init__(self, **fields: Any) -> None:
        self.door, self.lines = Door(), []
        served = Served(cast(DoorClient, self.door), Rig("Bench", {}, {}), None, self.lines.append)
        self.chaser = Chaser(TimecodeSection.model_validate({**SECTION, **fields}), served)
        self.now = 100.0

    async def run(self, seconds: float, place: float | None) -> None:
        """So many s of a code that is `place` s after the hour at their beginning; None for no code."""
        frame = None if place is None else 90000 + round(place * 25)
        for number in range(round(seconds * 25)):
            self.now += 0.04
            if frame is not None:
                whole, frames = divmod(frame + number, 25)
                label = (whole // 3600, whole // 60 % 60, whole % 60, frames)
                self.chaser.tracker.take(Reading(self.now, label, False, 25), self.now)
            self.chaser.step(self.now)
            for _ in range(4):
                await asyncio.sleep(0)


def test_a_move_is_played_from_some_seconds_before_it_and_told_where_the_code_is() -> None:
    async def work() -> None:
        bench = Bench()
        await bench.run(2.0, -40.0)
        assert not bench.door.asked
        await bench.run(1.0, -29.0)  # a jump
        assert bench.door.did("play") == [{"do": "play", "move": "reveal", "chase": True, "preroll": 0.0}]
        await bench.run(1.0, -28.0)
        told = bench.door.did("chase")[-1]
        assert told["at"] == pytest.approx(-27.04 + (told["time"] / 1000 - bench.now), abs=0.01)
        assert "free" not in told
        assert len(bench.door.did("play")) == 1
        assert any("s to go" in line for line in bench.lines)

    asyncio.run(work())


def test_a_code_that_is_lost_pauses_the_move_and_frees_control_after_ten_seconds() -> None:
    async def work() -> None:
        bench = Bench()
        await bench.run(2.0, -10.0)
        await bench.run(0.3, None)
        assert bench.door.did("pause")
        assert not bench.door.did("abort")
        await bench.run(10.0, None)
        assert len(bench.door.did("abort")) == 1
        assert bench.lines[-1] == "timecode mtc: is lost"

    asyncio.run(work())


def test_a_move_that_was_paused_on_its_way_to_the_start_goes_on_when_the_code_is_back() -> None:
    async def work() -> None:
        bench = Bench()
        await bench.run(2.0, -10.0)
        await bench.run(0.3, None)
        bench.door.phase, bench.door.why = "paused", "paused"
        asked = len(bench.door.asked)
        await bench.run(1.0, -7.0)
        assert bench.door.asked[asked:] == [{"do": "resume"}]  # once, and no word to follow until it is on its path
        bench.door.phase, bench.door.why = "armed", ""
        await bench.run(1.0, -6.0)
        assert {each["do"] for each in bench.door.asked[asked + 1 :]} == {"chase"}

    asyncio.run(work())


def test_after_a_stop_or_a_refusal_it_counts_only_once_it_has_come_anew() -> None:
    async def work() -> None:
        bench = Bench()
        bench.door.error = "Anna has control"
        await bench.run(2.0, -10.0)
        assert len(bench.door.did("play")) == 1
        assert "timecode mtc: reveal: Anna has control" in bench.lines
        bench.door.error = ""
        await bench.run(2.0, -8.0)
        assert len(bench.door.did("play")) == 1
        await bench.run(1.0, None)
        await bench.run(2.0, -6.0)
        assert len(bench.door.did("play")) == 2

    asyncio.run(work())


def test_a_move_that_only_starts_with_it_is_told_so_and_a_fault_pauses_it() -> None:
    async def work() -> None:
        bench = Bench(chase=None, start="nudge")
        await bench.run(2.0, -10.0)
        assert bench.door.did("play")[0]["move"] == "nudge"
        assert all(each["free"] for each in bench.door.did("chase"))
        bench.chaser.tracker.take(Fault("runs backwards"), bench.now)
        await bench.run(0.1, None)
        assert bench.door.did("pause")
        assert "timecode mtc: runs backwards" in bench.lines

    asyncio.run(work())


def test_what_cannot_be_opened_is_said_once_and_tried_again(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(server, "LOOK", 0.01)
    opened: list[int] = []

    class Input:
        def understand(self, tracker: Tracker) -> None: ...

        def trouble(self) -> str:
            return "the port is gone"

        def close(self) -> None:
            opened.append(-1)

    def opener(_section: TimecodeSection) -> Input:
        opened.append(1)
        if len(opened) < 4:
            raise DeviceError("no MIDI input has Tascam in its name; there is none")
        return Input()

    async def work() -> None:
        lines: list[str] = []
        served = Served(cast(DoorClient, Door()), Rig("Bench", {}, {}), None, lines.append)
        task = asyncio.create_task(server.serve_input(TimecodeSection.model_validate(SECTION), served, opener))
        async with asyncio.timeout(20):
            while opened.count(-1) < 2:
                await asyncio.sleep(0.01)
        task.cancel()
        assert lines[0] == "timecode: no MIDI input has Tascam in its name; there is none; tried again until it works"
        assert "the port is gone" in lines[1]

    asyncio.run(work())


@pytest.mark.parametrize(
    ("fields", "why"),
    [
        ({"start": "nudge"}, "one of chase and start"),
        ({"chase": None}, "one of chase and start"),
        ({"port": ""}, "mtc needs port"),
        ({"source": "ltc"}, "ltc needs device and rate"),
        ({"rate": 26}, "must be one of 23.976"),
        ({"at": "1:2"}, "must be a timecode"),
        ({"at": "01:00:00:26", "rate": 25}, "there is no 01:00:00:26 at 25"),
        ({"at": "01:01:00;01", "rate": 29.97}, "there is no"),
        ({"chase": "../x"}, "chase"),
        ({"device": "rm -rf"}, "must be alsa:NAME"),
    ],
)
def test_an_entry_that_makes_no_sense_is_refused(fields: dict[str, Any], why: str) -> None:
    with pytest.raises(ValueError, match=why):
        TimecodeSection.model_validate({**SECTION, **fields})

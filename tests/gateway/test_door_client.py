"""The client of a door in asyncio, against the control process's side, whose virtual time passes between its waits."""

from __future__ import annotations

import asyncio
from pathlib import Path
from typing import Any

import pytest
from door_rig import with_rig
from remote_bench import RemoteBench, remote_bench

from teleop.core.errors import TeleopError
from teleop.door.address import DoorAddress
from teleop.gateway import door_client
from teleop.gateway.door_client import DoorClient


async def done(door: DoorClient, do: str, brief: bool = False, **fields: Any) -> dict[str, Any]:
    answer = await door.command({"do": do, **fields}, "s1", "Anna", brief)
    return await door.finished(answer["id"]) if "ok" in answer else answer


def test_a_command_is_answered_and_then_done(tmp_path: Path) -> None:
    async def work(door: DoorClient, _bench: RemoteBench) -> None:
        assert "ok" in await done(door, "take_control")
        assert "ok" in await done(door, "goto", axes={"pan": 10.0}, seconds=1.0)
        state = door.state()
        assert state["axes"]["pan"]["commanded"] == pytest.approx(10)
        assert (state["holder"], state["holder_session"]) == ("Anna", "s1")
        assert "ok" in await done(door, "preset_store", number=1, name="wide")
        assert door.state()["presets"]["1"]["name"] == "wide"  # what is answered is in the state already

    with_rig(tmp_path, work)


def test_what_is_refused_or_malformed_says_why_and_of_which_kind(tmp_path: Path) -> None:
    async def work(door: DoorClient, _bench: RemoteBench) -> None:
        await done(door, "take_control")
        assert (await done(door, "goto", axes={"pan": 500.0}))["kind"] == "refused"
        assert (await done(door, "fly"))["kind"] == "invalid"
        assert (await done(door, "goto", axes={"pan": "far"}))["kind"] == "invalid"
        assert (await done(door, "message", name="x" * 3000))["kind"] == "invalid"
        busy = await door.command({"do": "goto", "axes": {"pan": 1.0}}, "s2", "Bob", brief=True)
        assert (busy["kind"], busy["holder"]) == ("busy", "Anna")
        assert (await door.finished(999))["kind"] == "invalid"
        with pytest.raises(ValueError, match="stick"):
            door.stick({"seq": 0, "axes": {"pan": 2.0}}, "s1")

    with_rig(tmp_path, work)


def test_a_client_cannot_speak_for_another_one(tmp_path: Path) -> None:
    async def work(door: DoorClient, bench: RemoteBench) -> None:
        await done(door, "take_control")
        fields = {"do": "set_key", "id": 1, "session": "s1", "brief": True}
        answer = await door.command(fields, "s2", "Bob")
        assert (answer["kind"], answer["holder"]) == ("busy", "Anna")
        assert bench.hands.desk.control.name == "Anna"

    with_rig(tmp_path, work)


def test_a_stop_is_shown_with_its_name(tmp_path: Path) -> None:
    async def work(door: DoorClient, _bench: RemoteBench) -> None:
        assert "ok" in await door.command({"do": "stop"}, "watcher", "Tablet")
        assert (door.state()["stopped"], door.state()["stopped_by"]) == (True, "Tablet")

    with_rig(tmp_path, work)


def test_only_the_newest_states_come(tmp_path: Path) -> None:
    async def work(door: DoorClient, _bench: RemoteBench) -> None:
        ticks: list[int] = []
        async for state in door.states():
            ticks.append(state["tick"])
            if len(ticks) == 5:
                break
        assert ticks == sorted(set(ticks))

    with_rig(tmp_path, work)


def test_a_rig_that_does_not_answer_is_lost_and_not_waited_for(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(door_client, "TIMEOUT", 0.1)

    async def run() -> None:
        with remote_bench(tmp_path) as bench:
            async with DoorClient(bench.hands.door.address) as door:
                assert (await door.command({"do": "set_key"}, "s1", "Anna"))["kind"] == "lost"
                for seq in range(100):  # its queue is full: the newest is kept, and nothing waits
                    door.stick({"seq": seq, "axes": {"pan": 0.0}}, "s1")
                assert len(door._sticks) == 1
                bench.loop.turn()
                streams = bench.hands.desk.stick._streams
                while "s1" not in streams or streams["s1"].seq < 99:
                    await asyncio.sleep(0)
                    bench.loop.turn()

    asyncio.run(run())


def test_where_there_is_no_door_the_error_says_so(tmp_path: Path) -> None:
    async def run() -> None:
        async with DoorClient(DoorAddress(tmp_path)):
            pass

    with pytest.raises(TeleopError, match="ring"):
        asyncio.run(run())


def test_the_answer_counts_that_comes_together_with_the_word_that_it_is_planned(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(door_client, "PLANNING", 1.0)

    async def run() -> None:
        with remote_bench(tmp_path) as bench:
            async with DoorClient(bench.hands.door.address) as door:

                def sent(_data: bytes, first: bool = False) -> None:
                    (number,) = door._answers
                    for answer in ({"planning": True}, {"planning": True}, {"ok": True}):  # the command went twice
                        door._take({"id": number, **answer})

                monkeypatch.setattr(door, "_send", sent)
                assert "ok" in await door.command({"do": "play", "move": "reveal"}, "s1", "Anna")

    asyncio.run(run())

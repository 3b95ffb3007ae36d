"""The peer of a protocol at the door: bounded, named, and never kept from STOP."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable
from pathlib import Path
from typing import Any

import pytest
from door_rig import settled, with_rig
from fake_door import FakeDoor
from remote_bench import RemoteBench

from teleop.exchange import client
from teleop.exchange.client import BURST, UNANSWERED, Client, Peers
from teleop.gateway.door_client import DoorClient


def on_fake(work: Callable[[FakeDoor], Awaitable[None]]) -> FakeDoor:
    async def run() -> FakeDoor:
        door = FakeDoor()
        await asyncio.wait_for(work(door), 10)
        return door

    return asyncio.run(run())


def test_an_action_takes_control_and_frees_it_at_rest(tmp_path: Path) -> None:
    async def work(door: DoorClient, bench: RemoteBench) -> None:
        said: list[str] = []
        osc = Client(door, "OSC 10.0.0.2", said.append)
        other = Client(door, "OSC 10.0.0.3", said.append)
        answer = await osc.command({"do": "goto", "axes": {"pan": 10.0}, "seconds": 1.0})
        assert door.state()["holder"] == "OSC 10.0.0.2"
        refused = await other.command({"do": "goto", "axes": {"pan": -10.0}})
        assert (refused["kind"], refused["holder"]) == ("busy", "OSC 10.0.0.2")
        assert "ok" in await osc.finished(answer["id"])
        await settled(lambda: door.state()["holder"] is None)
        other.post({"do": "goto", "axes": {"pan": 500.0}})
        await settled(lambda: said)
        assert "outside the soft limits" in said[0]

    with_rig(tmp_path, work)


def test_a_stop_counts_without_control_and_after_a_clear_again(tmp_path: Path) -> None:
    async def work(door: DoorClient, bench: RemoteBench) -> None:
        await door.command({"do": "take_control"}, "s1", "Anna")
        osc = Client(door, "OSC 10.0.0.2", print, allowed=False)
        osc.stop()
        await settled(lambda: door.state().get("stopped"))
        assert door.state()["stopped_by"] == "OSC 10.0.0.2"
        await door.command({"do": "clear"}, "s1", "Anna")
        await settled(lambda: not door.state()["stopped"])
        osc.stop()
        await settled(lambda: door.state()["stopped"])

    with_rig(tmp_path, work)


def test_a_flood_is_refused_with_one_word_and_stop_is_not(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(client, "RATE", 1e-9)

    async def work(door: FakeDoor) -> None:
        said: list[str] = []
        osc = Client(door, "OSC 10.0.0.2", said.append)
        for _ in range(1000):
            osc.post({"do": "record"})
        osc.stop()
        await settled(lambda: door.stopped)
        assert len([each for each in said if each.startswith("too many")]) == 1
        assert len([each for each, *_ in door.commands if each["do"] == "record"]) <= min(BURST, UNANSWERED)

    on_fake(work)


def test_of_a_fader_only_the_newest_is_kept() -> None:
    async def work(door: FakeDoor) -> None:
        osc = Client(door, "OSC 10.0.0.2", print)
        for share in range(1, 101):
            osc.newest({"do": "speed", "share": share / 100})
        await settled(lambda: [each for each, *_ in door.commands if each.get("share") == 1.0])
        assert len(door.commands) < 5

    on_fake(work)


def test_one_that_is_not_allowed_is_refused_everything_but_stop() -> None:
    async def work(door: FakeDoor) -> None:
        stranger = Client(door, "OSC 10.0.0.9", print, allowed=False)
        answer: dict[str, Any] = await stranger.command({"do": "record"})
        assert "OSC 10.0.0.9 may only stop" in answer["error"]
        assert not door.commands

    on_fake(work)


def test_strangers_do_not_crowd_out_those_who_are_allowed() -> None:
    async def work(door: FakeDoor) -> None:
        peers = Peers(door, "OSC", ["10.0.0.2"], print)
        known = peers.of("10.0.0.2")
        for number in range(200):
            peers.of(f"10.1.0.{number}")
        assert peers.of("10.0.0.2") is known
        assert len(door.closed_sessions) > 100

    on_fake(work)

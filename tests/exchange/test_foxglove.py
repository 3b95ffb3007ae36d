"""Foxglove's server, judged by a client that speaks its WebSocket protocol by hand, and by what a take has."""

from __future__ import annotations

import asyncio
import io
import json
import struct
from itertools import pairwise
from pathlib import Path
from typing import Any

import pytest
from mcap.reader import make_reader
from remote_bench import RemoteBench
from served_bench import beside_a_rig
from websockets.asyncio.client import ClientConnection, connect
from websockets.typing import Subprotocol

from teleop.config.exchange.foxglove import FoxgloveSection
from teleop.core.axes import Axis, Limits
from teleop.core.events import Action, DeviceCommand, DialInput, Exposure, ShutterStep, Tick
from teleop.door.ticks import as_plain, from_plain
from teleop.exchange import foxglove
from teleop.exchange.served import Served
from teleop.recording.format import About, TakeWriter
from teleop.recording.topics import SCHEMAS

SECTION = FoxgloveSection(type="foxglove", listen="127.0.0.1:0")


class Client:
    """What the public description of the protocol has a client do."""

    def __init__(self, connection: ClientConnection) -> None:
        self._connection = connection
        self.channels: dict[str, dict[str, Any]] = {}
        self.texts: list[dict[str, Any]] = []
        self.messages: dict[str, list[tuple[int, Any]]] = {}
        self._topics: dict[int, str] = {}

    async def until(self, condition: Any) -> Any:
        while not (found := condition()):
            data = await self._connection.recv()
            if isinstance(data, bytes):
                assert data[0] == 1
                number, time = struct.unpack_from("<IQ", data, 1)
                self.messages.setdefault(self._topics[number], []).append((time, json.loads(data[13:])))
            else:
                message = json.loads(data)
                self.texts.append(message)
                self.channels.update({each["topic"]: each for each in message.get("channels", ())})
        return found

    async def send(self, **message: Any) -> None:
        await self._connection.send(json.dumps(message))

    async def subscribe(self, *topics: str) -> None:
        own = [{"id": number, "channelId": self.channels[topic]["id"]} for number, topic in enumerate(topics, 10)]
        self._topics.update(enumerate(topics, 10))
        await self.send(op="subscribe", subscriptions=own)

    def text(self, op: str, **fields: Any) -> dict[str, Any] | None:
        wanted = {"op": op, **fields}.items()
        return next(
            (each for each in self.texts if wanted <= {k: v for k, v in each.items() if k != "x"}.items()), None
        )


def with_client(folder: Path, work: Any) -> list[str]:
    ports: list[int] = []

    async def serve(served: Served) -> None:
        own = Served(served.door, served.rig, None, lambda line: ports.append(int(line.split()[-1])))
        await foxglove.serve(SECTION, own)

    async def connected(bench: RemoteBench, served: Served) -> None:
        while not ports:
            await asyncio.sleep(0.005)
        address, protocols = f"ws://127.0.0.1:{ports[0]}", [Subprotocol("foxglove.sdk.v1")]
        async with connect(address, subprotocols=protocols) as connection:
            await work(bench, Client(connection))

    return beside_a_rig(folder, serve, connected)


def test_the_topics_of_a_take_come_live_with_their_schemas(tmp_path: Path) -> None:
    async def work(bench: RemoteBench, client: Client) -> None:
        await client.until(lambda: len(client.channels) == len(SCHEMAS))
        for topic, channel in client.channels.items():
            assert (channel["encoding"], channel["schemaEncoding"]) == ("json", "jsonschema")
            assert channel["schemaName"] == f"teleop.{SCHEMAS[topic]['title']}"
            assert json.loads(channel["schema"]) == SCHEMAS[topic]
        await client.subscribe("/motion", "/measured", "/demand", "/status")
        bench.say("goto", brief=True, axes={"pan": 5.0}, seconds=1.0)
        motion = client.messages.setdefault("/motion", [])
        await client.until(lambda: motion and motion[-1][1]["pan"]["position"] == pytest.approx(5))
        await client.until(lambda: client.messages["/measured"][-1][1]["pan"] == pytest.approx(5, abs=0.2))
        assert any("follow" in str(each) or "goto" in str(each) for _, each in client.messages["/demand"])
        assert client.messages["/status"][0][1]["stopped"] is False  # by its change or its first subscriber
        times = [time for time, _ in motion]
        steps = {round((b - a) / 1e9, 6) for a, b in pairwise(times)}
        assert times == sorted(times)
        assert min(steps) > 0

    with_client(tmp_path, work)


def test_one_who_speaks_no_websocket_makes_no_line_for_the_operator(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    async def work(bench: RemoteBench, client: Client) -> None:
        host, port = client._connection.remote_address[:2]
        reader, writer = await asyncio.open_connection(host, port)
        writer.write(b"x\r\n\r\n")
        await reader.read()  # until it is closed
        writer.close()

    with_client(tmp_path, work)
    assert not [each for each in caplog.records if each.name.startswith("foxglove")]


def test_parameters_are_read_and_never_set(tmp_path: Path) -> None:
    async def work(bench: RemoteBench, client: Client) -> None:
        info = await client.until(lambda: client.text("serverInfo"))
        assert "parameters" in info["capabilities"]
        assert "clientPublish" not in info["capabilities"]
        await client.send(op="getParameters", parameterNames=[], id="all")
        found = await client.until(lambda: client.text("parameterValues", id="all"))
        values = {each["name"]: each["value"] for each in found["parameters"]}
        assert values["rig"] == "Bench"
        assert values["axes.pan.velocity"] == 60
        await client.send(op="setParameters", parameters=[{"name": "axes.pan.velocity", "value": 999.0}], id="set")
        found = await client.until(lambda: client.text("parameterValues", id="set"))
        assert found["parameters"][0]["value"] == values["axes.pan.velocity"]
        assert await client.until(lambda: client.text("status"))
        for strange in ("{", "[]", '{"op": 1}', '{"op": "subscribe", "subscriptions": [{"id": -1}]}'):
            await client._connection.send(strange)
        await client._connection.send(b"\x01\xff\xff\xff\xff{}")
        await client.send(op="getParameters", parameterNames=["rig", "no"], id="last")
        found = await client.until(lambda: client.text("parameterValues", id="last"))
        assert [each["name"] for each in found["parameters"]] == ["rig"]

    with_client(tmp_path, work)


def test_a_tick_passes_the_door_as_a_take_would_have_it(tmp_path: Path) -> None:
    ticks: list[Tick] = []

    async def work(bench: RemoteBench, served: Served) -> None:
        bench.say("goto", brief=True, axes={"pan": 5.0}, seconds=0.3)
        async for _, tick, _ in served.door.ticks():
            ticks.append(tick)
            if len(ticks) > 40:
                return

    async def nothing(_served: Served) -> None:
        await asyncio.Event().wait()

    beside_a_rig(tmp_path, nothing, work)
    assert len({tick.time for tick in ticks}) == len(ticks)
    events = (Action.RECORD, DeviceCommand("gimbal", "follow", ("mode=lock",)), DialInput(0.5))
    whole = Tick(1.0, ticks[-1].motion, ticks[-1].demand, (*events, Exposure(3, ShutterStep.PRESS)), ticks[-1].reported)
    assert from_plain(json.loads(json.dumps(as_plain(whole)))) == Tick(
        whole.time, whole.motion, whole.demand, list(whole.actions), whole.reported
    )
    stream = io.BytesIO()
    about = About("Bench", "", 1e9, {Axis.PAN: Limits(-180, 180, 60, 240, 2400)}, "1")
    writer = TakeWriter(stream, about)
    for tick in ticks:
        writer.add(tick, None)
    writer.end("ended", [], 0)
    stream.seek(0)
    summary = make_reader(stream).get_summary()
    assert summary is not None
    assert {each.topic for each in summary.channels.values()} == set(SCHEMAS)


@pytest.mark.parametrize(
    ("fields", "why"),
    [
        ({"listen": "0.0.0.0:8765"}, "lets everyone on the network watch"),
        ({"listen": "0.0.0.0:8765", "allow": ["192.168.1.4"]}, "cannot tell its peers apart"),
    ],
)
def test_everyone_may_watch_only_where_the_profile_says_so(fields: dict[str, Any], why: str) -> None:
    with pytest.raises(ValueError, match=why):
        FoxgloveSection(type="foxglove", **fields)
    assert FoxgloveSection(type="foxglove", listen="0.0.0.0:1", allow=["0.0.0.0/0"]).allow

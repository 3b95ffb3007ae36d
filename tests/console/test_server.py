"""The console on a real port: a slow client is held back, a hopeless one dropped, and it ends in time."""

from __future__ import annotations

import asyncio
import json
import socket
import ssl
import sys
import time
from contextlib import asynccontextmanager

import httpx2
import pytest
import websockets
from console_bench import TOKEN
from fake_door import FakeDoor
from websockets.typing import Origin

from teleop.console import connections
from teleop.console import websocket as page_socket
from teleop.console.certificate import with_tls
from teleop.console.server import serve
from teleop.console.settings import ConsoleSettings, listen, with_tokens
from teleop.console.worker import WorkerProcess


async def too_large(connection):
    """Send 10 MB, and read until the connection ends, which raises."""
    await connection.send("x" * 10_000_000)
    while True:
        await connection.recv()


@asynccontextmanager
async def served(settings=None, **wanted):
    """The door and the settings of a console that is served."""
    listener, settings = listen(with_tokens(settings or ConsoleSettings(port=0, **wanted)))
    door = FakeDoor()
    task = asyncio.create_task(serve(settings, door, listener))
    try:
        yield door, settings
    finally:
        task.cancel()
        await asyncio.wait([task], timeout=10)
        listener.close()
        assert task.done()


def test_pages_and_a_websocket_on_a_port_that_was_picked():
    async def scenario():
        async with served(token=TOKEN) as (door, settings):
            base = f"127.0.0.1:{settings.port}"
            bearer = {"Authorization": f"Bearer {TOKEN}"}
            async with httpx2.AsyncClient(base_url=f"http://{base}") as client:
                assert (await client.get("/api/state")).status_code == 401
                assert (await client.get("/api/state", headers=bearer)).json()["rig"] == "fake"
                assert "server" not in (await client.get("/")).headers
            async with websockets.connect(f"ws://{base}/ws", additional_headers=bearer) as connection:
                assert json.loads(await connection.recv())["type"] == "hello"
                await connection.send(json.dumps({"id": 1, "do": "stop"}))
                while json.loads(await connection.recv())["type"] != "answer":
                    pass
                assert door.stopped
                with pytest.raises((websockets.ConnectionClosedError, OSError), match=r"1009|reset"):
                    await too_large(connection)
            with pytest.raises(websockets.InvalidStatus, match="401"):
                await websockets.connect(f"ws://{base}/ws")
            with pytest.raises(websockets.InvalidStatus, match="403"):
                await websockets.connect(
                    f"ws://{base}/ws", additional_headers=bearer, origin=Origin("http://evil.example")
                )

    asyncio.run(scenario())


def test_a_client_that_reads_nothing_is_held_back_then_dropped_and_others_are_not(monkeypatch):
    monkeypatch.setattr(page_socket, "LONGEST_SEND", 0.5)

    async def scenario():
        async with served() as (door, settings):
            small = socket.socket()
            small.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
            small.connect(("127.0.0.1", settings.port))
            reader, writer = await asyncio.open_connection(sock=small, limit=1024)
            writer.write(
                f"GET /ws HTTP/1.1\r\nHost: 127.0.0.1:{settings.port}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
                "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\n\r\n".encode()
            )
            await reader.readuntil(b"\r\n\r\n")
            reader._transport.pause_reading()  # type: ignore[attr-defined]
            sent = 0
            async with websockets.connect(f"ws://127.0.0.1:{settings.port}/ws") as other:
                while not door.closed_sessions:
                    door.tick += 1
                    door.presets = {str(n): {"pan": door.tick + n} for n in range(500)}  # 15 kB that change
                    sent += len(await asyncio.wait_for(other.recv(), 10))
                assert len(door.closed_sessions) == 1
                door.tick += 1
                assert json.loads(await other.recv())["type"] == "delta"
            writer.transport.abort()

    asyncio.run(scenario())


def test_connections_that_ask_for_nothing_are_closed_and_few_of_one_computer(monkeypatch):
    monkeypatch.setattr(connections, "LONGEST_IDLE", 0.2)
    monkeypatch.setattr(connections, "MOST_OF_ONE", 3)

    async def scenario():
        async with served() as (_, settings):
            silent = [await asyncio.open_connection("127.0.0.1", settings.port) for _ in range(4)]
            silent[0][1].write(b"GET /api/state HTTP/1.1\r\nHost:")  # and never the rest
            ends = [asyncio.create_task(reader.read()) for reader, _ in silent]
            done, _ = await asyncio.wait(ends, timeout=10)
            assert len(done) == 4
            async with httpx2.AsyncClient() as client:
                assert (await client.get(f"http://127.0.0.1:{settings.port}/api/state")).status_code == 200
            for _, writer in silent:
                writer.close()

    asyncio.run(scenario())


@pytest.mark.parametrize("bound", ["MOST_OF_ONE", "MOST"])
def test_who_holds_connections_open_keeps_nobody_out(monkeypatch, bound):
    monkeypatch.setattr(connections, bound, 3)

    async def scenario():
        async with served(token=TOKEN) as (_, settings):
            silent = [await asyncio.open_connection("127.0.0.1", settings.port) for _ in range(3)]
            for _, writer in silent:
                writer.write(b"POST /api/stop HTTP/1.1\r\nHost:")  # slowly
            async with httpx2.AsyncClient(headers={"Authorization": f"Bearer {TOKEN}"}) as client:
                assert (await client.post(f"http://127.0.0.1:{settings.port}/api/stop")).json()["stopped"]
            assert await silent[0][0].read() == b""  # the oldest has gone
            for _, writer in silent:
                writer.close()

    asyncio.run(scenario())


def test_with_tls_only_https_is_served(tmp_path):
    async def scenario():
        async with served(with_tls(ConsoleSettings(port=0))) as (_, settings):
            trusting = ssl.create_default_context(cafile=settings.certificate)
            async with httpx2.AsyncClient(verify=trusting) as client:
                assert (await client.get(f"https://127.0.0.1:{settings.port}/api/state")).status_code == 200
                with pytest.raises(httpx2.HTTPError):
                    await client.get(f"http://127.0.0.1:{settings.port}/api/state")

    asyncio.run(scenario())


def test_a_worker_is_a_process_that_ends_with_its_job_or_its_master():
    async def scenario():
        worker = WorkerProcess()
        found = await worker.do("parse", "title: x\n", "x")
        assert found == {"content": {"title": "x"}, "problem": ""}
        process = worker._process
        assert process is not None
        job = asyncio.create_task(worker.do("parse", "a: 1\n" * 100_000, "x"))
        await asyncio.sleep(0)
        job.cancel()
        await asyncio.wait([job])
        assert await process.wait() != 0  # its answer would have been taken for that of the next job
        assert (await worker.do("nope"))["error"]
        await worker.close()

    asyncio.run(scenario())


def test_importing_the_server_and_answering_takes_under_a_second():
    """In one process: what the console adds to the time of an interpreter with what the gateway has anyway."""
    code = (
        "import time, asyncio; import teleop.gateway.door_client; began = time.process_time();"
        "from teleop.console.server import serve; import teleop.console.app as app;"
        "from teleop.console.settings import ConsoleSettings; app.Console(ConsoleSettings(), None);"
        "print(time.process_time() - began)"
    )

    async def scenario():
        process = await asyncio.create_subprocess_exec(sys.executable, "-c", code, stdout=asyncio.subprocess.PIPE)
        return float((await process.communicate())[0])

    assert asyncio.run(scenario()) < 1.0


def test_a_server_that_is_cancelled_ends_with_a_client_connected():
    async def scenario():
        async with served() as (_, settings):
            connection = await websockets.connect(f"ws://127.0.0.1:{settings.port}/ws")
            await connection.recv()
            began = time.monotonic()
        assert time.monotonic() - began < 5
        await connection.close()

    asyncio.run(scenario())

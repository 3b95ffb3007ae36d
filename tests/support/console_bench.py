"""A console on a fake door, in this process: no socket, no rig."""

from __future__ import annotations

import asyncio
import json
from pathlib import Path
from typing import Any

from fake_door import FakeDoor
from starlette.testclient import TestClient

from teleop.console.app import Console
from teleop.console.settings import ConsoleSettings
from teleop.console.worker import jobs, work

TOKEN, WATCH = "operate-me", "watch-me"
OPERATE = {"authorization": f"Bearer {TOKEN}"}
WATCHING = {"authorization": f"Bearer {WATCH}"}
BASE = "http://127.0.0.1:8470"
OPEN = ConsoleSettings()
LOCKED = ConsoleSettings(token=TOKEN, watch_token=WATCH)


class HereWorker:
    """Does what a worker does in a thread of this process."""

    async def do(self, job: str, *arguments: Any) -> Any:
        line = json.dumps([job, *arguments]).encode()
        return json.loads(json.dumps(await asyncio.to_thread(work, line, jobs()), allow_nan=False))

    async def close(self) -> None:
        pass


class ConsoleBench(TestClient):
    """A client of the console; `door` is its other side. Enter it, so that all requests share one event loop.

    `now` is the clock by which rates are measured, in s: it stands still.
    """

    def __init__(self, settings: ConsoleSettings = OPEN, **client: Any) -> None:
        self.door, self.now = FakeDoor(), 0.0
        self.console = Console(settings, self.door, lambda: self.now, (HereWorker(), HereWorker()))
        super().__init__(self.console.app, **{"base_url": BASE, "client": ("127.0.0.1", 50000), **client})

    def page(self, headers: Any = None, query: str = "") -> Any:
        """The page's WebSocket."""
        return self.websocket_connect(f"{BASE.replace('http', 'ws')}/ws{query}", headers=headers or {})

    def command(self, do: str, **fields: Any) -> Any:
        """POST a command as an operator."""
        return self.post("/api/command", json={"do": do, **fields}, headers=OPERATE)


def in_folder(folder: Path, **more: Any) -> ConsoleSettings:
    """Settings whose moves and takes are in one folder."""
    return ConsoleSettings(moves=str(folder), takes=str(folder), **more)

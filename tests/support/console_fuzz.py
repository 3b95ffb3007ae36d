"""Requests and messages that no client of ours sends: known ones with some of it wrong, and noise."""

from __future__ import annotations

import asyncio
import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from random import Random
from typing import Any

from console_bench import LOCKED, TOKEN, WATCH
from fake_door import FakeDoor

from teleop.console.app import Console
from teleop.console.settings import ConsoleSettings

PATHS = """/ /login /ws /index.html /api /api/state /api/command /api/stop /api/login /api/moves /api/moves/reveal
 /api/moves/mine /api/plan /api/takes /api/takes/one /api/takes/one/keys /takes/one/report /takes/one/download
 /vendor/uplot/uPlot.iife.min.js /nope"""
METHODS = [*["GET", "POST", "POST", "PUT"] * 4, "HEAD", "DELETE", "OPTIONS", "PATCH", "TRACE", "get", "", "\u00e9"]
COMMANDS: list[Any] = [
    {"do": "goto", "axes": {"pan": 10}, "seconds": 2},
    {"do": "stick", "seq": 1, "time": 1.0, "axes": {"pan": 0.5}},
    {"do": "jog", "axis": "pan", "by": 1},
    {"do": "play", "move": "reveal", "wait": False},
    {"do": "plan", "content": {"keyframes": [{"at": 0, "pan": 0}]}},
    {"token": TOKEN},
    {"text": "keyframes: []"},
    {"content": {"include": [{"move": "../secret.yaml"}]}, "version": "x"},
    {"tolerance": 0.2, "save": "../x"},
]
VALUES: list[Any] = [
    None,
    True,
    -1,
    0,
    1e308,
    2**70,
    "",
    "../x",
    "\x00",
    "é" * 50,
    [],
    {},
    [[]],
    {"a": {"b": [1]}},
    "stick",
]
PIECES = ["..", "/", "//", "%2f", "%2e%2e", "\x00", "\\", "~", "é", "\ud800", "?", "#", "a" * 300, "C:", ".", " "]


@dataclass(frozen=True)
class FuzzRequest:
    """A request as ASGI has it; `role` is whose token it carries, "" for none."""

    method: str
    path: str
    headers: list[tuple[bytes, bytes]]
    body: list[bytes]
    role: str


def requests(random: Random, count: int) -> Iterator[FuzzRequest]:
    """Most of them near a good one."""
    for _ in range(count):
        role = random.choice(["", "", "watch", "operate"])
        path = random.choice(PATHS.split()) if random.random() < 0.7 else _path(random)
        body = _body(random)
        yield FuzzRequest(random.choice(METHODS), path, _headers(random, role, body), body, role)


def messages(random: Random, count: int) -> Iterator[str]:
    """Texts for a WebSocket, none of which is a STOP, and none too large."""
    for _ in range(count):
        text = b"".join(_body(random)).decode(errors="replace")
        yield text[:60_000].replace("stop", "stoq")


def _path(random: Random) -> str:
    path = random.choice(PATHS.split())
    for _ in range(random.randrange(1, 4)):
        at = random.randrange(len(path) + 1)
        path = path[:at] + random.choice(PIECES) + path[at:]
    return path


def _headers(random: Random, role: str, body: list[bytes]) -> list[tuple[bytes, bytes]]:
    headers = [(b"host", random.choice([b"127.0.0.1:8470"] * 6 + [b"", b"evil", b"127.0.0.1:8470,evil", b"\xff"]))]
    if role:
        headers.append((b"authorization", f"Bearer {TOKEN if role == 'operate' else WATCH}".encode()))
    choices: list[tuple[bytes, list[bytes]]] = [
        (b"origin", [b"http://127.0.0.1:8470", b"null", b"http://evil", b"\xff\x00", b""]),
        (b"sec-fetch-site", [b"same-origin", b"cross-site", b"\xff"]),
        (b"cookie", [b"teleop_8470=operate.99999999999.x.y", b"=;=;;", b"teleop_8470=" + b"x" * 5000, b"\xff\xfe"]),
        (b"authorization", [b"Bearer", b"Bearer \xff", b"Basic YTpi", b"bearer  x"]),
        (b"content-length", [b"-1", b"9" * 5000, b"x", str(sum(map(len, body))).encode(), "\u00b2".encode("latin-1")]),
        (b"if-none-match", [b"*", b'"x"']),
        (b"range", [b"bytes=0-", b"bytes=9-1,-", b"\xff"]),
    ]
    headers += [(name, random.choice(values)) for name, values in choices if random.random() < 0.2]
    random.shuffle(headers)
    return headers


def _body(random: Random) -> list[bytes]:
    kind = random.random()
    if kind < 0.1:
        return [random.randbytes(random.randrange(200))]
    if kind < 0.15:
        return [random.choice([b"[", b'{"a":', b"{", b"\xef\xbb\xbf{}", b"NaN"]) * random.randrange(1, 3000)]
    if kind < 0.155:
        return [b'{"do":"goto"' + b" " * 30_000] * 80
    command = dict(random.choice(COMMANDS))
    for _ in range(random.randrange(1, 3)):
        command[random.choice([*command, "id", "wait", "session", "do"])] = random.choice(VALUES)
    data = bytearray(json.dumps(command).encode())
    for _ in range(random.choice([0, 0, 1, 3])):
        data[random.randrange(len(data))] = random.randrange(256)
    return [bytes(data)]


class QuickWorker:
    """Answers at once that nothing can be planned or read."""

    async def do(self, job: str, *arguments: Any) -> Any:
        return {"error": f"no {job}", "ok": False, "kind": ""}

    async def close(self) -> None:
        pass


@dataclass
class FuzzedConsole:
    """A console that wants a login, on a fake door. Its clock runs on, so that no rate hides what is behind it."""

    folder: Path
    door: FakeDoor = field(default_factory=FakeDoor)
    now: float = 0.0
    statuses: dict[int, int] = field(default_factory=dict)
    random: Random = field(default_factory=lambda: Random(3))

    def __post_init__(self) -> None:
        self.door.action_seconds = 0.0
        place = str(self.folder)
        settings = ConsoleSettings(token=LOCKED.token, watch_token=LOCKED.watch_token, moves=place, takes=place)
        self.console = Console(settings, self.door, self._clock, (QuickWorker(), QuickWorker()))

    def _clock(self) -> float:
        self.now += 1.0
        return self.now

    async def ask(self, request: FuzzRequest) -> int:
        """The status of the answer; raises what the console raises."""
        parts = list(request.body)
        is_cut = self.random.random() < 0.02
        statuses: list[int] = []

        async def receive() -> dict[str, Any]:
            if not parts:
                return {"type": "http.disconnect"}
            return {"type": "http.request", "body": parts.pop(0), "more_body": bool(parts) or is_cut}

        async def send(message: Any) -> None:
            if message["type"] == "http.response.start":
                statuses.append(message["status"])

        scope = {
            "type": "http",
            "asgi": {"version": "3.0"},
            "http_version": "1.1",
            "method": request.method,
            "scheme": "http",
            "path": request.path,
            "raw_path": b"",
            "query_string": b"",
            "root_path": "",
            "headers": request.headers,
            "client": ("127.0.0.1", 1),
            "server": ("127.0.0.1", 8470),
        }
        await self.console.app(scope, receive, send)
        (status,) = statuses
        self.statuses[status] = self.statuses.get(status, 0) + 1
        return status

    async def converse(self, texts: list[str], token: str) -> tuple[list[dict[str, Any]], int | None]:
        """What a WebSocket answers to these messages, and the code if it ended the connection."""
        sent: list[dict[str, Any]] = []
        codes: list[int] = []
        incoming: asyncio.Queue[dict[str, Any]] = asyncio.Queue()
        incoming.put_nowait({"type": "websocket.connect"})
        for text in texts:
            incoming.put_nowait({"type": "websocket.receive", "text": text})
        incoming.put_nowait({"type": "websocket.receive", "text": '{"do": "ping", "id": "end"}'})

        async def send(message: Any) -> None:
            if message["type"] == "websocket.send":
                sent.append(json.loads(message["text"]))
                if sent[-1].get("id") == "end":
                    incoming.put_nowait({"type": "websocket.disconnect", "code": 1000})
            elif message["type"] == "websocket.close":
                codes.append(message["code"])

        scope = {
            "type": "websocket",
            "asgi": {"version": "3.0"},
            "http_version": "1.1",
            "scheme": "ws",
            "path": "/ws",
            "raw_path": b"/ws",
            "query_string": b"",
            "root_path": "",
            "headers": [(b"host", b"127.0.0.1:8470"), (b"authorization", f"Bearer {token}".encode())],
            "client": ("127.0.0.1", 1),
            "server": ("127.0.0.1", 8470),
            "subprotocols": [],
        }
        await self.console.app(scope, incoming.get, send)
        return sent, codes[0] if codes else None


async def fuzz_http(random: Random, folder: Path, count: int) -> Mapping[int, int]:
    """How many answers of each status `count` requests get. Raises AssertionError for what must not be."""
    console = FuzzedConsole(folder)
    for request in requests(random, count):
        before = len(console.door.commands), dict(console.door.positions)
        status = await console.ask(request)
        assert status < 500 or status == 503, (status, request)
        is_stop = request.path == "/api/stop"
        if request.role != "operate":
            new = [command["do"] for command, _, _ in console.door.commands[before[0] :]]
            assert new == ["stop"] * (is_stop and status == 200), request
            assert console.door.positions == before[1], request
            assert not console.door.sticks, request
        console.door.sticks.clear()
        console.door.commands.clear()
    return console.statuses


async def fuzz_websocket(random: Random, folder: Path, count: int, share: int = 500) -> Mapping[str, int]:
    """How many answers of each kind `count` messages get, `share` in a connection, half of them as a watcher."""
    console = FuzzedConsole(folder)
    kinds: dict[str, int] = {}
    for number in range(count // share):
        token = WATCH if number % 2 else TOKEN
        before = dict(console.door.positions)
        sent, code = await console.converse(list(messages(random, share)), token)
        ended = "ended" if code is not None else "answered"
        kinds[ended] = kinds.get(ended, 0) + 1
        for message in sent:
            kind = str(message.get("kind", message["type"]))
            kinds[kind] = kinds.get(kind, 0) + 1
        if token == WATCH:
            assert console.door.positions == before
            assert console.door.commands == console.door.sticks == []
        console.door.commands.clear()
        console.door.sticks.clear()
    return kinds

"""The console as an ASGI application: its routes, behind the gate."""

from __future__ import annotations

import secrets
import time
from collections.abc import Callable, Sequence
from pathlib import Path

from starlette.applications import Starlette
from starlette.exceptions import HTTPException
from starlette.requests import Request
from starlette.responses import Response
from starlette.routing import BaseRoute, Match, Route, WebSocketRoute
from starlette.types import Scope
from starlette.websockets import WebSocket

from teleop.console.answers import answer, fault, http_error, refused
from teleop.console.commands import CommandRoutes
from teleop.console.door import Door
from teleop.console.fleet import FleetRoutes
from teleop.console.gate import Gate, client_address
from teleop.console.json_body import Refusal, read_object
from teleop.console.login import Logins
from teleop.console.moves import MoveRoutes
from teleop.console.openapi import description
from teleop.console.results import ResultRoutes
from teleop.console.sessions import HttpSessions
from teleop.console.settings import ConsoleSettings
from teleop.console.static_files import login_page, static_files
from teleop.console.takes import TakeRoutes
from teleop.console.websocket import Client
from teleop.console.worker import Worker, WorkerProcess

MOST_CLIENTS = 32  # WebSockets at once
LONGEST_NAME = 40  # characters of what a client calls itself


class Console:
    """Everything that one server has: `app` is the ASGI application."""

    def __init__(
        self,
        settings: ConsoleSettings,
        door: Door,
        clock: Callable[[], float] = time.monotonic,
        workers: tuple[Worker, Worker] | None = None,
    ) -> None:
        self._settings, self._door, self._clock = settings, door, clock
        self._workers = workers or (WorkerProcess(), WorkerProcess())  # a plan does not wait for a take's report
        self._moves = MoveRoutes(Path(settings.moves), settings.rig, self._workers[0])
        self._logins = Logins(settings)
        self._sessions = HttpSessions(door)
        self._fleet = FleetRoutes(settings.fleet_section)
        self._clients = 0
        self._routes = self._all_routes()
        starlette = Starlette(
            routes=self._routes,
            exception_handlers={Refusal: refused, HTTPException: http_error, Exception: fault},
        )
        starlette.router.redirect_slashes = False
        self.gate = self.app = Gate(starlette, settings, self._logins, self._knows, clock)

    def _all_routes(self) -> Sequence[BaseRoute]:
        commands = CommandRoutes(self._door, self._sessions, self._moves.planned)
        takes = TakeRoutes(Path(self._settings.takes), self._moves, self._workers[1])
        results = ResultRoutes(self._settings.results)
        return [
            Route("/api", self._describe, methods=["GET"]),
            Route("/api/state", commands.state, methods=["GET"]),
            Route("/api/command", commands.command, methods=["POST"]),
            Route("/api/stop", commands.stop, methods=["POST"]),
            Route("/api/fleet", self._fleet.rigs, methods=["GET"]),
            Route("/api/fleet/stop", self._fleet.stop, methods=["POST"]),
            Route("/api/login", self._login, methods=["POST"]),
            Route("/api/moves", self._moves.list, methods=["GET"]),
            Route("/api/moves/{name}", self._moves.read, methods=["GET"]),
            Route("/api/moves/{name}", self._moves.save, methods=["PUT"]),
            Route("/api/plan", self._moves.plan, methods=["POST"]),
            Route("/api/takes", takes.list, methods=["GET"]),
            Route("/api/takes/{name}", takes.read, methods=["GET"]),
            Route("/api/takes/{name}/keys", takes.keys, methods=["POST"]),
            Route("/takes/{name}/report", takes.page, methods=["GET"]),
            Route("/takes/{name}/download", takes.download, methods=["GET"]),
            Route("/commission/{name}", results.download, methods=["GET"]),
            WebSocketRoute("/ws", self._websocket),
            Route("/login", self._login_page, methods=["GET"]),
            *(Route(path, self._file, methods=["GET"]) for path in ("/", *static_files()) if path != "/index.html"),
        ]

    async def start(self) -> None:
        """Have the planner ready before somebody drags a key: the first plan takes far longer than the next."""
        await self._moves.warm()

    async def close(self) -> None:
        """End the workers, and leave the fleet."""
        await self._fleet.close()
        for worker in self._workers:
            await worker.close()

    def _knows(self, scope: Scope) -> bool:
        """Whether there is anything at the path of a request."""
        return any(route.matches(scope)[0] is not Match.NONE for route in self._routes)

    async def _describe(self, _: Request) -> Response:
        return answer(description())

    async def _login(self, request: Request) -> Response:
        """A token for a cookie."""
        data = await read_object(request, 2000)
        token = data.get("token")
        if self._logins.is_open:
            return answer({"ok": True, "role": "operate"})
        if not isinstance(token, str):
            raise Refusal(400, 'token: send {"token": "..."}')
        role = self.gate.role_of_token(token, client_address(request.scope))
        return answer({"ok": True, "role": role}, headers={"set-cookie": self._logins.cookie(role)})

    async def _login_page(self, request: Request) -> Response:
        file, policy = login_page()
        return file.answer(request, {"content-security-policy": policy})

    async def _file(self, request: Request) -> Response:
        if request.url.path == "/" and request.scope["state"]["role"] is None:
            return await self._login_page(request)
        path = request.scope["path"]
        return static_files()["/index.html" if path == "/" else path].answer(request)

    async def _websocket(self, websocket: WebSocket) -> None:
        if self._clients >= MOST_CLIENTS:
            await websocket.send_denial_response(answer({"error": f"at most {MOST_CLIENTS} pages at once"}, 503))
            return
        self._clients += 1
        role = websocket.scope["state"]["role"]
        client = Client(
            websocket, self._door, secrets.token_hex(4), client_name(websocket), role, self._moves, self._clock
        )
        try:
            await client.run()
        finally:
            self._clients -= 1


def client_name(websocket: WebSocket) -> str:
    """What screens call a client: the name that it gives itself, else its kind and address."""
    given = "".join(letter for letter in websocket.query_params.get("name", "") if letter.isprintable()).strip()
    if given:
        return given[:LONGEST_NAME]
    kind = "phone" if "Mobile" in websocket.headers.get("user-agent", "") else "console"
    return f"{kind} {client_address(websocket.scope)}"

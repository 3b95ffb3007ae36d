"""What every request passes before a handler sees it, and every answer on its way out.

In this order: Host and Origin, the login, the rate of the client. Outwards the security headers. It is plain ASGI, so
that pages, data and WebSockets pass the same code.

Who is logged in has a rate of their own, and a right token or cookie always counts: what others at the same address
get wrong, or too often, keeps nobody from the rig. So a guess is always looked at; what bounds guessing is the length
of the token, and that each wrong one costs a request, and a connection once there were many.
"""

from __future__ import annotations

import time
from collections.abc import Awaitable, Callable
from typing import Any

from starlette.datastructures import Headers, MutableHeaders
from starlette.requests import cookie_parser
from starlette.types import ASGIApp, Message, Receive, Scope, Send
from starlette.websockets import WebSocket

from teleop.console.answers import answer
from teleop.console.json_body import Refusal
from teleop.console.login import Logins
from teleop.console.origin import OriginRules
from teleop.console.rate_limit import RateLimit
from teleop.console.settings import ConsoleSettings, Role

REQUEST_RATE, REQUEST_BURST = 200.0, 400.0  # requests/s and at once, of one client; neither STOP nor a login counts
WRONG_RATE, WRONG_BURST = 0.1, 10.0  # wrong tokens/s and at once, of one client
MAPPED = "::ffff:"  # an IPv4 address at a socket that takes both kinds
UNCOUNTED = ("/api/stop", "/api/login")
PUBLIC = {("GET", "/"), ("HEAD", "/"), ("GET", "/login"), ("HEAD", "/login"), ("POST", "/api/login")}
"""What is answered without a login: the login page. `/` is that page then."""

POLICY = (
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data:; connect-src 'self';"
    " manifest-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
)
HEADERS = {
    "content-security-policy": POLICY,
    "x-content-type-options": "nosniff",
    "x-frame-options": "DENY",
    "referrer-policy": "no-referrer",
    "cross-origin-opener-policy": "same-origin",
    "cross-origin-resource-policy": "same-origin",
    "permissions-policy": "camera=(), microphone=(), geolocation=(), usb=(), serial=()",
}


class Gate:
    """`app` behind the checks. A handler finds the client's role in `scope["state"]["role"]`, None without a login.

    `knows` says whether there is anything at a path.
    """

    def __init__(
        self,
        app: ASGIApp,
        settings: ConsoleSettings,
        logins: Logins,
        knows: Callable[[Scope], bool],
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self._app, self._logins, self._knows = app, logins, knows
        self._origins = OriginRules(settings)
        self._known, self._strangers = (RateLimit(REQUEST_RATE, REQUEST_BURST, clock) for _ in range(2))
        self._wrong = RateLimit(WRONG_RATE, WRONG_BURST, clock)

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] not in ("http", "websocket"):
            await self._app(scope, receive, send)
            return
        try:
            scope.setdefault("state", {})["role"] = self._admitted(scope)
        except Refusal as refusal:
            await _refuse(refusal, scope, receive, send)
            return
        await self._app(scope, receive, _with_headers(send) if scope["type"] == "http" else send)

    def _admitted(self, scope: Scope) -> Role | None:
        """The role of the client. Raises Refusal."""
        headers, address = Headers(scope=scope), client_address(scope)
        method, path = scope.get("method", "GET"), scope["path"]
        is_page = scope["type"] == "http" and method in ("GET", "HEAD") and not path.startswith("/api")
        local = str((scope.get("server") or ("", None))[0]).removeprefix(MAPPED)
        if problem := self._origins.refusal(headers, local, is_page):
            raise Refusal(403, problem)
        role = self._role(headers, address)
        requests = self._known if role else self._strangers
        if path not in UNCOUNTED and not requests.take(address):
            raise Refusal(429, "too many requests", {"retry-after": "1"})
        if role is None and (method, path) not in PUBLIC and self._knows(scope):
            raise Refusal(401, "log in first, or send the header `Authorization: Bearer TOKEN`")
        return role

    def _role(self, headers: Headers, address: str) -> Role | None:
        if self._logins.is_open:
            return "operate"
        kind, _, token = headers.get("authorization", "").partition(" ")
        if kind.lower() == "bearer":
            return self.role_of_token(token.strip(), address)
        cookies = cookie_parser(headers.get("cookie", ""))
        return self._logins.role_of_cookie(cookies.get(self._logins.cookie_name, ""))

    def role_of_token(self, token: str, address: str) -> Role:
        """The role of a token that a client sent. Raises Refusal: 401 for a wrong one, 429 after many of them."""
        role = self._logins.role_of_token(token)
        if role is not None:
            return role
        if self._wrong.take(address):
            raise Refusal(401, "wrong token")
        raise Refusal(429, "wrong token, and too many of them: wait 10 s", {"retry-after": "10", "connection": "close"})


def client_address(scope: Scope) -> str:
    """The address of the client's computer."""
    return str((scope.get("client") or ("unknown", 0))[0]).removeprefix(MAPPED)


async def _refuse(refusal: Refusal, scope: Scope, receive: Receive, send: Send) -> None:
    response = answer(refusal.content, refusal.status, refusal.headers)
    if scope["type"] == "websocket":
        await WebSocket(scope, receive, send).send_denial_response(response)
    else:
        await response(scope, receive, _with_headers(send))


def _with_headers(send: Send) -> Callable[[Message], Awaitable[Any]]:
    async def with_headers(message: Message) -> None:
        if message["type"] == "http.response.start":
            headers = MutableHeaders(scope=message)
            for name, value in HEADERS.items():
                headers.setdefault(name, value)
        await send(message)

    return with_headers

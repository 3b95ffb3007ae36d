"""HTTP for buttons and scripts: the state, one command, STOP."""

from __future__ import annotations

from collections.abc import Awaitable, Callable, Mapping
from typing import Any

from starlette.requests import Request
from starlette.responses import Response

from teleop.console.answers import answer
from teleop.console.door import KINDS, Door
from teleop.console.json_body import Refusal, read_object
from teleop.console.sessions import HttpSession, HttpSessions
from teleop.console.stopping import stop
from teleop.door.messages import INTERNAL

Plan = Callable[[Mapping[str, Any]], Awaitable[Mapping[str, Any]]]
WATCHERS = "this login only watches: log in with the token to operate"


class CommandRoutes:
    """Handlers of `/api/state`, `/api/command` and `/api/stop`. `plan` answers the command of that name."""

    def __init__(self, door: Door, sessions: HttpSessions, plan: Plan) -> None:
        self._door, self._sessions, self._plan = door, sessions, plan

    async def state(self, request: Request) -> Response:
        """The newest state; a client that asks for it regularly is present."""
        self._sessions.of(request)
        if state := self._door.state():
            return answer(state)
        raise Refusal(503, "no state yet: the rig is starting")

    async def command(self, request: Request) -> Response:
        """Give one command: answered once it is accepted, with `wait` once it is done."""
        require_operator(request)
        session = self._sessions.of(request)
        command = await read_object(request)
        wait = command.pop("wait", False)
        if not isinstance(wait, bool):
            raise Refusal(400, "wait: must be true or false")
        check_command(command)
        if command["do"] == "stick":
            pass_stick(self._door, command, session.session)
            return answer({"ok": True})
        if command["do"] == "stop":
            return answer_of(await stop(self._door, session.session, session.name))
        if command["do"] == "plan":
            return answer(await self._plan(command))
        return answer_of(await self._sessions.waiting(request, session, self._commanded(command, session, wait)))

    async def _commanded(self, command: Mapping[str, Any], session: HttpSession, wait: bool) -> Mapping[str, Any]:
        accepted = await self._door.command(command, session.session, session.name, brief=True)
        if wait and accepted.get("ok") and "id" in accepted:
            return await self._door.finished(accepted["id"])
        return accepted

    async def stop(self, request: Request) -> Response:
        """STOP, by everybody who is logged in; what is in the body does not matter and is not read."""
        session = self._sessions.of(request)
        return answer_of(await stop(self._door, session.session, session.name))


def require_operator(request: Request) -> None:
    """Raises Refusal (403) for those who only watch."""
    if request.scope["state"]["role"] != "operate":
        raise Refusal(403, WATCHERS)


def pass_stick(door: Door, message: Mapping[str, Any], session: str) -> None:
    """A stick's message to the door. Raises Refusal (400) for a malformed one."""
    try:
        door.stick(message, session)
    except ValueError as error:
        raise Refusal(400, str(error)) from None


def check_command(command: Mapping[str, Any]) -> None:
    """Raises Refusal (400) for a message without a command, or with one of the gateway's own; the door checks the rest.

    `alive` says that others are there: a client that could send it would hold up the dead man of others.
    """
    if command.get("do") in INTERNAL:
        raise Refusal(400, f"do: unknown command {command['do']!r}")
    if not isinstance(command.get("do"), str):
        raise Refusal(400, 'do: name a command, as in {"do": "goto", "axes": {"pan": 10}, "seconds": 2}')


def answer_of(found: Mapping[str, Any]) -> Response:
    """An answer of the door as one of HTTP."""
    if "error" not in found:
        return answer({key: value for key, value in found.items() if key != "id"} | {"ok": True})
    content = {key: value for key, value in found.items() if key not in ("ok", "id")}
    return answer(content, KINDS.get(str(found.get("kind")), 422))

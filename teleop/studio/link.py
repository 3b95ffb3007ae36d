"""One endpoint of an operator: a client session that is opened as soon as the other side is there, and kept.

Zenoh itself connects again after a cut. Until the first time it has to be tried; a thread does that.
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from time import monotonic
from typing import TYPE_CHECKING, Any, Protocol

from teleop.core.errors import TeleopError
from teleop.studio import wire
from teleop.studio.diagnosis import why_not
from teleop.studio.transport import Reader, opened, require, ring

if TYPE_CHECKING:
    import zenoh

    from teleop.studio.credentials import Credentials

AGAIN = 0.3  # s between two tries
REPEATED = ("command/stop", "command/clock")  # rather lost than late; others are asked once
HISTORY, TRIES = 1.0, 3  # s for the rigs that are there already, and how often they are asked for


class Heard(Protocol):
    """Told what a link hears, in Zenoh's threads."""

    def heard_state(self, link: Link, rig: str, state: dict[str, Any], arrived: float) -> None: ...

    def heard_alive(self, link: Link, rig: str, alive: bool) -> None: ...


class Link:
    """`ready` is set once the rigs behind the endpoint are known, `tried` once it was tried; `heard` is whether a rig
    was heard there."""

    def __init__(self, endpoint: str, credentials: Credentials | None, heard: Heard) -> None:
        self.endpoint, self._credentials, self._heard = endpoint, credentials, heard
        self.member = "" if credentials is None else credentials.name
        self.heard = False
        self._problem = ""
        self.tried, self.ready = threading.Event(), threading.Event()
        self._over = threading.Event()
        self._session: zenoh.Session | None = None
        self._readers: list[Reader] = []
        self._tokens: dict[str, zenoh.LivelinessToken] = {}
        self._thread = threading.Thread(target=self._run, name=f"zenoh {endpoint}", daemon=True)

    @property
    def problem(self) -> str:
        """Why there is no rig, "" where there was one."""
        if self._problem or self.heard or not self.ready.is_set():
            return self._problem
        missing = f"{self.endpoint}: answers, but shows no rig"
        return f"{missing}: is {self.member} in its access.yaml?" if self.member else missing

    def start(self) -> None:
        self._thread.start()

    def close(self) -> None:
        """Close the session: without it the process does not end."""
        self._over.set()
        self._thread.join()
        session, self._session = self._session, None
        for reader in self._readers:
            reader.close()
        if session is not None:
            session.close()

    def _run(self) -> None:
        while not self._over.is_set():
            try:
                session = opened("client", connect=[self.endpoint], credentials=self._credentials)
            except TeleopError as error:
                why = why_not(self.endpoint, self._credentials)
                self._problem = f"{self.endpoint}: {why}" if why else str(error)
                self.tried.set()
                self._over.wait(AGAIN)
                continue
            self._problem, self._session = "", session
            self._subscribe(session)
            self.tried.set()
            self.ready.set()
            return

    def _subscribe(self, session: zenoh.Session) -> None:
        put = require().SampleKind.PUT

        def on_state(sample: zenoh.Sample) -> None:
            arrived = monotonic()
            try:
                state = wire.decoded(bytes(sample.payload), wire.LARGEST_STATE)
            except ValueError:
                return
            self._heard.heard_state(self, wire.rig_of(str(sample.key_expr)), state, arrived)
            self.heard = True

        def on_alive(sample: zenoh.Sample) -> None:
            self._heard.heard_alive(self, wire.rig_of(str(sample.key_expr)), sample.kind == put)
            self.heard = self.heard or sample.kind == put

        live = session.liveliness()
        self._readers.append(Reader(session.declare_subscriber(wire.STATES, ring()), on_state))
        self._readers.append(Reader(live.declare_subscriber(wire.ALIVES, ring(), history=True), on_alive))
        for _ in range(TRIES):  # a router tells them a moment later
            known = [reply.ok for reply in live.get(wire.ALIVES, timeout=HISTORY) if reply.ok is not None]
            for sample in known:
                self._heard.heard_alive(self, wire.rig_of(str(sample.key_expr)), True)
                self.heard = True
            if known or self._over.wait(AGAIN):
                return

    # --- to a rig

    def ask(self, rig: str, what: str, message: dict[str, Any], timeout: float) -> dict[str, Any]:
        """The answer to a command; `kind` is "lost" where none came within `timeout` s."""
        session = self._session
        if session is None:
            return {"error": self.problem or "not connected", "kind": "lost"}
        package = require()
        replies = session.get(
            wire.key(rig, what),
            payload=wire.encoded(message),
            timeout=timeout,
            consolidation=package.ConsolidationMode.NONE,  # the first answer counts, at once
            congestion_control=package.CongestionControl.DROP if what in REPEATED else package.CongestionControl.BLOCK,
            priority=package.Priority.INTERACTIVE_HIGH,
            express=True,
        )
        for reply in replies:
            if reply.ok is None:
                continue
            try:
                return wire.decoded(bytes(reply.ok.payload), wire.LARGEST_STATE)
            except ValueError as error:
                return {"error": f"its answer {error}", "kind": "lost"}
        return {"error": f"{rig} does not answer", "kind": "lost"}

    def stick(self, rig: str) -> Callable[[dict[str, Any]], None]:
        """What puts a message of a stick: dropped rather than late."""
        session = self._session
        if session is None:
            raise TeleopError(self.problem or "not connected")
        package = require()
        publisher = session.declare_publisher(
            wire.key(rig, "stick"),
            congestion_control=package.CongestionControl.DROP,
            priority=package.Priority.REAL_TIME,
            express=True,
        )
        return lambda message: publisher.put(wire.encoded(message))

    def present(self, rig: str, session: str) -> None:
        """Have the rig know, by a token, that this operator is there: when it is gone, so is its control."""
        if self._session is not None and rig not in self._tokens:
            self._tokens[rig] = self._session.liveliness().declare_token(wire.key(rig, f"alive/{session}"))

    def absent(self, rig: str) -> None:
        if (token := self._tokens.pop(rig, None)) is not None:
            token.undeclare()

"""The door of a commissioning: everybody sees its page and may stop it, the one who has control presses its keys.

The terminal outranks them all. A key of a client names the page that it answers: one for a page that is over is
refused, and each page takes one key. Whoever pressed last has to stay there while a step moves: a page that is silent,
hidden or gone stops it, and so does control that passes on.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from contextlib import ExitStack

from teleop.commission.page import GO, RUBOUT, STOP, Stage
from teleop.commission.runner import Runner
from teleop.core.interfaces import Clock
from teleop.core.operator_input import Command
from teleop.devices.connection import Connection
from teleop.remote.asked import Asked, Refusal
from teleop.remote.commission_shown import CommissionShown
from teleop.remote.commission_state import CommissionState
from teleop.remote.desk import Desk
from teleop.remote.gateway_child import Gateway
from teleop.remote.open_door import OpenDoor
from teleop.remote.state import Parts
from teleop.remote.stick import RemoteStick

SILENT = 1.0  # s without a word of the page that let a step move, after which it is stopped
REPEATED = 0.5  # s in which a STOP that comes again is the same one: it was the answer to a question
LEFT = 60.0  # s without a client, after which the last page is closed
STALE = "stale"


class CommissionHands:
    """`rig` is its name, `connection` the device's link as it is now. `gateway` is None for no gateway."""

    def __init__(
        self, runner: Runner, rig: str, device: str, connection: Callable[[], Connection], gateway: Gateway | None
    ) -> None:
        self._runner, self._rig, self._device = runner, rig, device
        self._connection, self._gateway = connection, gateway
        self.state = CommissionState(runner, device)
        self._shown = CommissionShown()
        self._keys: list[str] = []
        self._mover = ""  # the session that pressed last, "" for the terminal
        self._under_way: list[Asked] = []
        self._answered = "", -math.inf  # whose STOP was an answer, and when
        self._ended = False  # a client has closed the last page
        self._finished = math.inf

    def open(self, stack: ExitStack, clock: Clock) -> None:
        """Open the door, and have the gateway run, until the stack is left."""
        self.door = OpenDoor(stack)
        self.desk = Desk(self.door.socket, RemoteStick((), float), self.line, self, SILENT)
        self._links: dict[str, Connection] = {}
        parts = Parts(self._rig, {}, self._shown, self._links, self.desk, False, self.state.state)
        self._publisher = self.door.publisher(parts, clock)
        if self._gateway is not None:
            self.door.start(stack, self._gateway, self.desk, clock, self.line)

    def line(self, text: str) -> None:
        self._shown.line(text)

    @property
    def pressed_last(self) -> bool:
        """Whether the last key came from a client."""
        return bool(self._mover)

    # --- each turn, in the control thread

    def keys(self, now: float, local: Sequence[str]) -> Sequence[str]:
        """What is pressed in this turn: by the terminal, else by a client; a client's STOP before all else."""
        self.state.look()
        self._shown.now, self._keys = now, []
        if local:
            self._pressed("")
        self.door.look(self.desk, now)
        stopped = False
        for press in self.desk.read(now).presses:
            if press.command is Command.STOP:
                stopped = True
                self._stop(press.by, now)
            elif press.command is Command.CLEAR:
                self._shown.stopped_by = ""
        keys = [*local, *self._keys]
        if stopped:
            keys = [key for key in keys if key == STOP]
        return keys

    def show(self, now: float) -> None:
        """After the turn: what came of it."""
        if self.rests:
            under_way, self._under_way = self._under_way, []
            for asked in under_way:
                asked.end()
        self._links[self._device] = self._connection()
        self._publisher.publish("over" if self._runner.over else "running", now)
        self.desk.flush()

    def finish(self, now: float, files: Sequence[str], lines: Sequence[str] = ()) -> None:
        """It is over, and `files` are what it leaves: shown until that page is closed."""
        self._finished = now
        self.state.files, self.state.ending = files, lines

    def is_closed(self, now: float) -> bool:
        """Whether nobody looks at the last page any more."""
        return self._ended or now - max(self.desk.seen_last, self._finished) > LEFT

    def _pressed(self, session: str) -> None:
        self._mover = session
        self._shown.stopped_by = ""
        self.state.turn_over()

    def _stop(self, name: str, now: float) -> None:
        if self._answered[0] == name and now - self._answered[1] < REPEATED:
            return
        self._shown.stopped_by = name
        self.state.turn_over()
        if self._runner.asks_for_stop:
            self._answered = name, now
            self._keys = [STOP]
        else:
            self._runner.stop(f"STOPPED by {name}")

    # --- what the desk asks

    @property
    def rests(self) -> bool:
        return not self._runner.moves and self._runner.stage is not Stage.RELEASING

    def busy(self, session: str) -> bool:
        return not self.rests and self._mover == session

    def passing(self, now: float) -> None:  # noqa: ARG002
        if self._mover:
            self._runner.stop("stopped: control passes to another one")

    def gone(self, sessions: Callable[[str], bool], now: float) -> None:  # noqa: ARG002
        """Who pressed last has to be there, and to have control, while something moves."""
        control = self.desk.control
        if not self._mover or not self._runner.moves:
            return
        if sessions(self._mover):
            self._runner.stop("stopped: the page that pressed Enter is gone")
        elif not control.holds(self._mover) or control.leaving:
            self._runner.stop("stopped: control was given up")

    def do(self, asked: Asked, now: float) -> None:  # noqa: ARG002
        if asked.command.do != "commission_key":
            raise Refusal(f"{asked.command.do}: not while the rig is commissioned")
        state, key, page = self.state, asked["key"], self._runner.page
        if asked["page"] != state.number or self._keys:
            raise Refusal("the page has changed since: look at the new one", STALE)
        if self._runner.over:
            self._ended = True
        elif page.typed is not None:
            self._keys = self._typed(asked, len(page.typed))
        else:
            if key not in page.keys or key == STOP:
                raise Refusal(f"{key}: no key of this page")
            if page.stage is Stage.PROMPT and key == GO and page.consent and not asked.get("agrees"):
                raise Refusal(f"agree to it first: {page.consent}")
            self._keys = [key]
        self._pressed(asked.command.session)
        asked.accept()
        self._under_way.append(asked)

    def _typed(self, asked: Asked, before: int) -> list[str]:
        """The keys of a word that is typed anew, for a page that asks for one."""
        if asked["key"] != GO or not asked.get("text", "").strip():
            raise Refusal("type the word that the page asks for")
        return [*[RUBOUT] * before, *asked["text"], GO]

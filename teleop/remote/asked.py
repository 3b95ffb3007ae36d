"""A command that is under way: who asked for it, and how it is answered."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any, Protocol

from teleop.door.messages import DoorCommand
from teleop.remote.control import Person


class Answers(Protocol):
    """Where answers go: the desk."""

    def answer(self, asked: Asked, message: Mapping[str, Any]) -> None: ...

    def action_over(self, asked: Asked) -> None: ...


class Refusal(Exception):  # noqa: N818 - no error of the program: an answer
    """Why a command is not done. `kind` is "busy", "refused" or "invalid"; `holder` has control."""

    def __init__(self, reason: str, kind: str = "refused", holder: str = "") -> None:
        super().__init__(reason)
        self.kind, self.holder = kind, holder


@dataclass(eq=False)
class Asked:
    """A command under way, and how to answer it. `over` is whether all has been said."""

    command: DoorCommand
    address: str
    desk: Answers
    accepted: bool = False
    over: bool = False

    @property
    def person(self) -> Person:
        return Person(self.command.session, self.command.name)

    def __getitem__(self, key: str) -> Any:
        return self.command.fields[key]

    def get(self, key: str, default: Any = None) -> Any:
        return self.command.fields.get(key, default)

    def accept(self, **facts: float) -> None:
        """It will be done; `facts` are what else the answer has."""
        if not self.accepted and not self.over:
            self.accepted = True
            self.desk.answer(self, {"ok": True, **facts})

    def planning(self) -> None:
        """It cannot be told yet whether it is accepted."""
        self.desk.answer(self, {"planning": True})

    def refuse(self, refusal: Refusal) -> None:
        if self.accepted:
            self.end(str(refusal))
        elif not self.over:
            self.over = True
            holder = {"holder": refusal.holder} if refusal.holder else {}
            self.desk.answer(self, {"error": str(refusal), "kind": refusal.kind, **holder})
            self.desk.action_over(self)

    def end(self, why: str = "") -> None:
        """What was accepted is over: done, or `why` it ended before."""
        if not self.accepted:
            self.refuse(Refusal(why)) if why else self.accept()
        if self.over:
            return
        self.over = True
        self.desk.answer(self, {"done": True, **({"error": why, "kind": "refused"} if why else {"ok": True})})
        self.desk.action_over(self)


class Actions(Protocol):
    """What the commands do in this kind of run."""

    @property
    def rests(self) -> bool: ...

    def busy(self, session: str) -> bool:
        """Whether something goes on that this session has begun."""
        ...

    def do(self, asked: Asked, now: float) -> None:
        """Accept, end or refuse what is asked; may raise Refusal. Not for control, STOP, clear and sticks."""
        ...

    def passing(self, now: float) -> None:
        """Control goes to another one: what moves ends or pauses."""
        ...

    def gone(self, sessions: Callable[[str], bool], now: float) -> None:
        """Called each tick; `sessions` says whether a session's client is gone."""
        ...


@dataclass
class Counts:
    """What has come by the door. `lost` are answers that no client took."""

    taken: int = 0
    refused: int = 0
    malformed: int = 0
    faults: int = 0
    kinds: Counter[str] = field(default_factory=Counter)

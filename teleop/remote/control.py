"""Who has control of a rig over the network: one at a time, with a lease.

Everybody watches and everybody's STOP counts; only the holder moves anything. Another one may ask: after ASK_TIME
without a no it passes. Whenever control passes or ends, the axes first come to rest, for at most HANDOVER. The
operator's own inputs outrank every holder and need no control.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

ASK_TIME = 5.0  # s that the holder has to say no
IDLE = 60.0  # s after which a holder that does nothing has control no longer
HANDOVER = 1.0  # s at most until the axes rest and control is free, or the next one's


class Person(NamedTuple):
    """A client: its session, and the name that others see."""

    session: str
    name: str


class Denied(Exception):  # noqa: N818 - no error of the program: another one has control
    """Why control is not given; `holder` is who has it."""

    def __init__(self, reason: str, holder: str) -> None:
        super().__init__(reason)
        self.holder = holder


class Control:
    """`notify` takes lines for everybody. Times are the loop's clock, in s; call `step` each tick.

    `holder` has control. `leaving` is whether it ends as soon as the axes rest: until then nobody else may take it.
    """

    def __init__(self, notify: Callable[[str], object]) -> None:
        self._notify = notify
        self.holder: Person | None = None
        self.asking: Person | None = None
        self.leaving = False
        self.brief = False  # for one action alone
        self.changes = 0  # how often another one got control, or the same one anew
        self._next: Person | None = None  # gets it once the axes rest
        self._asked = self._used = self._end = math.inf

    def holds(self, session: str) -> bool:
        return self.holder is not None and self.holder.session == session and self._next is None

    @property
    def name(self) -> str:
        return "" if self.holder is None else self.holder.name

    def take(self, person: Person, now: float, ask: bool = False, brief: bool = False) -> bool:
        """Whether the control is the person's; False for one that has asked. Raises Denied."""
        if self.holder is None or (self.holder.session == person.session and self._next is None):
            if self.holder is None and not brief:
                self._notify(f"{person.name} has control")
            self._give(person, now, brief and (self.holder is None or self.brief))
            return True
        if not ask:
            raise Denied(f"{self.name} has control", self.name)
        if self._next is not None or (self.asking is not None and self.asking.session != person.session):
            raise Denied("another one is asking for control already", self.name)
        if self.asking is None:
            self.asking, self._asked = person, now
            self._notify(f"{person.name} asks {self.name} for control")
        return False

    def deny(self) -> Person | None:
        """The holder says no; who had asked."""
        asking, self.asking, self._asked = self.asking, None, math.inf
        if asking is not None:
            self._notify(f"{self.name} keeps control: no to {asking.name}")
        return asking

    def use(self, now: float) -> None:
        """The holder has done something."""
        self._used = now

    def release(self, session: str, now: float, within: float = math.inf) -> None:
        """The holder needs it no longer: it ends once the axes rest, at most `within` s from now."""
        if self.holder is not None and self.holder.session == session and self._next is None:
            self.leaving, self._end = True, min(self._end, now + within)

    def closed(self, session: str, now: float) -> None:
        """The connection of that client is gone."""
        if self.asking is not None and self.asking.session == session:
            self.asking, self._asked = None, math.inf
        if self._next is not None and self._next.session == session:
            self._next, self.leaving = None, True
        self.release(session, now, HANDOVER)

    def step(self, now: float, rests: bool, busy: bool) -> None:
        """`rests`: every axis does. `busy`: an action of the holder goes on, so that it is not idle."""
        if busy:
            self._used = max(self._used, now)
        if self.asking is not None and now - self._asked >= ASK_TIME:
            self._next, self.asking, self._asked = self.asking, None, math.inf
            self.leaving, self._end = True, now + HANDOVER
        if self.holder is not None and not self.leaving and now - self._used >= IDLE:
            self._notify(f"{self.name} has done nothing for {IDLE:g} s")
            self.leaving, self._end = True, now + HANDOVER
        if self.leaving and (now >= self._end or (rests and not (busy and self._next is None))):
            self._pass(now)

    @property
    def passing(self) -> bool:
        """Whether another one gets it, once the axes rest: what the holder has begun ends."""
        return self._next is not None

    def _pass(self, now: float) -> None:
        following, before, brief = self._next or self.asking, self.name, self.brief
        self.holder = self.asking = self._next = None
        self.leaving, self.brief, self._asked, self._end = False, False, math.inf, math.inf
        self.changes += 1
        if following is not None:
            self._give(following, now, False)
            self._notify(f"{before} has passed control to {following.name}")
        elif not brief:
            self._notify(f"{before} has control no longer: it is free")

    def _give(self, person: Person, now: float, brief: bool) -> None:
        self.holder, self.leaving, self.brief = person, False, brief
        self._used, self._end = now, math.inf
        self.changes += 1

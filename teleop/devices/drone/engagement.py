"""Who has the drone: the engagement of an operator, from asking for it to having given it back, as one table.

Nothing flies by accident. A drone is taken only by an operator's own act, once per act, for virtual RC never within two
seconds of the last enable (repeating it locks the drone: docs/protocol-facts.md) and never again by itself: the table
has one event that takes. Every other way ends in LEAVING, in which the sticks are neutral, and from there in giving
back. That is confirmed only by what the drone says, never by its silence; until it is, the drone is UNCONFIRMED, and
what can be sent again is, until the drone confirms it or an operator takes it again. Sticks are in force only while a
hand holds them: without one they are neutral at once, and the drone is given back after a second.

All of this is pure: time comes in as `now`, what to send goes out as an Order, at the pace that the drone needs.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from enum import Enum, auto

GAP = 2.0  # s between two enables of virtual RC, at least: docs/protocol-facts.md
OFF_AFTER = 1.0  # s without input on the sticks after which the drone is given back
CONFIRM = 1.0  # s within which the drone says that it was taken
LAST_NEUTRALS = 6  # neutral frames before giving back
LEAVE_WITHIN = 1.0  # s for these, however seldom they may leave
CHECK = 1.5  # s within which the drone says that it was given back: longer than its own timeout of 1 s
SETTLED = 2.0  # s after which a broadcast that contradicts a confirmed giving back is no older one
SLACK = 1e-6  # s


class Stage(Enum):
    IDLE = "idle"  # nothing is sent
    TAKING = "taking"  # taken, which the drone has not confirmed yet; sticks are in force
    ENGAGED = "engaged"  # confirmed
    ADRIFT = "adrift"  # no input on the sticks: neutral
    LEAVING = "leaving"  # neutral, then given back
    CHECKING = "checking"  # given back, which the drone has not confirmed yet
    UNCONFIRMED = "unconfirmed"  # given back, which the drone has not confirmed in time


class EngagementEvent(Enum):
    ENGAGE = auto()
    CONFIRMED = auto()
    INPUT_LOST = auto()
    INPUT_BACK = auto()
    LEAVE = auto()
    GIVEN_BACK = auto()
    FREE = auto()  # the drone confirms that it is free
    SILENT = auto()  # it has not confirmed it in time, and giving back is sent again
    GIVEN_UP = auto()  # it has not confirmed it in time, and nothing can be sent again
    CONTRADICTED = auto()  # it had confirmed it, and says now that it is held
    UNSENT = auto()  # the giving back did not leave


TRANSITIONS: Mapping[tuple[Stage, EngagementEvent], Stage] = {
    (Stage.IDLE, EngagementEvent.ENGAGE): Stage.TAKING,
    (Stage.TAKING, EngagementEvent.CONFIRMED): Stage.ENGAGED,
    (Stage.TAKING, EngagementEvent.LEAVE): Stage.LEAVING,
    (Stage.ENGAGED, EngagementEvent.INPUT_LOST): Stage.ADRIFT,
    (Stage.ENGAGED, EngagementEvent.LEAVE): Stage.LEAVING,
    (Stage.ADRIFT, EngagementEvent.INPUT_BACK): Stage.ENGAGED,
    (Stage.ADRIFT, EngagementEvent.LEAVE): Stage.LEAVING,
    (Stage.LEAVING, EngagementEvent.GIVEN_BACK): Stage.CHECKING,
    (Stage.CHECKING, EngagementEvent.FREE): Stage.IDLE,
    (Stage.CHECKING, EngagementEvent.SILENT): Stage.UNCONFIRMED,
    (Stage.CHECKING, EngagementEvent.GIVEN_UP): Stage.IDLE,
    (Stage.CHECKING, EngagementEvent.UNSENT): Stage.LEAVING,
    (Stage.UNCONFIRMED, EngagementEvent.FREE): Stage.IDLE,
    (Stage.UNCONFIRMED, EngagementEvent.ENGAGE): Stage.TAKING,
    (Stage.IDLE, EngagementEvent.CONTRADICTED): Stage.LEAVING,
}
HELD = frozenset({Stage.TAKING, Stage.ENGAGED, Stage.ADRIFT})  # the drone is ours


class Order(Enum):
    """What to send now."""

    NOTHING = auto()
    DRIVE = auto()  # the sticks as they are
    NEUTRAL = auto()
    GIVE_BACK = auto()


class EngagementError(RuntimeError):
    """Something takes a drone that must not be taken now: a defect of this program."""


class Engagement:
    """One operator's hold on one drone.

    `what` is what is taken ("virtual RC"), `period` is s between two frames, `taken` is when it was taken last (s), and
    `gap` is how long after that it must not be taken again. `notify` is for what the operator has to know. With
    `repeats` giving back can be sent again, so that the drone stays UNCONFIRMED until it confirms; else there is
    nothing to do.
    """

    def __init__(
        self,
        what: str,
        period: float,
        taken: float,
        notify: Callable[[str], object],
        *,
        gap: float = GAP,
        repeats: bool = False,
    ) -> None:
        self.stage = Stage.IDLE
        self.failure = ""  # why it was last left without the operator asking for it
        self.unreturned = ""  # what the drone did when it was last given back, while it has not confirmed that
        self._what, self._period, self._notify, self._gap, self._repeats = what, period, notify, gap, repeats
        self._taken = taken
        self._since = taken  # in this stage
        self._next = -math.inf  # s: when a frame is due
        self._neutrals = 0
        self._confirmed = False  # whether the drone has reported that it is held

    def refusal(self, now: float) -> str:
        """Why the drone cannot be taken now, "" if it can."""
        if (self.stage, EngagementEvent.ENGAGE) not in TRANSITIONS:
            return "it is engaged" if self.stage in HELD else "its release is not confirmed yet"
        if (left := self._taken + self._gap - now) > SLACK:
            wait = math.ceil(left * 10 - SLACK) / 10  # never "0.0 s"
            return f"wait {wait:.1f} s: twice within {self._gap:g} s would lock the drone"
        return ""

    def engage(self, now: float) -> None:
        """Take the drone, once, now. Raises EngagementError where `refusal` says why not."""
        if refusal := self.refusal(now):
            raise EngagementError(f"the drone must not be taken: {refusal}")
        self._taken, self._next, self.failure, self.unreturned = now, now, "", ""
        self._handle(EngagementEvent.ENGAGE, now)

    def leave(self, now: float, why: str, *, asked: bool = False) -> None:
        """Begin to give the drone back, if it is held; `asked` is whether the operator asked for it."""
        if self.stage in HELD:
            self.failure = "" if asked else why
            self._notify(f"{why}: sticks neutral, releasing {self._what}")
            self._handle(EngagementEvent.LEAVE, now)

    def not_sent(self, now: float) -> None:
        """What the last order gave back did not leave: it is to be tried again."""
        if self.stage is Stage.CHECKING:
            self._handle(EngagementEvent.UNSENT, now)

    def contradicted(self, now: float) -> None:
        """The drone says that it is held, long after it confirmed that it is not: give it back again."""
        if self.stage is Stage.IDLE and now - self._since > SETTLED:
            self._notify(f"the drone reports {self._what} on again: releasing it")
            self._handle(EngagementEvent.CONTRADICTED, now)

    def advance(self, now: float, has_input: bool, held: bool | None, patience: float = CONFIRM) -> Order:
        """What to send now; to be asked each tick.

        `has_input` is whether a live input holds the sticks, `held` whether the drone says that it is ours, None where
        it says nothing; `patience` is how long it may take to confirm that (s).
        """
        match self.stage:
            case Stage.IDLE:
                return Order.NOTHING
            case Stage.CHECKING | Stage.UNCONFIRMED:
                self._check(now, held)
                return Order.NOTHING
            case Stage.TAKING:
                self._confirm(now, held, patience)
            case Stage.ENGAGED | Stage.ADRIFT if held is False:
                self.leave(now, f"the drone has ended {self._what}: its pilot took control, or no frame reached it")
            case Stage.ENGAGED | Stage.ADRIFT if held is None and self._confirmed:
                self.leave(now, f"the drone no longer reports whether {self._what} is on")
        self._check_input(now, has_input)
        return self._frame(now)

    def _confirm(self, now: float, held: bool | None, patience: float) -> None:
        late = now - self._since > patience
        if held or (late and held is None):
            self._confirmed = bool(held)
            self._handle(EngagementEvent.CONFIRMED, now)
            self._notify(f"engaged: the drone confirms {self._what}" if held else self._unconfirmed)
        elif late:
            self.leave(now, f"the drone does not confirm {self._what}")

    @property
    def _unconfirmed(self) -> str:
        return f"engaged, but the drone does not report whether {self._what} is on: it sends no control field"

    def _check_input(self, now: float, has_input: bool) -> None:
        if self.stage is Stage.TAKING and not has_input:
            self.leave(now, "no stick input")
        elif self.stage is Stage.ENGAGED and not has_input:
            self._handle(EngagementEvent.INPUT_LOST, now)
            self._notify(f"no stick input: sending neutral, releasing {self._what} in {OFF_AFTER:g} s")
        elif self.stage is Stage.ADRIFT and has_input:
            self._handle(EngagementEvent.INPUT_BACK, now)
            self._notify("stick input is back")
        elif self.stage is Stage.ADRIFT and now - self._since >= OFF_AFTER - SLACK:
            self.leave(now, f"no stick input for {OFF_AFTER:g} s")

    def _frame(self, now: float) -> Order:
        if now < self._next - SLACK:
            return Order.NOTHING
        self._next = now + self._period
        if self.stage is Stage.LEAVING:
            if self._neutrals >= LAST_NEUTRALS or now - self._since > LEAVE_WITHIN:
                self._handle(EngagementEvent.GIVEN_BACK, now)
                return Order.GIVE_BACK
            self._neutrals += 1
        return Order.DRIVE if self.stage in (Stage.TAKING, Stage.ENGAGED) else Order.NEUTRAL

    def _check(self, now: float, held: bool | None) -> None:
        if held is False:
            self._notify(f"{self._what} is released: the drone confirms it")
            self.unreturned = ""
            self._handle(EngagementEvent.FREE, now)
        elif self.stage is Stage.CHECKING and now - self._since > CHECK:
            answer = "reports that it is still on" if held else "reports nothing"
            self.unreturned = f"{self._what}: released, but the drone {answer}: take it over with its RC"
            self._notify(self.unreturned)
            self._handle(EngagementEvent.SILENT if self._repeats else EngagementEvent.GIVEN_UP, now)

    def _handle(self, event: EngagementEvent, now: float) -> None:
        self.stage, self._since, self._neutrals = TRANSITIONS[self.stage, event], now, 0

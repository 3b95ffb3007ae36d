"""A task of the drone (01 01: take off, land, return home) from the order to its end, as the drone tells it.

Answer 2 says that it has started and 1 that it failed (OPENProtocol.md 3.1.9, 01 01); any other answer is no success.
No answer says nothing: the drone may have started, and then its flight status shows it. The end is in no answer, only
in the status: a take-off ends in the air, once it no longer climbs; landing and returning home end in standby. From
the order to the end no movement is streamed, which would break the task off, unless a stick is moved for it: one that
was centered after the order. The protocol has no order that ends a task.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from enum import Enum, auto

from teleop.devices.drone.control_mode import Deflections, not_in_standby, word_of
from teleop.devices.drone.telemetry import Telemetry
from teleop.dji.drone.enums import FlightStatus, TaskCode, TaskKind

CENTERED = 0.02  # of full deflection
UNCHANGED = 4.0  # s after the order by which the status of a drone that takes off or lands has changed
LEVEL = 0.1  # m/s of climb, at most, of a drone that has reached its height
LEVEL_FOR = 1.0  # s that it has climbed no faster than that
BLIND_FOR = 5.0  # s in the air after which it has reached its height where it does not say how it climbs
WORDS = {"take-off": TaskKind.TAKE_OFF, "land": TaskKind.LAND, "home": TaskKind.RETURN_HOME}
NAMES = {kind: word for word, kind in WORDS.items()}
SHOWS = {  # that a task has begun; returning home begins in the air, as it was before
    TaskKind.TAKE_OFF: (FlightStatus.TAKE_OFF, FlightStatus.IN_AIR),
    TaskKind.LAND: (FlightStatus.LANDING, FlightStatus.FINISH_LANDING),
    TaskKind.RETURN_HOME: (FlightStatus.LANDING, FlightStatus.FINISH_LANDING),
}


class Phase(Enum):
    ASKED = auto()
    UNANSWERED = auto()
    RUNNING = auto()


class TaskWatch:
    """The task that was ordered last. `notify` is for what the operator has to know."""

    def __init__(self, notify: Callable[[str], object]) -> None:
        self._notify = notify
        self.kind: TaskKind | None = None  # None: none runs
        self._phase = Phase.ASKED
        self._since = -math.inf  # s: when it was ordered
        self._begun = False  # as its status shows
        self._landing = False
        self._level_since = math.inf
        self._warned = False
        self._centered = True  # whether the sticks were, since the order

    @property
    def runs(self) -> bool:
        """Whether the drone does, or may do, something by itself."""
        return self.kind is not None

    @property
    def word(self) -> str:
        return "" if self.kind is None else NAMES[self.kind]

    def begin(self, kind: TaskKind, now: float) -> None:
        """It is ordered now (s)."""
        self.kind, self._phase, self._since = kind, Phase.ASKED, now
        self._begun = self._landing = self._warned = self._centered = False
        self._level_since = math.inf

    def answered(self, code: object) -> None:
        """What the drone answers to the newest order, None for nothing."""
        if self.kind is None:
            return
        if code == TaskCode.STARTED:
            self._phase = Phase.RUNNING
            self._notify(f"{self.word}: started")
        elif code is None:
            self._phase = Phase.UNANSWERED
            self._notify(f"{self.word}: no answer; its status will show whether it started")
        else:
            self._end(f"refused, {word_of(code)}")

    def watch(self, seen: Telemetry, now: float) -> None:
        """Look at the status for its beginning and its end; to be called each tick."""
        status = seen.get("status", now)
        if self.kind is None or status is None or self._phase is Phase.ASKED:
            return
        if status in SHOWS[self.kind]:
            self._begun = True
        self._landing |= status == FlightStatus.LANDING
        if self.kind is TaskKind.TAKE_OFF:
            self._watch_rise(seen, status, now)
        elif self._landing and status == FlightStatus.IN_AIR:
            self._end("interrupted: the drone no longer lands")
        elif status == FlightStatus.STANDBY and (self._begun or self._phase is Phase.RUNNING):
            self._end("finished: the drone is on the ground")
        if self.kind not in (None, TaskKind.RETURN_HOME) and not self._begun and now - self._since > UNCHANGED:
            self._unchanged(status)

    def moved(self, sticks: Deflections) -> bool:
        """Whether a stick ends the task now, as far as this program is concerned."""
        deflected = any(abs(deflection) > CENTERED for deflection in sticks.values())
        self._centered |= not deflected
        if self.kind is None or not (deflected and self._centered):
            return False
        self._end("a stick was moved: the sticks fly it again")
        return True

    @property
    def locks_sticks(self) -> bool:
        """Whether a stick that was held when the task was ordered has not been centered since."""
        return not self._centered

    def goes_on(self) -> str:
        """What becomes of the task when control is released, "" where none runs."""
        if self.kind is None:
            return ""
        may = "goes on" if self._phase is Phase.RUNNING else "may go on"
        return f"{self.word} {may} by itself: take it over with the RC"

    def _watch_rise(self, seen: Telemetry, status: object, now: float) -> None:
        if status == FlightStatus.IN_AIR:
            velocity = seen.get("velocity", now)
            climb = velocity.z if velocity is not None and velocity.valid else None
            climbs = climb is not None and abs(climb) > LEVEL
            self._level_since = math.inf if climbs else min(self._level_since, now)
            if now - self._level_since >= (BLIND_FOR if climb is None else LEVEL_FOR):
                self._end("finished: the drone is in the air")
        elif self._begun and status != FlightStatus.TAKE_OFF:
            self._end(f"interrupted: the drone reports {word_of(status)}")

    def _unchanged(self, status: object) -> None:
        if self._phase is Phase.UNANSWERED:
            self._end(f"not started: the drone reports {word_of(status)}")
        elif not self._warned:
            self._warned = True
            self._notify(f"{self.word}: the drone still reports {word_of(status)}; a moved stick flies it again")

    def _end(self, why: str) -> None:
        word, self.kind = self.word, None
        self._notify(f"{word}: {why}")


def take_off_refusal(seen: Telemetry, now: float, armed: bool) -> str:
    """Why an automatic take-off is not ordered: it works only with the motors off (OPENProtocol.md 3.1.9, 01 01).

    `armed` is whether this program started them, which the status does not show.
    """
    if armed:
        return "the motors run: drone disarm first"
    if reason := not_in_standby(seen, now):
        known = seen.get("status", now) is not None
        return f"{reason}: its motors run" if known else reason
    return ""

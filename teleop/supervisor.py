"""What a run is doing, and how it may change its mind, as one table.

A run has one way out: come to rest, give the devices back, close. Everything that can end it (the last keyframe, a
fault, Ctrl-C) is an event that starts on that way; what arrives later can make the outcome worse, never better, and
never turns back.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import Enum, IntEnum, auto


class Run(Enum):
    WAITING = auto()  # for the first report of every axis in use
    RUNNING = auto()
    STOPPING = auto()  # axes ramp to rest
    RELEASING = auto()  # devices are given back
    OVER = auto()


class Event(Enum):
    REPORTED = auto()
    FINISHED = auto()
    FAULT = auto()
    INTERRUPT = auto()
    AT_REST = auto()
    RELEASED = auto()


class Result(IntEnum):
    """How a run ended; the larger, the graver."""

    DONE = 0
    INTERRUPTED = 1
    FAILED = 2


TRANSITIONS: Mapping[tuple[Run, Event], Run] = {
    (Run.WAITING, Event.REPORTED): Run.RUNNING,
    (Run.WAITING, Event.FAULT): Run.RELEASING,
    (Run.WAITING, Event.INTERRUPT): Run.RELEASING,
    (Run.RUNNING, Event.FINISHED): Run.STOPPING,
    (Run.RUNNING, Event.FAULT): Run.STOPPING,
    (Run.RUNNING, Event.INTERRUPT): Run.STOPPING,
    (Run.STOPPING, Event.FAULT): Run.STOPPING,
    (Run.STOPPING, Event.INTERRUPT): Run.STOPPING,
    (Run.STOPPING, Event.AT_REST): Run.RELEASING,
    (Run.RELEASING, Event.FAULT): Run.RELEASING,
    (Run.RELEASING, Event.INTERRUPT): Run.RELEASING,
    (Run.RELEASING, Event.RELEASED): Run.OVER,
}

_RESULTS = {Event.FAULT: Result.FAILED, Event.INTERRUPT: Result.INTERRUPTED}
_MAX_REASONS = 8  # a fault repeats every tick; the first ones explain it


class IllegalEventError(Exception):
    """A defect of this program: an event that the table does not allow in this state."""


@dataclass
class Supervisor:
    """The state of one run, its result so far, and why it stopped, oldest reason first."""

    state: Run = Run.WAITING
    result: Result = Result.DONE
    reasons: list[str] = field(default_factory=list)

    def happened(self, event: Event, reason: str = "") -> None:
        """Follow the table; raises IllegalEventError when it has no row for this."""
        try:
            self.state = TRANSITIONS[self.state, event]
        except KeyError:
            raise IllegalEventError(f"{event.name} while {self.state.name}") from None
        self.result = max(self.result, _RESULTS.get(event, Result.DONE))
        if reason and reason not in self.reasons and len(self.reasons) < _MAX_REASONS:
            self.reasons.append(reason)

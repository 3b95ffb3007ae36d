"""What a run is doing, and how it may change its mind, as one table.

A run has one way out: come to rest, give the devices back, close. Everything that can end it (the last keyframe, a
fault, Ctrl-C) is an event that starts on that way; what arrives later can make the outcome worse, never better, and
never turns back.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import Enum, IntEnum, auto


class RunState(Enum):
    WAITING = auto()  # for the first report of every axis in use
    RUNNING = auto()
    STOPPING = auto()  # axes ramp to rest
    RELEASING = auto()  # devices are given back
    OVER = auto()


class RunEvent(Enum):
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


TRANSITIONS: Mapping[tuple[RunState, RunEvent], RunState] = {
    (RunState.WAITING, RunEvent.REPORTED): RunState.RUNNING,
    (RunState.WAITING, RunEvent.FAULT): RunState.RELEASING,
    (RunState.WAITING, RunEvent.INTERRUPT): RunState.RELEASING,
    (RunState.RUNNING, RunEvent.FINISHED): RunState.STOPPING,
    (RunState.RUNNING, RunEvent.FAULT): RunState.STOPPING,
    (RunState.RUNNING, RunEvent.INTERRUPT): RunState.STOPPING,
    (RunState.STOPPING, RunEvent.FAULT): RunState.STOPPING,
    (RunState.STOPPING, RunEvent.INTERRUPT): RunState.STOPPING,
    (RunState.STOPPING, RunEvent.AT_REST): RunState.RELEASING,
    (RunState.RELEASING, RunEvent.FAULT): RunState.RELEASING,
    (RunState.RELEASING, RunEvent.INTERRUPT): RunState.RELEASING,
    (RunState.RELEASING, RunEvent.RELEASED): RunState.OVER,
}

_RESULTS = {RunEvent.FAULT: Result.FAILED, RunEvent.INTERRUPT: Result.INTERRUPTED}
_MAX_REASONS = 8  # a fault repeats every tick; the first ones explain it


class IllegalEventError(Exception):
    """A defect of this program: an event that the table does not allow in this state."""


@dataclass
class RunStateMachine:
    """The state of one run, its result so far, and why it stopped, oldest reason first."""

    state: RunState = RunState.WAITING
    result: Result = Result.DONE
    reasons: list[str] = field(default_factory=list)

    def handle(self, event: RunEvent, reason: str = "") -> None:
        """Follow the table; raises IllegalEventError when it has no row for this."""
        try:
            self.state = TRANSITIONS[self.state, event]
        except KeyError:
            raise IllegalEventError(f"{event.name} while {self.state.name}") from None
        self.result = max(self.result, _RESULTS.get(event, Result.DONE))
        if reason and reason not in self.reasons and len(self.reasons) < _MAX_REASONS:
            self.reasons.append(reason)

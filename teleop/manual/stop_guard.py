"""STOP for every run that moves by itself: a sequence, a shoot, a calibration move.

The guard stands between the loop and such a source, and reads every input first. A STOP halts all axes with their full
acceleration and jerk and latches; what was due is kept for later. An operator clears it and then goes on; the source
takes the axes from rest back to where it was left. An input that has a STOP and is lost pauses the run. It is no
emergency stop (ISO 13850): the motors stay powered.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from enum import Enum, auto
from typing import Protocol

from teleop.core.axes import Motion
from teleop.core.errors import DeviceError, Interrupted
from teleop.core.events import SourceEvent, TickEvent
from teleop.core.interfaces import Feedback, Source
from teleop.core.operator_input import Command, Held, Input, Press
from teleop.core.run_status import Hint, RunStatus, stop_state
from teleop.core.setpoints import Demand, Stop

KEYS_PERIOD = 0.05  # s between two looks at the inputs while nothing moves
GRACE = 1.0  # s after the start within which an input is found and has reported
STOPPING = "stopping: all axes slow down to rest"
STOPPED = "STOPPED. Press c to clear, q to end."
GO_ON = "Press p or Enter to continue, q to end."
GOES_ON = (Command.PAUSE, Command.GO)  # either goes on after a STOP or a pause
CLEAR_HINTS = (Hint("c", "clear"), Hint("q", "end"))
GO_HINTS = (Hint("p", "continue"), Hint("space", "STOP"), Hint("q", "end"))


class Hold(Enum):
    """What moves the axes."""

    FREE = auto()  # the source
    STOPPED = auto()  # nothing: a STOP that is not cleared
    CLEARED = auto()  # nothing, until an operator continues
    PAUSED = auto()  # nothing, until an operator continues: there was no STOP


class Resumable(Source, Protocol):
    """A source whose axes may be halted at any time, away from where it would have them."""

    @property
    def resumable(self) -> bool:
        """Whether it can go on after a STOP; one that cannot ends with it."""
        ...

    @property
    def quits(self) -> bool:
        """Whether it ends the run itself when it is asked to, while nothing holds it."""
        ...

    @property
    def pauses(self) -> bool:
        """Whether it can now pause by itself, on its path."""
        ...

    @property
    def busy(self) -> bool:
        """While it is halted: whether something goes on that has to end before an axis moves again."""
        ...

    def pause(self, now: float) -> bool | None:
        """Pause on its path; to be asked each tick until it is: True once it is, False where it cannot."""
        ...

    def suspend(self, now: float) -> None:
        """The axes are halted from `now` on. Its own time stands still until `resume`; may be called again before."""
        ...

    def linger(self, now: float) -> Sequence[TickEvent]:
        """While it is halted: what has to be done all the same, to end what was begun."""
        ...

    def resume(self, now: float, motion: Motion) -> None:
        """Go on from `now`; every axis rests where `motion` has it."""
        ...


class Relay:
    """An input as the source beneath the guard sees it: without what is the guard's."""

    def __init__(self, device: Input) -> None:
        self._device = device
        self.held = Held()
        self.trouble: str | None = None  # why its STOP does not count, None where that is not known or it has none

    @property
    def name(self) -> str:
        return self._device.name

    def poll(self, now: float) -> Sequence[Press]:
        """Ask the device; what was pressed, none of which reaches the source unless it is passed on."""
        held = self._device.read(now)
        self.held = replace(held, presses=())
        return held.presses

    def pass_on(self, press: Press) -> None:
        self.held = replace(self.held, presses=(*self.held.presses, press))

    def read(self, now: float) -> Held:  # noqa: ARG002 - the guard has asked
        held, self.held = self.held, replace(self.held, presses=(), steps={}, notes=())
        return held


class Together:
    """Several inputs as one, for a source that only hears what is pressed."""

    def __init__(self, inputs: Sequence[Input]) -> None:
        self._inputs = inputs

    @property
    def name(self) -> str:
        return self._inputs[0].name

    def read(self, now: float) -> Held:
        return Held(presses=[press for each in self._inputs for press in each.read(now).presses])


class StopGuard:
    """`source` under `relays`, which its own inputs have to be; `notify` is for lines that the operator is to read.

    `poll` (s) is how often the inputs are looked at while nothing moves. `stopped_by` is a STOP from an earlier run of
    the same job, which is still latched.
    """

    def __init__(
        self,
        source: Resumable,
        relays: Sequence[Relay],
        notify: Callable[[str], object] = lambda _text: None,
        poll: float = KEYS_PERIOD,
        stopped_by: str = "",
    ) -> None:
        self._source, self._relays, self.notify, self._period = source, relays, notify, poll
        self._hold = Hold.STOPPED if stopped_by else Hold.FREE
        self.stopped_by = stopped_by  # the input that asked for the STOP in force, "" for none
        self._why = ""  # why it is paused
        self._going = self._lost = False  # `lost`: the source is asked to pause, and has not yet
        self._end: Exception | None = None
        self._motion: Motion = {}
        self._since = math.inf

    def start(self, now: float, motion: Motion) -> None:
        self._motion, self._since = motion, now
        self._source.start(now, motion)
        if self._hold is not Hold.FREE:
            self._source.suspend(now)

    def read(self, now: float, feedback: Feedback) -> tuple[Demand, Sequence[SourceEvent]]:
        """Raises Interrupted once an operator has ended it, DeviceError where a lost input does."""
        self._motion = feedback.motion
        # A STOP has the last word: a clear in the same tick does not undo it.
        pressed = [(relay, press) for relay in self._relays for press in relay.poll(now)]
        self._check_stops(now)
        for relay, press in sorted(pressed, key=lambda each: each[1].command is Command.STOP):
            self._handle(relay, press, now)
        if self._end is not None:
            raise self._end
        if self._going and self._rests and not self._source.busy:
            self._hold, self._going, self.stopped_by, self._why = Hold.FREE, False, "", ""
            self._source.resume(now, self._motion)
        if self._hold is Hold.FREE:
            return self._source.read(now, feedback)
        return dict.fromkeys(self._motion, Stop()), self._source.linger(now)

    def next_change(self, now: float) -> float:
        if self._hold is Hold.FREE:
            change = self._source.next_change(now)
            return change if math.isinf(change) or not self._relays else min(change, now + self._period)
        return now if self._source.busy or not self._rests else now + self._period

    @property
    def halted(self) -> bool:
        return self._hold is not Hold.FREE

    @property
    def paused(self) -> bool:
        """Whether an operator has to continue before an axis moves again."""
        return self._hold in (Hold.PAUSED, Hold.CLEARED)

    @property
    def stop(self) -> str:
        """Of a STOP that is not cleared: "stopping" while an axis still moves, then "stopped"; else ""."""
        return stop_state(self._hold is Hold.STOPPED, self._motion)

    @property
    def reason(self) -> str:
        """For the report of a run that ended now: that it was stopped, "" if it was not."""
        return f"ended while stopped: STOP by {self.stopped_by}" if self.stopped_by else ""

    @property
    def note(self) -> str:
        """What holds the axes, and what an operator can do about it; "" while nothing does."""
        match self._hold:
            case Hold.STOPPED:
                return STOPPING if self.stop == "stopping" else STOPPED
            case Hold.CLEARED | Hold.PAUSED if self._going:
                return "continuing once all axes are at rest"
            case Hold.CLEARED:
                return f"STOP cleared. {GO_ON}"
            case Hold.PAUSED:
                return f"paused{f': {self._why}' if self._why else ''}. {GO_ON}"
        return ""

    def over(self, status: RunStatus) -> RunStatus:
        """What a view shows: what the source says of itself, and over it what holds the axes."""
        if self._hold is Hold.FREE:
            return status
        hints = CLEAR_HINTS if self._hold is Hold.STOPPED else GO_HINTS
        paused = self._hold is not Hold.STOPPED
        stop = stop_state(not paused, self._motion)
        phase = stop or "paused"
        return replace(status, phase=phase, stop=stop, paused=paused, left=None, note=self.note, hints=hints)

    @property
    def _rests(self) -> bool:
        return all(state.velocity == 0 and state.acceleration == 0 for state in self._motion.values())

    def _handle(self, relay: Relay, press: Press, now: float) -> None:
        command = press.command
        if command is Command.STOP:
            self._stop(press.by or relay.name, now)
        elif command is Command.CLEAR:
            self._clear(now)
        elif command is Command.QUIT and (self._hold is not Hold.FREE or not self._source.quits):
            self._end = self._end or Interrupted(f"stopped by {press.by or relay.name}")
        elif self._hold is Hold.FREE:
            if command is Command.PAUSE and not self._source.pauses:
                self._halt(Hold.PAUSED, now)
            else:
                relay.pass_on(press)
        elif command in GOES_ON and self._hold is not Hold.STOPPED:
            self._going = True

    def _stop(self, name: str, now: float) -> None:
        if self._hold is Hold.STOPPED:
            return
        self.stopped_by = name
        self.notify(f"STOP by {name}. A recording camera keeps recording.")
        self._halt(Hold.STOPPED, now)
        if not self._source.resumable:
            self._end = self._end or Interrupted(f"STOP by {name}: a drone's move cannot be resumed")

    def _clear(self, now: float) -> None:
        if self._hold is not Hold.STOPPED:
            return
        self._hold = Hold.CLEARED
        self.notify(f"STOP cleared. {GO_ON}")
        if math.isinf(self._source.next_change(now)):  # it was over, so there is nothing to go on with
            self._going = True

    def _halt(self, hold: Hold, now: float) -> None:
        if self._hold is Hold.FREE:
            self._source.suspend(now)
        self._hold, self._going = hold, False

    def _check_stops(self, now: float) -> None:
        """Whether each STOP still counts: one that is lost pauses the run."""
        for relay in self._relays:
            trouble, before = relay.held.stop, relay.trouble
            if trouble is None or trouble == before:
                continue
            if before == "":
                self._lose(trouble)
            elif before is None and now - self._since < GRACE:
                if trouble:
                    continue
            elif trouble:
                self.notify(f"{trouble}: its STOP does not work")
            else:
                self.notify(f"{relay.name}: its STOP works{' again' if before else ''}")
            relay.trouble = trouble
        if self._lost and self._hold is Hold.FREE:
            paused = self._source.pause(now) if self._source.pauses else False
            self._lost = paused is None
            if paused is False:
                self._halt(Hold.PAUSED, now)

    def _lose(self, trouble: str) -> None:
        self.notify(f"{trouble}: STOP lost, the run pauses")
        self._lost, self._why = True, trouble
        if not self._source.resumable:
            self._end = self._end or DeviceError(f"{trouble}: its STOP is lost")

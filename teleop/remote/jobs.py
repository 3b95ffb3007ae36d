"""What a client has asked for and what lasts: a way to a place, or a move.

It drives the axes beneath the operator's inputs, one at a time. A STOP ends a way and holds a move where it is; an
input that takes an axis of a way ends it too. What becomes of each is told to `ended`.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from typing import Protocol

from teleop.app.program import MoveJob
from teleop.core.axes import Axis, Motion
from teleop.core.errors import TeleopError
from teleop.core.events import SourceEvent, Tick, TickEvent
from teleop.core.interfaces import Feedback
from teleop.core.setpoints import Demand
from teleop.devices.gimbal.outlook import Foreseen

Ended = Callable[[str], object]
"""Told why it ended before its end, "" when it is done."""


class RemoteJob(Protocol):
    """Something that lasts. `axes` are those that it moves, `title` is for people, `owner` the session behind it."""

    title: str
    owner: str
    ended: Ended

    @property
    def axes(self) -> Collection[Axis]: ...

    def start(self, now: float, motion: Motion) -> None: ...

    def read(self, now: float, feedback: Feedback, /) -> tuple[Demand, Sequence[SourceEvent]]: ...

    def done(self, tick: Tick) -> bool:
        """Whether it is complete, seen from this tick; raises TeleopError when it cannot be completed."""
        ...

    def halt(self, now: float, why: str) -> bool:
        """A STOP, or control on its way to another one: whether it is over with that."""
        ...

    def outranked(self, now: float, why: str) -> bool:
        """An input of the operator has taken an axis of it: whether it is over with that."""
        ...

    def foreseen(self, time: float) -> Motion:
        """Where its axes will be at a `time` soon, on the loop's clock; none where that is not known."""
        ...


class WayJob:
    """Every axis to its target and at rest there, in `seconds` or as soon as the limits allow."""

    def __init__(
        self,
        title: str,
        owner: str,
        targets: Mapping[Axis, float],
        seconds: float | None,
        ended: Ended,
        speeds: Mapping[Axis, float] | None = None,
    ) -> None:
        self.title, self.owner, self.targets, self.ended = title, owner, targets, ended
        self._job = MoveJob(targets, seconds or None, speeds)
        self.start = self._job.start
        self.read = self._job.read
        self.done = self._job.done

    @property
    def axes(self) -> Collection[Axis]:
        return self.targets

    def halt(self, now: float, why: str) -> bool:  # noqa: ARG002 - it cannot be resumed
        return True

    outranked = halt

    def foreseen(self, time: float) -> Motion:  # noqa: ARG002 - the planner decides on its way
        return {}


class JobSource:
    """The job in hand as the source beneath the operator's inputs; it never ends the run.

    `taken` are the axes that inputs move in the tick before. `foresee` is told of each job that begins where it will
    be, and None when it ends.
    """

    def __init__(self, taken: Callable[[], Collection[Axis]]) -> None:
        self._taken = taken
        self.foresee: Callable[[Foreseen | None], object] = lambda _foreseen: None
        self.job: RemoteJob | None = None
        self._fresh = False
        self.events: list[TickEvent] = []  # for the next tick

    def begin(self, job: RemoteJob) -> None:
        """Instead of what was under way."""
        self.end(f"replaced by {job.title}")
        self.job, self._fresh = job, True

    def again(self) -> None:
        """Another run of the rig begins, with the job that is in hand."""
        self._fresh, self.events = self.job is not None, []

    def end(self, why: str) -> None:
        """End the job in hand, if there is one."""
        job, self.job = self.job, None
        if job is not None:
            self.foresee(None)
            job.ended(why)

    def halt(self, now: float, why: str) -> None:
        if self.job is not None and self.job.halt(now, why):
            self.end(why)

    # --- the source

    def start(self, now: float, motion: Motion) -> None: ...  # jobs begin later

    def read(self, now: float, feedback: Feedback) -> tuple[Demand, Sequence[SourceEvent]]:
        events, self.events = self.events, []
        job = self.job
        if job is not None and (lost := set(job.axes) & set(self._taken())):
            why = f"an operator moved {' and '.join(sorted(lost))}"
            if job.outranked(now, why):
                self.end(why)
                job = None
        if job is None:
            return {}, events
        if self._fresh:
            self._fresh = False
            job.start(now, feedback.motion)
            self.foresee(job.foreseen)
        demand, due = job.read(now, feedback)
        return demand, [*events, *due]

    def next_change(self, now: float) -> float:
        return now

    def observe(self, tick: Tick) -> None:
        if self.job is None or self._fresh:
            return
        try:
            if self.job.done(tick):
                self.end("")
        except TeleopError as error:
            self.end(str(error))

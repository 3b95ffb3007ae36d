"""A rig moved by a program: one source that runs a program's jobs, one after the other, in the control loop.

A job is a move to a position, a jog, a sequence, or a camera action. The program's thread hands a job over and waits;
the control thread asks it for setpoints once a tick. STOP is latched here: it cancels the job and brings every axis to
rest at the fastest legal rate, until it is cleared.
"""

from __future__ import annotations

import threading
from collections.abc import Callable, Mapping, Sequence
from typing import Protocol

from teleop.core.axes import Axis, Motion, Reading
from teleop.core.errors import DeviceError, TeleopError
from teleop.core.events import SourceEvent, Tick, TickEvent
from teleop.core.interfaces import Feedback, Observer, Source
from teleop.core.setpoints import Demand, PositionTarget, Stop, VelocityTarget

ARRIVED: Mapping[Axis, float] = {Axis.FOCUS: 0.02}
ARRIVED_ANGLE = 0.5  # deg: as near as a reading must be; a gimbal in speed mode rests within this of its target
SETTLE = 2.0  # s after the commanded arrival within which the readings must be that near


class StoppedError(TeleopError):
    """STOP was pressed, or `stop()` was called; nothing moves until `clear()`."""


class Job(Protocol):
    """Something a program has asked for; `moves` an axis or not. All calls are made by the control thread."""

    moves: bool

    def start(self, now: float, motion: Motion) -> None: ...

    def read(self, now: float, feedback: Feedback, /) -> tuple[Demand, Sequence[SourceEvent]]: ...

    def done(self, tick: Tick) -> bool:
        """Whether it is complete, seen from this tick; raises TeleopError when it cannot be completed."""
        ...


class MoveJob:
    """Every axis to its target (units) and at rest there, `seconds` from its start or as soon as the limits allow.

    `speeds` (unit/s) are the most that axes may go which have no `seconds`.
    """

    moves = True

    def __init__(
        self, targets: Mapping[Axis, float], seconds: float | None, speeds: Mapping[Axis, float] | None = None
    ) -> None:
        self._targets, self._seconds, self._speeds = targets, seconds, speeds or {}
        self._end: float | None = None
        self._arrived: float | None = None

    def start(self, now: float, motion: Motion) -> None:  # noqa: ARG002 - the planner knows where the axes are
        self._end = None if self._seconds is None else now + self._seconds

    def read(self, now: float, _feedback: Feedback) -> tuple[Demand, Sequence[SourceEvent]]:
        left = None if self._end is None else max(0.0, self._end - now)
        return {
            axis: PositionTarget(target, left or None, self._speeds.get(axis)) for axis, target in self._targets.items()
        }, ()

    def done(self, tick: Tick) -> bool:
        states = {axis: tick.motion[axis] for axis in self._targets}
        if any(state.velocity or abs(state.position - self._targets[axis]) > 1e-4 for axis, state in states.items()):
            return False
        self._arrived = tick.time if self._arrived is None else self._arrived
        far = {axis: at for axis, at in self._readings(tick).items() if self._is_far(axis, at)}
        if far and tick.time > self._arrived + SETTLE:
            rests = (f"{axis} rests at {at.position:g}, not {self._targets[axis]:g}" for axis, at in far.items())
            raise DeviceError(", ".join(rests))
        return not far

    def _readings(self, tick: Tick) -> Mapping[Axis, Reading]:
        return {axis: tick.reported[axis] for axis in self._targets if axis in tick.reported}

    def _is_far(self, axis: Axis, reading: Reading) -> bool:
        return abs(reading.position - self._targets[axis]) > ARRIVED.get(axis, ARRIVED_ANGLE)


class JogJob:
    """Every axis at its velocity (unit/s) for `seconds`, then the fastest legal stop."""

    moves = True

    def __init__(self, velocities: Mapping[Axis, float], seconds: float) -> None:
        self._velocities, self._seconds = velocities, seconds
        self._end = 0.0

    def start(self, now: float, motion: Motion) -> None:  # noqa: ARG002 - the planner knows where the axes are
        self._end = now + self._seconds

    def read(self, now: float, _feedback: Feedback) -> tuple[Demand, Sequence[SourceEvent]]:
        over = now >= self._end - 1e-6
        return {axis: Stop() if over else VelocityTarget(speed) for axis, speed in self._velocities.items()}, ()

    def done(self, tick: Tick) -> bool:
        rests = all(not tick.motion[axis].velocity for axis in self._velocities)
        return rests and tick.time >= self._end - 1e-6


class SourceJob:
    """A source of the pipeline, such as a sequence, until it is over and no device still has to answer (`waiting`)."""

    moves = True

    def __init__(self, source: Source, waiting: Callable[[], bool] = lambda: False) -> None:
        self._source, self._waiting = source, waiting
        self._over = False

    def start(self, now: float, motion: Motion) -> None:
        self._source.start(now, motion)

    def read(self, now: float, feedback: Feedback) -> tuple[Demand, Sequence[SourceEvent]]:
        demand, events = self._source.read(now, feedback)
        self._over = self._source.next_change(now) == float("inf")
        return demand, events

    def done(self, tick: Tick) -> bool:
        rests = all(not state.velocity for state in tick.motion.values())
        return self._over and rests and not self._waiting()


class EventJob:
    """One event for a device, complete once `waiting` says that the device has answered; a STOP does not end it."""

    moves = False

    def __init__(self, event: TickEvent, waiting: Callable[[], bool]) -> None:
        self._events: list[TickEvent] = [event]
        self._waiting = waiting

    def start(self, now: float, motion: Motion) -> None: ...

    def read(self, _now: float, _feedback: Feedback) -> tuple[Demand, Sequence[SourceEvent]]:
        events, self._events = self._events, []
        return {}, events

    def done(self, tick: Tick) -> bool:  # noqa: ARG002 - the device knows
        return not self._events and not self._waiting()


class BusyError(TeleopError):
    """Another thread moves the rig; one at a time may."""


class ProgramSource:
    """A source, and an observer of each tick. `submit`, `stop` and `clear` may be called from any thread.

    A job that is stopped or canceled is over only once every axis rests.
    """

    def __init__(self) -> None:
        self._lock = threading.RLock()  # reentrant: a signal handler may call `stop` in the thread that holds it
        self._job: Job | None = None
        self._observers: tuple[Observer, ...] = ()  # of the job in hand
        self._fresh = False  # the job has not begun yet
        self._ending: TeleopError | None = None  # what the job in hand ends with, once every axis rests
        self._finished = threading.Event()
        self._error: TeleopError | None = None
        self._over = False  # the run has ended: no job is taken any more
        self.stopped = False
        self.running = threading.Event()  # set by the first tick
        self.tick: Tick | None = None

    # --- for the program's threads

    def submit(self, job: Job, observers: Sequence[Observer] = ()) -> None:
        """Hand `job` over; `observers` see each tick until it ends.

        Raises StoppedError after a STOP for one that moves, BusyError while another job is in hand, DeviceError once
        the run has ended.
        """
        with self._lock:
            if self._over:
                raise DeviceError(f"the run has ended: {self._error or 'closed'}; open the rig again")
            if self.stopped and job.moves:
                raise StoppedError("STOPPED: call clear() first, then move again")
            if self._job is not None:
                raise BusyError("the rig is busy: another thread moves it; wait until it has finished, or call stop()")
            self._finished.clear()
            self._error = self._ending = None
            self._job, self._observers, self._fresh = job, tuple(observers), True

    @property
    def finished(self) -> bool:
        return self._finished.is_set()

    def wait(self) -> None:
        """Wait until the job in hand is complete or has failed."""
        self._finished.wait()

    def result(self) -> None:
        """Raise what the last job ended with, if it failed."""
        if self._error is not None:
            raise self._error

    def stop(self) -> None:
        """Latch a STOP, and end a job that moves with StoppedError."""
        with self._lock:
            self.stopped = True
            if self._job is not None and self._job.moves:
                self.cancel(StoppedError("STOPPED"))

    def cancel(self, error: TeleopError) -> bool:
        """End the job in hand with `error`, once every axis rests; whether there is one."""
        with self._lock:
            if self._job is not None and self._ending is None:
                self._ending = error
            return self._job is not None

    def clear(self) -> None:
        self.stopped = False

    def end(self, error: TeleopError) -> None:
        """The run is over: a job in hand ends with `error`."""
        with self._lock:
            self._over = True
            if self._job is not None or self._error is None:
                self._error = error
            self._job, self._observers = None, ()
        self.running.set()
        self._finished.set()

    # --- for the control thread

    def start(self, now: float, motion: Motion) -> None: ...  # jobs begin later

    def read(self, now: float, feedback: Feedback) -> tuple[Demand, Sequence[SourceEvent]]:
        with self._lock:
            job, fresh, ending = self._job, self._fresh, self._ending
            self._fresh = False
        stop: Demand = {axis: Stop() for axis in feedback.motion}
        if ending is not None or (job is not None and job.moves and self.stopped):
            return stop, ()
        rest = stop if self.stopped else {}
        if job is None:
            return rest, ()
        if fresh:
            job.start(now, feedback.motion)
        demand, events = job.read(now, feedback)
        return {**rest, **demand}, events

    def next_change(self, now: float) -> float:
        return now

    def observe(self, tick: Tick) -> None:
        self.tick = tick
        self.running.set()
        with self._lock:
            job, fresh, ending, observers = self._job, self._fresh, self._ending, self._observers
        for observer in observers:
            observer.observe(tick)
        if job is None or fresh:
            return
        if ending is not None:
            if all(not state.velocity and not state.acceleration for state in tick.motion.values()):
                self._finish(ending)
            return
        try:
            if job.done(tick):
                self._finish(None)
        except TeleopError as error:
            self._finish(error)

    def _finish(self, error: TeleopError | None) -> None:
        with self._lock:
            self._error = error
            self._job, self._observers, self._ending = None, (), None
        self._finished.set()

"""The tick: source -> planner -> sink, once per period, in one thread, until everything is at rest and given back.

Ticks lie on a grid of absolute times, so a late one does not delay the next; the planner is told how many periods
went by and makes one legal step of that length. While nothing moves and no source will change its mind, the loop
sleeps over ticks, but never past the keep-alive. Only this module decides what a fault means: whatever is raised
anywhere in a tick, by whomever, becomes a reason to ramp to rest, release and end with a result that is not DONE.
"""

from __future__ import annotations

import logging
import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any, Protocol

from teleop.motion import Act, Axis, Demand, Halt, Limits, Motion, Reading, State, Tick, Wish
from teleop.planner.stop import stop_state
from teleop.ports import Clock, DeviceError, Reporter, Sink, Source, TeleopError
from teleop.supervisor import Event, Run, Supervisor

RATE = 100  # Hz
PERIOD = 1 / RATE  # s
KEEP_ALIVE = 0.4  # s: the longest a resting loop sleeps; a gimbal forgets a speed after 0.5 s
STALL = 0.25  # s: a tick later than this was not lateness but a stall; the gimbal has long stopped following
FIRST_REPORT = 2.0  # s to wait for the first report of every axis in use
RELEASE_PATIENCE = 0.5  # s to keep trying to give a device back over a link that fails

log = logging.getLogger(__name__)


class Planner(Protocol):
    """Turns a demand into the next legal motion; `teleop.planner.live.Live`, or a fake of it."""

    @property
    def at_rest(self) -> bool: ...

    def reset(self, motion: Motion) -> None: ...

    def step(self, demand: Demand, dt_steps: int = 1) -> Mapping[Axis, State]: ...


class Loop:
    """One run of sources through a planner into sinks.

    `sources` stand in priority order: the first with an opinion on an axis drives it. `limits` has the axes in use;
    the run waits until each has been reported, and the planner starts from there.
    """

    def __init__(
        self,
        clock: Clock,
        planner: Planner,
        limits: Mapping[Axis, Limits],
        sources: Sequence[Source],
        sinks: Sequence[Sink],
        reporters: Sequence[Reporter],
    ) -> None:
        self.supervisor = Supervisor()
        self._clock, self._planner, self._limits = clock, planner, limits
        self._sources, self._sinks, self._reporters = sources, sinks, reporters
        self._origin = clock.now()
        self._ticks = 0
        self._resting = True
        self._wake = self._origin  # when a source will change its mind
        self._motion: Motion = {}
        self._reported: dict[Axis, Reading] = {}
        self._interrupt = ""
        self._planner_failed = False  # while stopping
        self._release_due = dict.fromkeys(range(len(sinks)), -math.inf)  # sink -> when its next step is
        self._release_end = math.inf
        self._turns: Mapping[Run, Callable[[float, int], None]] = {
            Run.WAITING: self._wait,
            Run.RUNNING: self._drive,
            Run.STOPPING: self._stop,
            Run.RELEASING: self._release,
        }

    def interrupt(self, reason: str) -> None:
        """Stop smoothly; safe to call from a signal handler or another thread, at any time, again and again."""
        self._interrupt = reason

    def run(self) -> Supervisor:
        """Turn until it is over. A fault is not raised: the supervisor returned has the result and the reasons."""
        while self.supervisor.state is not Run.OVER:
            try:
                time, steps = self._next_tick()
                if self._interrupt:
                    reason, self._interrupt = self._interrupt, ""
                    self.supervisor.happened(Event.INTERRUPT, reason)
                self._guarded(self._turns[self.supervisor.state], time, steps)
            except KeyboardInterrupt:
                self.interrupt("Ctrl-C")
        return self.supervisor

    def _next_tick(self) -> tuple[float, int]:
        """Sleep until the next tick that is needed: its time on the grid, and the periods the planner has to cover."""
        due = self._ticks + 1
        running = self.supervisor.state is Run.RUNNING
        if self._resting and running:
            wake = min(self._wake, self._time(self._ticks) + KEEP_ALIVE)
            due = max(due, math.ceil((wake - self._origin) * RATE - 1e-6))
        self._clock.sleep_until(self._time(due))
        late = self._clock.now() - self._time(due)
        elapsed = due - self._ticks + max(0, math.floor(late * RATE + 1e-6))
        self._ticks += elapsed
        if late > STALL and running:
            self._fault(TeleopError(f"the computer stalled for {late:.2f} s"))
            return self._time(self._ticks), 1
        return self._time(self._ticks), 1 if self._resting else elapsed

    def _time(self, ticks: int) -> float:
        return self._origin + ticks * PERIOD

    def _wait(self, now: float, _steps: int) -> None:
        self._report(now)
        if self.supervisor.state is not Run.WAITING:
            return
        missing = [axis for axis in self._limits if axis not in self._reported]
        if not missing:
            self._motion = {axis: State(self._reported[axis].position) for axis in self._limits}
            self._planner.reset(self._motion)
            for source in self._sources:
                source.start(now, self._motion)
            self._wake = now
            self.supervisor.happened(Event.REPORTED)
        elif now - self._origin > FIRST_REPORT:
            raise DeviceError(f"no position of {' or '.join(missing)} was reported within {FIRST_REPORT:g} s")

    def _drive(self, now: float, steps: int) -> None:
        demand: dict[Axis, Wish] = {}
        actions: list[Act] = []
        for source in reversed(self._sources):
            wishes, due = source.read(now)
            demand.update(wishes)
            actions.extend(due)
        self._motion = self._planner.step(demand, steps)
        self._resting = self._planner.at_rest
        self._wake = min(source.next_change(now) for source in self._sources)
        self._emit(now, demand, actions)
        if self._resting and math.isinf(self._wake) and self.supervisor.state is Run.RUNNING:
            self.supervisor.happened(Event.FINISHED)

    def _stop(self, now: float, steps: int) -> None:
        """Ramp to rest; once even the planner has failed, by the closed form alone, from what was last sent."""
        demand: Demand = {axis: Halt() for axis in self._limits}
        motion = None if self._planner_failed else self._guarded(self._planner.step, demand, steps)
        if motion is None:
            self._planner_failed = True
            motion = {axis: self._braked(axis, steps * PERIOD) for axis in self._motion}
        self._motion = motion
        self._emit(now, demand, ())
        if all(state.velocity == 0 and state.acceleration == 0 for state in motion.values()):
            self.supervisor.happened(Event.AT_REST)

    def _braked(self, axis: Axis, seconds: float) -> State:
        limits = self._limits[axis]
        return stop_state(self._motion[axis], limits.acceleration, limits.jerk, seconds)

    def _release(self, now: float, _steps: int) -> None:
        """Each sink's own steps at its own times; one that fails is tried again until patience ends."""
        failed = object()
        self._release_end = min(self._release_end, now + RELEASE_PATIENCE)
        for index, due in list(self._release_due.items()):
            if now < due - PERIOD / 2:
                continue
            again = self._guarded(self._sinks[index].release, now, default=failed)
            if again is failed and now < self._release_end:
                again = now + PERIOD
            if again is None or again is failed:
                del self._release_due[index]
            else:
                self._release_due[index] = again
        if not self._release_due:
            self.supervisor.happened(Event.RELEASED)

    def _report(self, now: float) -> None:
        for reporter in self._reporters:
            self._reported.update(self._guarded(reporter.report, now, default={}))

    def _emit(self, now: float, demand: Demand, actions: Sequence[Act]) -> None:
        self._report(now)
        tick = Tick(now, self._motion, demand, actions, dict(self._reported))
        for sink in self._sinks:
            self._guarded(sink.write, tick)

    def _guarded(self, call: Callable[..., Any], *arguments: Any, default: Any = None) -> Any:
        """Whatever goes wrong in `call` becomes a fault, so that the other sinks are still served and the run stops."""
        try:
            return call(*arguments)
        except Exception as fault:  # noqa: BLE001 - the one place where any exception is turned into a smooth stop
            self._fault(fault)
            return default

    def _fault(self, fault: Exception) -> None:
        reason = str(fault) if isinstance(fault, TeleopError) else f"{type(fault).__name__}: {fault}"
        log.debug("fault: %s", reason, exc_info=fault)
        self.supervisor.happened(Event.FAULT, reason)

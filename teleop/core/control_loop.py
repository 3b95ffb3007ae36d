"""The tick: source -> planner -> sink, once per period, in one thread, until everything is at rest and given back.

Ticks lie on a grid of absolute times, so a late one does not delay the next; the planner gets the number of periods
went by and makes one legal step of that length. While nothing moves and no source will change its mind, the loop
sleeps over ticks, but never past the keep-alive; there the grid may be moved, for a start that several rigs have in
common. Only this module decides what a fault means: whatever is raised
anywhere in a tick, by whomever, becomes a reason to ramp to rest, release and end with a result that is not DONE.
Nothing a piece does can keep a run from ending: stopping and releasing (`releasing`) have their own longest times, and
a LeaveAtOnce, which a signal handler may raise out of a call that hangs, ends both.

A tick is prepared a little before its moment (LEAD) and its commands leave at the moment itself: how long reading,
planning and reporting took, which varies, then does not show in their spacing.

After a stall the planner no longer knows where the axes are (`whereabouts`): the ramp to rest then starts from what
two fresh readings say, and nothing is commanded before they are in. An axis that no reading is found of gets no command
at all: the devices are released as they are.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence

from teleop.core.axes import Axis, Limits, Motion, Reading, State
from teleop.core.errors import DeviceError, LeaveAtOnce, TeleopError
from teleop.core.events import Tick, TickAt, TickEvent
from teleop.core.guard_stop import braked, longest_stop
from teleop.core.guarded_calls import GuardedCalls
from teleop.core.interfaces import Clock, Feedback, Observer, Planner, Reporter, Sink, Source
from teleop.core.run_state import RunEvent, RunState, RunStateMachine
from teleop.core.setpoints import Demand, Setpoint, Stop
from teleop.core.shutdown import Shutdown
from teleop.core.stall_recovery import READINGS_TIMEOUT, StallRecovery
from teleop.core.timing import DEFAULTS, LoopTiming

LEAD = 0.002  # s before its moment a tick is prepared, so that commands leave evenly however long they took to make
ON_GRID = 1e-3  # of a tick: so near is on it; floats are off by a hundredth of that after thirty years of uptime
STALL = 0.25  # s: a tick later than this was not lateness but a stall; the gimbal has long stopped following
STOP_SHARE, STOP_EXTRA = 2.0, 1.0  # a planner has so many times the fastest stop, and so many s, to come to rest
AT_ONCE = 0.4  # s for releasing every device without a ramp: three zero speeds, release, and the reply
STOP_SLACK = 1.0  # s beyond all of these after which the run no longer waits for rest


class StallError(TeleopError):
    """The computer did something else for so long that nothing is where it should be."""


class ControlLoop:
    """One run of sources through a planner into sinks.

    `sources` are in priority order: the first that demands something of an axis drives it. `limits` has the axes in
    use; the run waits until each has been reported, and the planner starts from there. The planner's step has to be
    `timing.period`. `observers` see each tick after every sink has had it.
    """

    def __init__(
        self,
        clock: Clock,
        planner: Planner,
        limits: Mapping[Axis, Limits],
        sources: Sequence[Source],
        sinks: Sequence[Sink],
        reporters: Sequence[Reporter],
        observers: Sequence[Observer] = (),
        timing: LoopTiming = DEFAULTS,
    ) -> None:
        self.supervisor = RunStateMachine()
        self._calls = GuardedCalls(self.supervisor, self.interrupt)
        self.faults = self._calls.faults
        self._clock, self._planner, self._limits = clock, planner, limits
        self._sources, self._sinks, self._reporters = sources, sinks, reporters
        self._observers, self._timing = observers, timing
        self._rate = timing.rate  # kept: it is asked for several times a tick
        self._origin = clock.now()
        self._ticks = 0
        self._resting = True
        self._wake = self._origin  # when a source will change its mind
        self._motion: Motion = {}
        self._reported: Mapping[Axis, Reading] = {}
        self._interrupt = ""
        self._planner_failed = False  # while stopping
        self._stop_end = self._stop_limit = math.inf
        self._lost: StallRecovery | None = None  # since a stall, until they are found
        self._giving_back = Shutdown(sinks, timing.period)
        self._turns: Mapping[RunState, Callable[[float, int], None]] = {
            RunState.WAITING: self._wait,
            RunState.RUNNING: self._drive,
            RunState.STOPPING: self._stop,
            RunState.RELEASING: self._release,
        }

    def interrupt(self, reason: str) -> None:
        """Stop smoothly; safe to call from a signal handler or another thread, at any time, again and again."""
        self._interrupt = reason

    def run(self) -> RunStateMachine:
        """Turn until it is over. A fault is not raised: the supervisor returned has the result and the reasons.

        Raises LeaveAtOnce where a signal handler does, after one attempt to release every device.
        """
        while self.supervisor.state is not RunState.OVER:
            try:
                self.turn()
            except KeyboardInterrupt:  # without a signal handler it may come between any two lines
                self.interrupt("Ctrl-C")
            except LeaveAtOnce:
                self.release_at_once()
                raise
        return self.supervisor

    def release_at_once(self) -> None:
        """One attempt to release every device, without a ramp; takes AT_ONCE at most, unless a device hangs.

        Safe to call from another thread: a step that is under way in the control thread is left to it.
        """
        now = self._calls.quietly(self._clock.now, default=self._time(self._ticks))
        end = now + AT_ONCE
        while now < end and not self._giving_back.once(now, self._calls.quietly):
            self._calls.quietly(self._clock.sleep_until, now + self._timing.period)
            now = max(now + self._timing.period, self._calls.quietly(self._clock.now, default=now))
            for reporter in self._reporters:  # what the links hold back leaves, and answers come in
                self._calls.quietly(reporter.report, now)

    def turn(self) -> None:
        """One tick, the wait for it included; `run` does this until the run is over."""
        tick = self._calls.guarded(self._next_tick)
        if tick is None:  # even the clock may fail; the run comes to its end all the same
            self._ticks += 1
            tick = self._time(self._ticks), 1
        self._take_interrupt()
        self._calls.guarded(self._turns[self.supervisor.state], *tick)
        if self.supervisor.state is RunState.STOPPING:
            self._limit_stopping(tick[0])

    def _take_interrupt(self) -> None:
        if self._interrupt:
            reason, self._interrupt = self._interrupt, ""
            self.supervisor.handle(RunEvent.INTERRUPT, reason)

    def _next_tick(self) -> tuple[float, int]:
        """Sleep until the next tick that is needed: its time on the grid, and the periods the planner has to cover."""
        due = self._ticks + 1
        running = self.supervisor.state is RunState.RUNNING
        if self._resting and running:
            wake = min(self._wake, self._time(self._ticks) + self._timing.keep_alive)
            due = max(due, math.ceil((wake - self._origin) * self._rate - ON_GRID))
        early = self._time(due) - LEAD
        self._clock.sleep_until(early)
        late = self._clock.now() - early
        elapsed = due - self._ticks + max(0, math.floor(late * self._rate + ON_GRID))
        self._ticks += elapsed
        if late > STALL and self.supervisor.state in (RunState.RUNNING, RunState.STOPPING):
            self._calls.fault(StallError(f"the computer stalled for {late:.2f} s"))
            measured = {axis: state for axis, state in self._motion.items() if not axis.is_stick}
            self._lost = StallRecovery(measured, self._time(self._ticks))
            return self._time(self._ticks), 1
        return self._time(self._ticks), 1 if self._resting else elapsed

    def _time(self, ticks: int) -> float:
        return self._origin + ticks / self._rate

    def _move_ticks_to(self, moment: float) -> None:
        """Have a tick at the moment: the next one, and with it all, comes up to a period later."""
        ahead = (moment - self._origin) * self._rate
        part = ahead - math.floor(ahead)
        if ON_GRID < part < 1 - ON_GRID:
            self._origin += part / self._rate

    def _wait(self, now: float, _steps: int) -> None:
        self._report(now)
        if self.supervisor.state is not RunState.WAITING:
            return
        missing = [axis for axis in self._limits if axis not in self._reported]
        if not missing:
            self._motion = {axis: State(self._reported[axis].position) for axis in self._limits}
            self._planner.reset(self._motion)
            for source in self._sources:
                source.start(now, self._motion)
            self._wake = now
            self.supervisor.handle(RunEvent.REPORTED)
        elif now - self._origin > self._timing.first_report:
            seconds = self._timing.first_report
            raise DeviceError(f"no position of {' or '.join(missing)} was reported within {seconds:g} s")

    def _drive(self, now: float, steps: int) -> None:
        asked = self._calls.guarded(self._ask, now)
        if asked is None:  # a source has failed: the ramp to rest begins in this tick
            self._take_interrupt()
            self._stop(now, steps)
            return
        demand, events, moments = asked
        self._motion = _finite(self._planner.step(demand, steps))
        self._resting = self._planner.at_rest
        self._wake = min(source.next_change(now) for source in self._sources)
        self._emit(now, demand, events)
        if self._resting and moments:
            self._move_ticks_to(moments[0])
        if self._resting and math.isinf(self._wake) and self.supervisor.state is RunState.RUNNING:
            self.supervisor.handle(RunEvent.FINISHED)

    def _ask(self, now: float) -> tuple[Demand, Sequence[TickEvent], Sequence[float]]:
        """What the sources demand for this tick, and what is due; when they want a tick to be.

        Of two that demand something of an axis, the first is heard.
        """
        demand: dict[Axis, Setpoint] = {}
        events: list[TickEvent] = []
        moments: list[float] = []
        feedback = Feedback(self._motion, self._reported)
        for source in reversed(self._sources):
            setpoints, due = source.read(now, feedback)
            demand.update(setpoints)
            for event in due:
                if isinstance(event, TickAt):
                    moments.append(event.time)
                else:
                    events.append(event)
        return demand, events, moments

    def _stop(self, now: float, steps: int) -> None:
        """Ramp to rest; once even the planner has failed, by the closed form alone, from what was last sent."""
        if self._lost and not self._find(now):
            return
        if self.supervisor.state is not RunState.STOPPING:
            return
        if math.isinf(self._stop_end):
            self._stop_end = now + STOP_EXTRA + STOP_SHARE * longest_stop(self._motion, self._limits)
        self._planner_failed |= now > self._stop_end
        demand: Demand = {axis: Stop() for axis in self._limits}
        motion = None if self._planner_failed else self._calls.guarded(self._halted, demand, steps)
        if motion is None:
            self._planner_failed = True
            motion = braked(self._motion, self._limits, steps * self._timing.period)
        self._motion = motion
        self._emit(now, demand, ())
        if all(state.velocity == 0 and state.acceleration == 0 for state in motion.values()):
            self.supervisor.handle(RunEvent.AT_REST)

    def _halted(self, demand: Demand, steps: int) -> Motion:
        return _finite(self._planner.step(demand, steps))

    def _find(self, now: float) -> bool:
        """Whether the axes that moved before the stall are found: the planner then goes on from there."""
        self._report(now)
        if self._lost is None or not self._lost.known(now, self._reported):
            return self._lost is None
        lost, self._lost = self._lost, None
        for axis, here in lost.found(now).items():
            self._motion = {**self._motion, axis: here}
            self._planner_failed |= self._calls.guarded(self._planner.reset, {axis: here}, default=self) is self
        if lost.read_once:
            self._calls.fault(DeviceError(f"{_measured(lost.read_once)} only once since the stall: held there"))
        if lost.unread:
            self._calls.fault(
                DeviceError(f"no position of {' or '.join(lost.unread)} since the stall: released without a ramp")
            )
            self.supervisor.handle(RunEvent.AT_REST)
        return True

    def _limit_stopping(self, now: float) -> None:
        """Stopping has a longest time, whatever keeps failing or stalling; after it the devices are released."""
        if math.isinf(self._stop_limit):
            ramp = self._calls.guarded(longest_stop, self._motion, self._limits, default=0.0)
            self._stop_limit = now + READINGS_TIMEOUT + STOP_EXTRA + (STOP_SHARE + 1) * ramp + STOP_SLACK
        elif not now <= self._stop_limit:
            self._calls.fault(DeviceError("the axes did not come to rest in time: released as they are"))
            self.supervisor.handle(RunEvent.AT_REST)

    def _release(self, now: float, _steps: int) -> None:
        """Reports go on meanwhile: what the links still hold back leaves, and the sinks hear what is answered."""
        self._report(now)
        if self._giving_back.step(now, self._calls.guarded):
            self.supervisor.handle(RunEvent.RELEASED)

    def _report(self, now: float) -> None:
        """Where the axes are, asked while the tick of `now` is prepared; a tick that is late asks late."""
        for reporter in self._reporters:
            asked = max(now - LEAD, self._calls.guarded(self._clock.now, default=now))
            self._reported = {**self._reported, **self._calls.guarded(reporter.report, asked, default={})}

    def _emit(self, now: float, demand: Demand, actions: Sequence[TickEvent]) -> None:
        self._report(now)
        tick = Tick(now, self._motion, demand, actions, self._reported)
        if self._calls.guarded(self._missed, now):
            return  # too late to send; the next tick finds that the computer stalled
        for sink in self._sinks:
            self._calls.guarded(sink.write, tick)
        for observer in self._observers:
            self._calls.guarded(observer.observe, tick)

    def _missed(self, now: float) -> bool:
        """Wait for the moment of a tick that is prepared; whether it is long past."""
        self._clock.sleep_until(now)
        return self._clock.now() - now > STALL


def _finite(motion: Mapping[Axis, State]) -> Motion:
    """The planner's word, if it is one of numbers: what is not would pass every comparison with a limit."""
    for axis, state in motion.items():
        if not math.isfinite(sum(state)):
            raise ArithmeticError(f"the planner has {axis} at {state.position}, {state.velocity}, {state.acceleration}")
    return motion


def _measured(axes: Sequence[Axis]) -> str:
    return f"{' and '.join(axes)} {'was' if len(axes) == 1 else 'were'} measured"

"""Performs a compiled move: eases to its start, waits the preroll and the trigger, follows it on the loop's clock.

What it does is a phase of the table in `phases`; `_on_due` has what ends each one. Nothing else is decided on the way:
each ease is planned when the axes rest where it begins, and from there on the source only looks up where the axes are
to be, at the speed that `Playback` keeps. Every phase begins on a whole hundredth of a second, which is a tick, so that
keyframes are met and not just passed between two ticks.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Executor

from teleop.core.axes import Axis, Limits, Motion, State
from teleop.core.errors import DeviceError
from teleop.core.events import SourceEvent, TickAt
from teleop.core.interfaces import Feedback
from teleop.core.setpoints import Demand, StateTarget
from teleop.core.timing import KEEP_ALIVE, SAME_TIME, whole_ticks
from teleop.planner.rest_to_rest import rest_to_rest
from teleop.planner.trajectory import Move
from teleop.sequence.compile import CompiledSequence
from teleop.sequence.cues import Cue, Wait, cues_from
from teleop.sequence.cycle import Cycle, Trigger
from teleop.sequence.phases import BEFORE_THE_MOVE, TIMED, TRANSITIONS, PhaseEvent, SequencePhase
from teleop.sequence.playback import Playback

EASE_SHARE = 0.5  # of each axis's velocity, acceleration and jerk: on the way to the start nothing is in a hurry
RHYTHM = 0.2  # s: corrected passes begin so far apart that what is asked at a rate is asked at the same places again


class SequenceSource:
    """`limits` are the axes', for the eases and for changes of speed.

    `speed` is the share of the speed that the sequence was written for; PlanError says when the move does not allow it.
    `executor` searches for changes of it, a thread unless given. Without a `cycle` it is the sequence's own.
    `begin` is when the first pass starts, on the loop's clock, and inf until that is known; `number` is that of the
    pass, from 1. `rest_needed` is asked how long (s) the axes have to rest at the start of the first pass at least.
    """

    def __init__(
        self,
        compiled: CompiledSequence,
        limits: Mapping[Axis, Limits],
        speed: float = 1.0,
        executor: Executor | None = None,
        cycle: Cycle | None = None,
    ) -> None:
        self.cycle = cycle or Cycle(compiled.preroll, back_to_one=compiled.back_to_one)
        self.rest_needed: Callable[[], float] = lambda: 0.0
        self._rest = 0.0  # s, what it said
        self.duration = compiled.duration
        self.moves_drone = any(axis.is_stick for axis in compiled.move.tracks)
        corrector = self.cycle.corrector
        known = None if corrector is None else corrector.next_move()
        self.move = compiled.move if known is None else known  # what this pass plays
        self._last_cue = max((cue.at for cue in compiled.cues), default=0.0)
        self._limits = {axis: limits[axis] for axis in self.move.tracks}
        self.key_times = sorted({key.at for of_axis in compiled.keys.values() for key in of_axis})
        self.playback = Playback(self.move, limits, speed, self.key_times, executor, self.cycle.start_at)
        self._settings, self.all_cues = cues_from(compiled.cues, self.cycle.start_at)
        self.cues: list[Cue] = []  # still to come in this pass
        self._ease, self._ease_begin = Move({}), math.inf
        self.until = math.inf  # when the phase is over, if that is known
        self._events: list[SourceEvent] = []
        self._go_pressed = False
        self._prepared = 0  # the last pass for which the settings were made
        self.missed = ""  # why the trigger can no longer come: it was due while the run was stopped
        self._suspended = False
        self.waiting = False  # for the operator, in the middle of the move
        self._began = math.inf  # when this pass did
        self._origin = 0.0  # when the run did
        self.phase = SequencePhase.EASING
        self.begin = math.inf
        self.number = 1
        self._on_due: Mapping[SequencePhase, Callable[[float], None]] = {
            SequencePhase.EASING: self._arrive,
            SequencePhase.PREROLL: self._arm_or_start,
            SequencePhase.ARMED: self._start_if_triggered,
            SequencePhase.PLAYING: lambda _now: None,  # the move's own time ends it, see `_follow`
            SequencePhase.REJOINING: self._rejoin,
            SequencePhase.RETURNING: lambda _now: self._handle(PhaseEvent.ARRIVED),
            SequencePhase.OVER: lambda _now: None,
        }

    def start(self, now: float, motion: Motion) -> None:
        self._origin, self._rest = now, self.rest_needed()
        self.phase = SequencePhase.EASING
        self._ease_to_time(self.playback.opening, now, motion)
        self._foresee_begin()

    def read(self, now: float, _feedback: Feedback) -> tuple[Demand, Sequence[SourceEvent]]:
        self._events = []
        self._advance(now)
        if self.waiting and self._go_pressed:
            self.waiting = self._go_pressed = False
            self.playback.go(now)
        ended_on_path = self.phase is SequencePhase.OVER and not self.cycle.back_to_one
        on_path = self.phase is SequencePhase.PLAYING or ended_on_path
        motion = self._follow(now) if on_path else self._ease.at(now - self._ease_begin)
        return {axis: StateTarget(*state) for axis, state in motion.items()}, self._events

    def foreseen(self, time: float) -> Motion:
        """Where the axes will be at a `time` soon, on the loop's clock, if nothing is asked for meanwhile."""
        if self.phase in (SequencePhase.PLAYING, SequencePhase.OVER):
            back = self.phase is SequencePhase.OVER and self.cycle.back_to_one
            return self._ease.at(time - self._ease_begin) if back else self.playback.foreseen(time)
        if self.phase in BEFORE_THE_MOVE and time > (begin := self._next_start()):
            return self.playback.foreseen(time, begin)
        return self._ease.at(time - self._ease_begin)

    def next_change(self, now: float) -> float:
        if self.phase is SequencePhase.OVER:
            return math.inf
        if self.cycle.corrector is not None:  # a gimbal that drifts must be held, and measured, at rest too
            return now
        if self.phase is SequencePhase.PREROLL:
            quiet = self.until - KEEP_ALIVE
            return quiet if self.cycle.compared and now < quiet - SAME_TIME else self.until
        if self.phase is not SequencePhase.PLAYING or self.playback.changing(now):
            return now
        coming = min(self.move.next_motion(self.playback.time(now)), self.cues[0].at if self.cues else math.inf)
        return self.playback.when(min(coming, self._end), now)

    def suspend(self, now: float) -> None:
        """The axes are stopped from `now` on, off the path; the move's own time stands still."""
        self._suspended = True
        if self.phase is SequencePhase.PLAYING:
            self.playback.freeze(now)
        elif self.number == 1 and self.phase in BEFORE_THE_MOVE:
            self.begin = math.inf

    def resume(self, now: float, motion: Motion) -> None:
        """Continue from rest at `motion`: back to the path and along it, or with the ease that was stopped."""
        if self.phase is SequencePhase.OVER:
            return
        self._handle(PhaseEvent.RESUME)
        if self.phase is SequencePhase.REJOINING:
            self._ease_to(self.playback.at(now)[1], now, motion)
        else:
            self._ease_to_time(
                self.move.opening if self.phase is SequencePhase.RETURNING else self.playback.opening, now, motion
            )
        if self.phase is SequencePhase.EASING and self.number == 1:
            self._foresee_begin()

    def place(self, time: float) -> tuple[int, float] | None:
        """The pass, and the move's own time, at a time of the pass that is played; None while none is."""
        if self.phase is not SequencePhase.PLAYING or time < self._began - SAME_TIME:
            return None
        return self.number, self.playback.time(time)

    def go(self) -> None:
        """The operator starts a move that waits for its trigger, or continues one that waits in its middle."""
        self._go_pressed = self.waiting or self.phase is SequencePhase.ARMED

    @property
    def _end(self) -> float:
        """When a pass is over, in the move's own time: a corrected one comes to rest later."""
        return max(self.move.duration, self._last_cue)

    def _handle(self, event: PhaseEvent) -> None:
        self.phase = TRANSITIONS[self.phase, event]

    def _advance(self, now: float) -> None:
        """End the phases that are due by `now`; one tick may end several."""
        before = None
        while self.phase is not before and (self.phase not in TIMED or now > self.until - SAME_TIME):
            before = self.phase
            self._on_due[self.phase](now)

    def _arrive(self, _now: float) -> None:
        self._handle(PhaseEvent.ARRIVED)
        self._rest = max(self._rest, self.rest_needed())  # what was thought of the axes may have been wrong
        self.until = self._after_preroll(self.until)
        if self.number == 1 and self.cycle.trigger is None:
            self.begin = self.until + self.lead
        if self._prepared < self.number:
            self._events += self._settings
            self._prepared = self.number

    def _arm_or_start(self, now: float) -> None:
        if not self._is_corrected():
            self.until = now + KEEP_ALIVE
            return
        trigger = self.cycle.trigger
        if trigger is None or (self.number > 1 and (self.cycle.endless or not trigger.again)):
            self._start_pass(self.until)
            return
        self._arm(trigger, now)
        if self.missed and not self._suspended:
            raise DeviceError(self.missed)
        self._go_pressed = False
        self._handle(PhaseEvent.ARM)

    def _arm(self, trigger: Trigger, now: float) -> None:
        try:
            trigger.arm(now)
            self.missed = ""
        except DeviceError as error:
            self.missed = str(error)

    def _is_corrected(self) -> bool:
        """Whether what this pass plays is known."""
        move = self.move if self.cycle.corrector is None else self.cycle.corrector.next_move()
        if move is not None and move is not self.move:
            self.move = move
            self.playback.replace(move)
        return move is not None

    def _start_if_triggered(self, now: float) -> None:
        trigger = self.cycle.trigger
        if trigger and self.missed:  # it may come once more: a clock that is set back is not there yet
            self._arm(trigger, now)
        if self._go_pressed:
            self._start_pass(now)
        elif trigger and not self.missed and trigger.fired(now):
            self._start_pass(min(now, self.cycle.moment))
        elif trigger and now < self.cycle.moment < math.inf:
            self._events.append(TickAt(self.cycle.moment))

    def _start_pass(self, now: float) -> None:
        self._handle(PhaseEvent.START)
        self.cues = list(self.all_cues)
        self._go_pressed = self.waiting = False
        self.playback.begin(now)
        self._began = now
        if self.number == 1:
            self.begin = now + self.lead

    def _rejoin(self, now: float) -> None:
        self._handle(PhaseEvent.ARRIVED)
        if not self.waiting:
            self.playback.resume(now)

    def _follow(self, now: float) -> Motion:
        """Where the move is at `now`, with the cues that are due; it may end there."""
        elapsed, motion = self.playback.at(now)
        while self.cues and not self.waiting and self.cues[0].at <= elapsed + SAME_TIME:
            cue = self.cues.pop(0)
            if isinstance(cue.action, Wait):
                self.waiting = True
                elapsed, motion = self.playback.hold(cue.at, now)
            else:
                self._events.append(cue.action)
        ended = elapsed > self._end - SAME_TIME and not self.playback.paused
        if self.phase is SequencePhase.PLAYING and ended:
            self._end_pass(now, motion)
        return motion

    def _end_pass(self, now: float, motion: Motion) -> None:
        """A pass is over: another one, back to one, or the end."""
        if self.cycle.corrector is not None:
            self.cycle.corrector.ended(self.number)
        if self.number < self.cycle.passes:
            self.number += 1
            self.playback.rewind()
            self._handle(PhaseEvent.NEXT_PASS)
            self._ease_to_time(self.playback.opening, now, motion)
        elif self.cycle.back_to_one:
            self._handle(PhaseEvent.BACK_TO_ONE)
            self._ease_to_time(self.move.opening, now, motion)
        else:
            self._handle(PhaseEvent.END)

    def _ease_to_time(self, time: float, now: float, motion: Motion) -> None:
        """To where the move is at its own `time`, from rest where the axes are."""
        self._ease_to({axis: State(row[0]) for axis, row in self.move.at(time).items()}, now, motion)

    def ease_time(self, motion: Motion) -> float:
        """How long the way from rest at `motion` to where the move begins takes, in s."""
        return whole_ticks(self._eased(self.move.at(self.playback.opening), motion).duration)

    def _eased(self, target: Motion, motion: Motion) -> Move:
        positions = {axis: state.position for axis, state in target.items()}
        return rest_to_rest({axis: motion[axis] for axis in positions}, positions, self._limits, EASE_SHARE)

    def _ease_to(self, target: Motion, now: float, motion: Motion) -> None:
        self._ease = self._eased(target, motion)
        self._ease_begin, self.until = now, now + whole_ticks(self._ease.duration)

    def _foresee_begin(self) -> None:
        if self.cycle.trigger is None:
            self.begin = self._after_preroll(self.until) + self.lead

    def _next_start(self) -> float:
        """When the pass will begin as far as is known before it does, else inf."""
        if self.cycle.trigger is not None:
            return self.cycle.moment
        return self.until if self.phase is SequencePhase.PREROLL else self._after_preroll(self.until)

    @property
    def lead(self) -> float:
        """How long after the start of a pass the move's own zero is, in s."""
        return 0.0 if self.cycle.start_at else -self.move.opening

    def _after_preroll(self, arrival: float) -> float:
        """When a pass may begin whose axes arrive then where it begins."""
        if self.number > 1 and self.cycle.endless:
            return arrival
        needed = self._rest if self.number == 1 and self.cycle.trigger is None else 0.0  # a trigger is to be awaited
        least = KEEP_ALIVE if self.cycle.compared else 0.0
        start = arrival + max(whole_ticks(max(self.cycle.preroll, needed)), least)
        if self.cycle.corrector is None:
            return start
        return self._origin + RHYTHM * math.ceil((start - self._origin) / RHYTHM - SAME_TIME)

"""Performs a compiled move: eases to its start, waits the preroll and the trigger, follows it on the loop's clock.

Nothing is decided on the way: each ease is compiled when the axes rest where it begins, and from there on the source
only looks up where the axes have to be, at the pace that `Playback` keeps. Everything begins on a whole hundredth of a
second, which is a tick, so that keyframes are met and not just passed between two ticks.
"""

from __future__ import annotations

import math
from bisect import bisect_right
from collections.abc import Mapping, Sequence
from concurrent.futures import Executor
from enum import Enum, auto

from teleop.core.axes import Axis, Limits, Motion, State
from teleop.core.errors import DeviceError
from teleop.core.events import Action, DeviceCommand, TickEvent
from teleop.core.interfaces import Feedback
from teleop.core.run_status import NextCue, NextKey, RunStatus
from teleop.core.setpoints import Demand, StateTarget
from teleop.core.timing import KEEP_ALIVE
from teleop.planner.rest_to_rest import rest_to_rest
from teleop.planner.trajectory import Move
from teleop.sequence.compile import CompiledSequence
from teleop.sequence.cues import Cue, Wait
from teleop.sequence.cycle import Cycle, Trigger
from teleop.sequence.playback import Playback

LASTING = ((Action.RECORD, Action.STOP), (Action.FOCUS, Action.END_FOCUS))  # what begins it, and ends it
EASE_SHARE = 0.5  # of each axis's velocity, acceleration and jerk: on the way to the start nothing is in a hurry
_INSTANT = 1e-6  # s: two times on the loop's grid that are closer are the same


class SequencePhase(Enum):
    EASING = auto()  # to where the move begins
    PREROLL = auto()
    ARMED = auto()  # for the trigger
    PLAYING = auto()
    REJOINING = auto()  # back to the path, after a STOP
    RETURNING = auto()  # back to one
    OVER = auto()


class SequenceSource:
    """`limits` are the axes', for the eases and for changes of speed.

    `speed` is the share of the speed that the sequence was written for; PlanError says when the move does not allow it.
    `executor` searches for changes of it, a thread unless given. Without a `staging` it is the performance's own.
    `begin` is when the first pass starts, on the loop's clock, and inf until that is known; `number` is that of the
    pass, from 1.
    """

    def __init__(
        self,
        performance: CompiledSequence,
        limits: Mapping[Axis, Limits],
        speed: float = 1.0,
        executor: Executor | None = None,
        staging: Cycle | None = None,
    ) -> None:
        self.staging = staging or Cycle(performance.preroll, back_to_one=performance.back_to_one)
        self.duration = performance.duration
        self.flies = any(axis.is_stick for axis in performance.move.tracks)
        self._move = performance.move
        self._limits = {axis: limits[axis] for axis in self._move.tracks}
        self._key_times = sorted({key.at for of_axis in performance.keys.values() for key in of_axis})
        self.playback = Playback(self._move, limits, speed, self._key_times, executor, self.staging.start_at)
        self._settings, self._score = cues_from(performance.cues, self.staging.start_at)
        self._cues: list[Cue] = []  # still to come in this pass
        self._way = Move({})  # what is eased along
        self._way_begin = self._until = math.inf  # and when the phase is over, unless that is not known
        self._gone = False  # the operator said go
        self._prepared = 0  # the pass for which the settings have been made
        self.missed = ""  # why the trigger can no longer come: it went by while the run was stopped
        self._suspended = False
        self.waiting = False  # for that, in the middle of the move
        self._began = math.inf  # when this pass did
        self.phase = SequencePhase.EASING
        self.begin = math.inf
        self.number = 1

    def start(self, now: float, motion: Motion) -> None:
        self._ease(SequencePhase.EASING, now, motion, self.playback.opening)
        if self.staging.trigger is None:
            self.begin = self._after_preroll(self._until)

    def read(self, now: float, _feedback: Feedback) -> tuple[Demand, Sequence[TickEvent]]:
        due: list[TickEvent] = self._turn(now)
        if self.waiting and self._gone:
            self.waiting = self._gone = False
            self.playback.go(now)
        if self.phase is SequencePhase.PLAYING or (self.phase is SequencePhase.OVER and not self.staging.back_to_one):
            elapsed, motion = self.playback.at(now)
            while self._cues and not self.waiting and self._cues[0].at <= elapsed + _INSTANT:
                cue = self._cues.pop(0)
                if isinstance(cue.action, Wait):
                    self.waiting = True
                    elapsed, motion = self.playback.hold(cue.at, now)
                else:
                    due.append(cue.action)
            if self.phase is SequencePhase.PLAYING and elapsed > self.duration - _INSTANT and not self.playback.paused:
                self._played(now, motion)
        else:
            motion = self._way.at(now - self._way_begin)
        return {axis: StateTarget(*state) for axis, state in motion.items()}, due

    def next_change(self, now: float) -> float:
        if self.phase is SequencePhase.OVER:
            return math.inf
        if self.phase is SequencePhase.PREROLL:
            hush = self._until - KEEP_ALIVE
            return hush if self.staging.compared and now < hush - _INSTANT else self._until
        if self.phase is not SequencePhase.PLAYING or self.playback.changing(now):
            return now
        coming = min(self._move.next_motion(self.playback.time(now)), self._cues[0].at if self._cues else math.inf)
        return self.playback.when(min(coming, self.duration), now)

    @property
    def travels(self) -> bool:
        """Whether it is on the move itself, and not on a way to it or from it."""
        return self.phase is SequencePhase.PLAYING

    def suspend(self, now: float) -> None:
        """The axes are stopped from `now` on, off the path; the move stands still where it is."""
        self._suspended = True
        if self.phase is SequencePhase.PLAYING:
            self.playback.freeze(now)
        elif self.number == 1 and self.phase in (SequencePhase.EASING, SequencePhase.PREROLL, SequencePhase.ARMED):
            self.begin = math.inf

    def resume(self, now: float, motion: Motion) -> None:
        """On from rest at `motion`: back to the path and along it, or whatever else was stopped, anew."""
        match self.phase:
            case SequencePhase.PLAYING | SequencePhase.REJOINING:
                self._ease_to(SequencePhase.REJOINING, now, motion, self.playback.at(now)[1])
            case SequencePhase.RETURNING:
                self._ease(SequencePhase.RETURNING, now, motion, 0.0)
            case SequencePhase.EASING | SequencePhase.PREROLL | SequencePhase.ARMED:
                self._ease(SequencePhase.EASING, now, motion, self.playback.opening)
                if self.number == 1 and self.staging.trigger is None:
                    self.begin = self._after_preroll(self._until)

    def place(self, time: float) -> tuple[int, float] | None:
        """Which pass it is in, and where in the move, at a time of the pass that is played; None while none is."""
        if self.phase is not SequencePhase.PLAYING or time < self._began - _INSTANT:
            return None
        return self.number, self.playback.time(time)

    def go(self) -> None:
        """The operator's word, for a move that waits for its trigger, or in its middle."""
        self._gone = self.waiting or self.phase is SequencePhase.ARMED

    def said(self, now: float) -> str:
        """What it is doing at `now`, in a few words, and how far that is."""
        left = max(0.0, self._until - now)
        match self.phase:
            case SequencePhase.EASING:
                return f"to the start {left:4.1f} s"
            case SequencePhase.PREROLL:
                return f"starts in {left:4.1f} s"
            case SequencePhase.ARMED:
                return f"waits for {self.staging.trigger.said(now)}" if self.staging.trigger else ""
            case SequencePhase.REJOINING:
                return f"back to the path {left:4.1f} s"
            case SequencePhase.RETURNING:
                return f"back to one {left:4.1f} s"
        elapsed = self.playback.time(now)
        if self.waiting:
            return f"{elapsed:6.1f} / {self.duration:.1f} s  waits for you"
        if elapsed < self.staging.start_at and self.playback.opening < self.staging.start_at:
            return f"run-up to {self.staging.start_at:.1f} s"
        time = f"{min(elapsed, self.duration):6.1f} / {self.duration:.1f} s"
        if not self.staging.repeats:
            return time
        return f"{time}  pass {self.number}{'' if self.staging.endless else f' of {self.staging.passes:.0f}'}"

    def status(self, now: float) -> RunStatus:
        """What a view shows of it at `now`; for the control thread."""
        playing, over = (
            self.phase in (SequencePhase.PLAYING, SequencePhase.REJOINING),
            self.phase in (SequencePhase.RETURNING, SequencePhase.OVER),
        )
        elapsed = min(max(0.0, self.playback.time(now)), self.duration) if playing else self.duration if over else None
        speed = self.playback.chosen
        from_here = elapsed if elapsed is not None else self.staging.start_at
        return RunStatus(
            phase=self._doing(now),
            elapsed=elapsed,
            duration=self.duration,
            left=(self.duration - from_here) / speed if speed > 0 else None,
            key=None if over else self._next_key(from_here),
            cue=None if over else self._next_cue(),
            speed=speed,
            paused=playing and self.playback.paused and not self.waiting,
            number=self.number,
            passes=self.staging.passes,
        )

    def _doing(self, now: float) -> str:
        """The phase in a few words, and how long it lasts where that is known."""
        if self.phase is SequencePhase.PLAYING and self.waiting:
            return "waiting for you"
        if self.phase is not SequencePhase.PLAYING:
            return "done" if self.phase is SequencePhase.OVER else self.said(now)
        runs_up = self.playback.time(now) < self.staging.start_at and self.playback.opening < self.staging.start_at
        return self.said(now) if runs_up else "paused" if self.playback.paused else "playing"

    def _next_key(self, elapsed: float) -> NextKey | None:
        index = bisect_right(self._key_times, elapsed + _INSTANT)
        return NextKey(index + 1, self._key_times[index]) if index < len(self._key_times) else None

    def _next_cue(self) -> NextCue | None:
        coming = self._cues if self.phase is SequencePhase.PLAYING else self._score
        cue = next((cue for cue in coming if math.isfinite(cue.at)), None)
        return None if cue is None else NextCue(cue.at, cue.name)

    def _turn(self, now: float) -> list[TickEvent]:
        """Go on to the phases that are due by `now`; what is to be done on the way."""
        trigger, due = self.staging.trigger, []
        if self.phase is SequencePhase.EASING and now > self._until - _INSTANT:
            self.phase, self._until = SequencePhase.PREROLL, self._after_preroll(self._until)
            due += self._settings if self._prepared < self.number else ()
            self._prepared = self.number
        if self.phase is SequencePhase.PREROLL and now > self._until - _INSTANT:
            if trigger is None or (self.number > 1 and (self.staging.endless or not trigger.again)):
                self._begin(self._until)
            else:
                self._arm(trigger, now)
                self.phase, self._gone = SequencePhase.ARMED, False
        if self.phase is SequencePhase.ARMED and trigger and (self._gone or (not self.missed and trigger.fired(now))):
            self._begin(now)
        if self.phase is SequencePhase.REJOINING and now > self._until - _INSTANT:
            self.phase = SequencePhase.PLAYING
            if not self.waiting:
                self.playback.resume(now)
        if self.phase is SequencePhase.RETURNING and now > self._until - _INSTANT:
            self.phase = SequencePhase.OVER
        return due

    def _arm(self, trigger: Trigger, now: float) -> None:
        """Raises DeviceError where it can no longer come, unless it went by while the run was stopped."""
        try:
            trigger.arm(now)
            self.missed = ""
        except DeviceError as error:
            if not self._suspended:
                raise
            self.missed = str(error)

    def _begin(self, now: float) -> None:
        self.phase, self._cues = SequencePhase.PLAYING, list(self._score)
        self._gone = self.waiting = False
        self.playback.begin(now)
        self._began = now
        if self.number == 1:
            self.begin = now

    def _played(self, now: float, motion: Motion) -> None:
        """A pass is over: another one, back to one, or the end."""
        if self.number < self.staging.passes:
            self.number += 1
            self.playback.rewind()
            self._ease(SequencePhase.EASING, now, motion, self.playback.opening)
        elif self.staging.back_to_one:
            self._ease(SequencePhase.RETURNING, now, motion, 0.0)
        else:
            self.phase = SequencePhase.OVER

    def _ease(self, phase: SequencePhase, now: float, motion: Motion, time: float) -> None:
        """To where the move is at its own `time`, from rest where the axes are."""
        self._ease_to(phase, now, motion, {axis: State(row[0]) for axis, row in self._move.at(time).items()})

    def _ease_to(self, phase: SequencePhase, now: float, motion: Motion, place: Motion) -> None:
        targets = {axis: state.position for axis, state in place.items()}
        self._way = rest_to_rest({axis: motion[axis] for axis in targets}, targets, self._limits, EASE_SHARE)
        self.phase, self._way_begin, self._until = phase, now, now + whole_ticks(self._way.duration)

    def _after_preroll(self, arrival: float) -> float:
        """When a pass may begin, that arrives then where it begins."""
        if self.number > 1 and self.staging.endless:
            return arrival
        return arrival + max(whole_ticks(self.staging.preroll), KEEP_ALIVE if self.staging.compared else 0.0)


def whole_ticks(seconds: float) -> float:
    """At least as long, and so many hundredths."""
    return math.ceil(seconds * 100 - _INSTANT) / 100


def cues_from(cues: Sequence[Cue], start_at: float) -> tuple[list[TickEvent], list[Cue]]:
    """What to do in place, and in a pass that begins at `start_at` (s), in mid move.

    What came before is not made up for, but for what would be going on by then: the camera records, or focuses, as the
    run-up begins, and the gimbal has been told how to follow.
    """
    before = [cue.action for cue in cues if cue.at < start_at - _INSTANT]
    follows = [act for act in before if isinstance(act, DeviceCommand) and act.words.startswith("gimbal follow")]
    going_on = []
    for on, off in LASTING:
        switches = [act for act in before if act in (on, off)]
        going_on += [Cue(-math.inf, on)] if switches[-1:] == [on] else []
    return [*follows[-1:]], [*going_on, *cues[len(before) :]]

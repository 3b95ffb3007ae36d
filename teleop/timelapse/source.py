"""A timelapse being shot: one frame after the other, each when it is due.

What a frame goes through is one table of phases, and a pause is only in it between two frames. When a frame is due is
asked of a formula each time, so an hour's lateness is as small as a second's; what comes too late for its slot is not
hurried after, it waits for the next (in steps) or is a gap (gliding), and is counted. The shutter is pressed only once
the journal says that this frame has begun, and what the camera answers is written down before the next one begins.

Nothing here waits: the journal writes in a thread of its own, the camera's answer comes by `heard`, and a tick only
looks whether they have come.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence

from teleop.core.axes import Motion
from teleop.core.errors import Interrupted
from teleop.core.events import Exposure, ShutterResult, ShutterStep, TickEvent
from teleop.core.interfaces import Feedback
from teleop.core.operator_input import Command, Input
from teleop.core.setpoints import Demand, StateTarget
from teleop.core.timing import PERIOD
from teleop.timelapse.compile import Timelapse
from teleop.timelapse.frame_log import FrameBook, FrameLog
from teleop.timelapse.journal import Note
from teleop.timelapse.movers import Mover
from teleop.timelapse.phases import TRANSITIONS, PhaseEvent, TimelapsePhase
from teleop.timelapse.progress import Progress
from teleop.timelapse.settle_detector import SettleDetector

LEAD = 0.1  # s before a shutter at which its frame is written down: a commit takes half a millisecond, a slow one 50
LATE_SHARE = 0.2  # of an interval, by which a frame may be late before its slot is missed
SILENCE = 0.7  # s after which a camera that has not answered is judged: a lost link has been found out by then
LOOK = 0.2  # s between two looks at the keys while nothing else happens
_GRID = 100  # Hz
_INSTANT = 1e-6  # s: two times on the loop's grid that are closer are the same


class TimelapseSource:
    """Frames from `first` on.

    `progress` goes on counting where an earlier run of the same shoot left off. `keys` may pause it. `slot` is when
    the next frame is due, on the loop's clock; a run that follows another of the same shoot is given that of the other,
    and keeps to its rhythm.
    """

    def __init__(
        self,
        timelapse: Timelapse,
        carriage: Mover,
        book: FrameBook,
        first: int,
        progress: Progress,
        slot: float = -math.inf,
        keys: Input | None = None,
    ) -> None:
        self._timelapse, self._carriage, self._keys = timelapse, carriage, keys
        self._ledger = FrameLog(book, progress, timelapse.go_on)
        self._phases, self._slots = timelapse.phases, timelapse.slots
        self.frame, self.phase, self.progress, self.slot = first, TimelapsePhase.APPROACH, progress, slot
        self.begin = math.inf  # when the first frame of this run is due
        self._lead = max(LEAD, self._phases.prefocus)
        self._stillness = SettleDetector(self._phases.below)
        self._asked_to_pause = progress.pausing  # an earlier run may have been paused
        self._halted = self._unbegun = False  # `unbegun`: since before the first frame was due
        self._last: Note | None = None
        self._note: Note | None = None
        self._outcome: ShutterResult | None = None
        self._since = math.inf  # when this phase began
        self._pressed = math.inf
        self._acts: list[TickEvent] = []
        self._released = False  # the focus of a frame whose shutter was not pressed has to be let go
        self._turns: Mapping[TimelapsePhase, Callable[[float], None]] = {
            TimelapsePhase.APPROACH: self._travel,
            TimelapsePhase.MOVE: self._travel,
            TimelapsePhase.SETTLE: self._settle,
            TimelapsePhase.WAIT: self._wait,
            TimelapsePhase.PAUSED: self._paused,
            TimelapsePhase.PREFOCUS: self._prefocus,
            TimelapsePhase.EXPOSE: self._expose,
            TimelapsePhase.POST: self._post,
            TimelapsePhase.FINISH: self._finish,
            TimelapsePhase.STOPPED: lambda _now: None,
            TimelapsePhase.OVER: lambda _now: None,
        }

    def start(self, now: float, motion: Motion) -> None:
        self._set_out(now, motion, self._timelapse.delay if self.frame == 0 else 0.0)
        self.begin = self.slot

    def _set_out(self, now: float, motion: Motion, later: float = 0.0) -> None:
        """Approach the frame that is next, from rest at `motion`; it is shot in the first slot that can be met.

        Where no slot has been given, that is `later` s from now or when it can be.
        """
        self._carriage.approach(now, motion, self.frame)
        ready = self._carriage.arrival + self._phases.settle + self._lead + self._carriage.run_up
        if self.slot == -math.inf:
            self.slot = math.ceil(max(ready, now + later) * _GRID - _INSTANT) / _GRID
        interval = self._slots.interval(self.frame)
        missed = max(0, math.ceil((ready - self.slot) / interval - _INSTANT))
        self.progress.missed += missed
        self.slot += missed * interval
        self._carriage.begin(self.slot, self._due)
        self._since = now

    def read(self, now: float, feedback: Feedback) -> tuple[Demand, Sequence[TickEvent]]:
        self._acts = []
        self._look_at_keys(now)
        if self.phase is TimelapsePhase.SETTLE:
            self._stillness.see(feedback.readings)
        before = None
        while (self.phase, self.frame) != before:  # one tick may see several phases through, and one slot after another
            before = self.phase, self.frame
            self._turns[self.phase](now)
        self.progress.due = self._carriage.when(self._due, now)
        return {axis: StateTarget(*state) for axis, state in self._carriage.at(now).items()}, self._acts

    resumable = pauses = quits = True

    @property
    def busy(self) -> bool:
        """While the axes are halted: whether a picture is being taken."""
        return self._halted and self.phase in (TimelapsePhase.EXPOSE, TimelapsePhase.POST, TimelapsePhase.FINISH)

    def pause(self, now: float) -> bool | None:  # noqa: ARG002 - between two frames, whenever that is
        self._asked_to_pause = self.progress.pausing = True
        return True

    def suspend(self, now: float) -> None:
        """No shutter is pressed from `now` on. A frame that was begun and not pressed is as if it had not been."""
        self._halted, self._unbegun = True, self._unbegun or self.begin > now
        self.progress.due = math.inf
        if self.phase is TimelapsePhase.PREFOCUS:
            self._ledger.unshot(self.frame)
        if self.phase is TimelapsePhase.EXPOSE and self._carriage.next_motion(now) <= now:
            self.progress.stopped.append(self.frame)
        if (self.phase, PhaseEvent.STOP) in TRANSITIONS and self.phase is not TimelapsePhase.POST:
            self._released = self.phase is TimelapsePhase.PREFOCUS and bool(self._phases.prefocus)
            self._happened(PhaseEvent.STOP, now)

    def linger(self, now: float) -> Sequence[TickEvent]:
        """What ends the frame whose shutter was pressed before the axes were halted."""
        self._acts = [Exposure(self.frame, ShutterStep.RELEASE)] if self._released else []
        self._released = False
        before = None
        while (self.phase, self.frame) != before:
            before = self.phase, self.frame
            if self.phase is not TimelapsePhase.WAIT:
                self._turns[self.phase](now)
        return self._acts

    def resume(self, now: float, motion: Motion) -> None:
        """With the frame that is next, from rest at `motion`; meanwhile no slot has passed."""
        self._halted = self._asked_to_pause = self.progress.pausing = False
        if self.phase is TimelapsePhase.OVER:
            return
        if self.phase is TimelapsePhase.WAIT:  # of a frame that got no picture while the axes were halted
            self._happened(PhaseEvent.STOP, now)
        self._happened(PhaseEvent.RESTART, now)
        self.slot = -math.inf
        self._set_out(now, motion)
        if self._unbegun:
            self.begin, self._unbegun = self.slot, False

    def next_change(self, now: float) -> float:
        if self.phase is TimelapsePhase.OVER:
            return math.inf
        change = max(now, min(self._next_event(now), self._carriage.next_motion(now)))
        return change if self._keys is None else min(change, now + LOOK)

    def heard(self, outcome: ShutterResult) -> None:
        """What the camera said; written down at once."""
        if outcome.frame == self.frame and self._pressed < math.inf:
            self._outcome = outcome
            self._ledger.heard(outcome)

    def leave(self) -> None:
        """The run is over: a frame that was begun and whose shutter was not pressed is no longer in doubt."""
        if self.phase is TimelapsePhase.PREFOCUS:
            self._ledger.unshot(self.frame)

    def due_at(self, frame: int, now: float) -> float:
        """When a frame is due, on the loop's clock."""
        return self._carriage.when(self._slots.at(frame), now)

    @property
    def _due(self) -> float:
        """When the frame is due, in the shoot's own time."""
        return self._slots.at(self.frame)

    @property
    def _grace(self) -> float:
        return max(2 * PERIOD, LATE_SHARE * self._slots.interval(self.frame))

    def _happened(self, event: PhaseEvent, now: float) -> None:
        self.phase = TRANSITIONS[self.phase, event]
        self._since = now
        self.progress.phase = self.phase.name.lower()

    def _next_event(self, now: float) -> float:
        """When this phase may end by itself, inf where nothing but a motion does that."""
        phases = self._phases
        waiting = {
            TimelapsePhase.SETTLE: now if phases.below is not None else self._since + phases.settle,
            TimelapsePhase.WAIT: self._carriage.when(self._due - self._lead, now),
            TimelapsePhase.PREFOCUS: self._carriage.when(self._due, now) if self._note and self._note.safe else now,
            TimelapsePhase.EXPOSE: self._pressed + phases.exposure,
            TimelapsePhase.POST: max(now, self._pressed + phases.exposure + phases.post) if self._outcome else now,
            TimelapsePhase.FINISH: now,
        }
        return waiting.get(self.phase, math.inf)

    def _look_at_keys(self, now: float) -> None:
        presses = self._keys.read(now).presses if self._keys is not None else ()
        for press in presses:
            match press.command:
                case Command.QUIT:
                    raise Interrupted("q pressed")
                case Command.PAUSE:
                    self._asked_to_pause = not self._asked_to_pause
                case Command.GO:
                    self._asked_to_pause = False
        self.progress.pausing = self._asked_to_pause

    def _travel(self, now: float) -> None:
        if now >= self._carriage.arrival - _INSTANT:
            self._stillness.begin()
            self._happened(PhaseEvent.ARRIVED, now)

    def _settle(self, now: float) -> None:
        over = now >= self._since + self._phases.settle - _INSTANT
        if over or self._stillness.reached:
            self.progress.unsettled += self._phases.below is not None and not self._stillness.reached
            self._happened(PhaseEvent.SETTLED, now)

    def _wait(self, now: float) -> None:
        if self._asked_to_pause:
            self._carriage.pause(now)
            self._happened(PhaseEvent.PAUSE, now)
            return
        time = self._carriage.time(now)
        if time > self._due + self._grace:
            self._miss(now)
        elif time >= self._due - self._lead - _INSTANT:
            self._note = self._ledger.begin(self.frame)
            if self._phases.prefocus:
                self._acts.append(Exposure(self.frame, ShutterStep.FOCUS))
            self._happened(PhaseEvent.DUE, now)

    def _paused(self, now: float) -> None:
        if not self._asked_to_pause:
            self._carriage.resume(now, self._due, self._lead)
            self._happened(PhaseEvent.RESUME, now)

    def _prefocus(self, now: float) -> None:
        self._ledger.check(self.frame)
        assert self._note is not None
        late = self._carriage.time(now) - self._due
        ready = self._note.safe and now >= self._since + self._phases.prefocus - _INSTANT
        if late > self._grace:
            if self._phases.prefocus:
                self._acts.append(Exposure(self.frame, ShutterStep.RELEASE))
            self._ledger.unshot(self.frame)
            self._miss(now)
        elif ready and late >= -_INSTANT:
            self._acts.append(Exposure(self.frame, ShutterStep.PRESS))
            self._pressed, self._outcome = now, None
            if late > PERIOD + _INSTANT:
                self.progress.late += 1
                self.progress.latest = max(self.progress.latest, late)
            self._happened(PhaseEvent.FIRE, now)

    def _expose(self, now: float) -> None:
        if now >= self._pressed + self._phases.exposure - _INSTANT:
            self._acts.append(Exposure(self.frame, ShutterStep.RELEASE))
            self._happened(PhaseEvent.EXPOSED, now)

    def _post(self, now: float) -> None:
        phases, outcome = self._phases, self._outcome
        if outcome is None or now < self._pressed + phases.exposure + phases.post - _INSTANT:
            return
        if outcome.code is None and now < self._pressed + SILENCE:
            return
        self._pressed, self._outcome = math.inf, None
        if self._ledger.past(outcome):
            self._go_on(now)
        else:
            self._miss(now)

    def _finish(self, now: float) -> None:
        self._last = self._last or self._ledger.finish()
        self._ledger.check_end()
        if self._last.safe:
            self._happened(PhaseEvent.WRITTEN, now)

    def _go_on(self, now: float) -> None:
        if self._was_last(now):
            return
        if self._halted:
            self._happened(PhaseEvent.STOP, now)
            return
        spare = self._carriage.when(self._due, now) - now - self._lead - self._phases.settle
        stepped = self._carriage.step(now, self.frame, spare)
        self._happened(PhaseEvent.STEP if stepped else PhaseEvent.STAY, now)

    def _was_last(self, now: float) -> bool:
        """Whether there is no frame after this one; if there is, it is next."""
        if self.frame == self._slots.frames - 1:
            self._happened(PhaseEvent.LAST, now)
            return True
        self.frame += 1
        self.progress.frame = self.frame
        return False

    def _miss(self, now: float) -> None:
        """The slot has passed without a picture."""
        self.progress.missed += 1
        if self._carriage.skip(self._slots.interval(self.frame)):
            self._happened(PhaseEvent.MISSED, now)
            return
        self._ledger.lost(self.frame)
        if not self._was_last(now):
            self._happened(PhaseEvent.MISSED, now)

"""What a timelapse does with its frames, one after the other: the table of `phases`, and what ends each of them.

What comes too late for its slot is not hurried after: it waits for the next (in steps) or is a gap (gliding), and is
counted. The shutter is pressed only once the journal says that this frame has begun, and the camera's answer is written
down before the next one begins.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping

from teleop.core.timing import PERIOD, SAME_TIME
from teleop.timelapse.compile import Timelapse
from teleop.timelapse.frame_log import RETRY, FrameBook, FrameLog
from teleop.timelapse.frame_shutter import FrameShutter
from teleop.timelapse.movers import Mover
from teleop.timelapse.phases import TRANSITIONS, PhaseEvent, TimelapsePhase
from teleop.timelapse.progress import Progress
from teleop.timelapse.settle_detector import SettleDetector

LEAD = 0.1  # s before a shutter at which its frame is written down: a commit takes half a millisecond, a slow one 50
LATE_SHARE = 0.2  # of an interval, by which a frame may be late before its slot is missed


class FrameCycle:
    """`frame` is the one that is next or being shot, from 0; `since` is when its `phase` began, in s.

    `lead` is how long before its slot a frame is begun, in s. A pause that is asked for comes between two frames;
    while the axes are `halted` no frame is gone to.
    """

    def __init__(self, timelapse: Timelapse, mover: Mover, book: FrameBook, first: int, progress: Progress) -> None:
        self._mover, self._phases, self._schedule = mover, timelapse.phases, timelapse.slots
        self.frame, self.phase, self.progress, self.since = first, TimelapsePhase.APPROACH, progress, math.inf
        self.log = FrameLog(book, progress, timelapse.go_on)
        self.shutter = FrameShutter(timelapse.phases, self.log)
        self.settle_detector = SettleDetector(self._phases.below)
        self._focus_lead = max(LEAD, self._phases.prefocus)
        self.lead = max(self._focus_lead, LEAD + mover.ramp)
        self.asked_to_pause = progress.pausing  # an earlier run may have been paused
        self.halted = False
        self._on_due: Mapping[TimelapsePhase, Callable[[float], None]] = {
            TimelapsePhase.APPROACH: self._travel,
            TimelapsePhase.MOVE: self._travel,
            TimelapsePhase.SETTLE: self._settle,
            TimelapsePhase.WAIT: self._wait,
            TimelapsePhase.PAUSED: self._continue,
            TimelapsePhase.PREFOCUS: self._prefocus,
            TimelapsePhase.EXPOSE: self._expose,
            TimelapsePhase.POST: self._post,
            TimelapsePhase.FINISH: self._finish,
            TimelapsePhase.STOPPED: lambda _now: None,
            TimelapsePhase.OVER: lambda _now: None,
        }

    def advance(self, now: float, but: TimelapsePhase | None = None) -> None:
        """End the phases that are due by `now`, up to the phase `but`; one tick may end several."""
        before = None
        while (self.phase, self.frame) != before and self.phase is not but:
            before = self.phase, self.frame
            self._on_due[self.phase](now)

    @property
    def due(self) -> float:
        """When the frame is due, in the shoot's own time."""
        return self._schedule.at(self.frame)

    @property
    def _grace(self) -> float:
        """By how much a frame may be late, in s: where the axes move through it, its place does not wait."""
        if self._mover.ramp:
            return PERIOD + SAME_TIME
        return max(2 * PERIOD, LATE_SHARE * self._schedule.interval(self.frame))

    def handle(self, event: PhaseEvent, now: float) -> None:
        self.phase = TRANSITIONS[self.phase, event]
        self.since = now
        self.progress.phase = self.phase.name.lower()

    def next_event(self, now: float) -> float:
        """When this phase may end by itself, inf where nothing but a motion does that."""
        phases, shutter = self._phases, self.shutter
        waiting = {
            TimelapsePhase.SETTLE: now if phases.below is not None else self.since + phases.settle,
            TimelapsePhase.WAIT: self._mover.when(self.due - self.lead, now),
            TimelapsePhase.PREFOCUS: min(self._mover.when(self.due, now), shutter.focus_at) if shutter.noted else now,
            TimelapsePhase.EXPOSE: shutter.exposed_at,
            TimelapsePhase.POST: max(now, shutter.done_at) if shutter.answered else now,
            TimelapsePhase.FINISH: now,
            TimelapsePhase.PAUSED: self.since + RETRY if self.progress.problem else math.inf,
        }
        return waiting.get(self.phase, math.inf)

    def _travel(self, now: float) -> None:
        if now >= self._mover.arrival - SAME_TIME:
            self.settle_detector.reset()
            self.handle(PhaseEvent.ARRIVED, now)

    def _settle(self, now: float) -> None:
        over = now >= self.since + self._phases.settle - SAME_TIME
        if over or self.settle_detector.reached:
            self.progress.unsettled += self._phases.below is not None and not self.settle_detector.reached
            self.handle(PhaseEvent.SETTLED, now)

    def _wait(self, now: float) -> None:
        time = self._mover.time(now)
        if self.asked_to_pause:
            self._mover.pause(now)
            self.handle(PhaseEvent.PAUSE, now)
        elif time > self.due + self._grace or not self._mover.meets_slot:
            self._miss(now)
        elif time >= self.due - self.lead - SAME_TIME:
            later = self._mover.when(self.due - self._focus_lead, now) if self._mover.ramp else now
            self.shutter.begin(self.frame, now, later)
            self.handle(PhaseEvent.DUE, now)

    def _continue(self, now: float) -> None:
        retried = not self.progress.problem or now >= self.since + RETRY - SAME_TIME
        if not self.asked_to_pause and retried:
            self.progress.problem = ""
            self._mover.resume(now, self.due, self.lead)
            self.handle(PhaseEvent.RESUME, now)

    def _prefocus(self, now: float) -> None:
        if self.shutter.is_unwritten:
            self.shutter.give_up()
            self._mover.pause(now)
            for event in (PhaseEvent.MISSED, PhaseEvent.PAUSE):  # begun again, and no slot is counted as missed
                self.handle(event, now)
            self.progress.problem = "the journal could not be written: trying again"
            return
        late, ready = self._mover.time(now) - self.due, self.shutter.ready(now)
        if late > self._grace:
            self.shutter.give_up()
            self._miss(now)
        elif ready and late >= -SAME_TIME:
            self.shutter.press(now)
            if late > PERIOD + SAME_TIME:
                self.progress.late += 1
                self.progress.latest = max(self.progress.latest, late)
            self.handle(PhaseEvent.FIRE, now)

    def _expose(self, now: float) -> None:
        if now >= self.shutter.exposed_at - SAME_TIME:
            self.shutter.release()
            self.handle(PhaseEvent.EXPOSED, now)

    def _post(self, now: float) -> None:
        result = self.shutter.result(now)
        if result is None:
            return
        if not self.log.is_past(result):
            self._miss(now)
        elif not self._was_last(now):
            self._go_to_next(now)

    def _go_to_next(self, now: float) -> None:
        if self.halted:
            self.handle(PhaseEvent.STOP, now)
            return
        spare = self._mover.when(self.due, now) - now - self.lead - self._phases.settle
        stepped = self._mover.step(now, self.frame, spare)
        self.handle(PhaseEvent.STEP if stepped else PhaseEvent.STAY, now)

    def _finish(self, now: float) -> None:
        if self.log.finished(now):
            self.handle(PhaseEvent.WRITTEN, now)

    def _was_last(self, now: float) -> bool:
        """Whether there is no frame after this one; if there is, it is next."""
        if self.frame == self._schedule.frames - 1:
            self.handle(PhaseEvent.LAST, now)
            return True
        self.frame += 1
        self.progress.frame = self.frame
        return False

    def _miss(self, now: float) -> None:
        """The slot has passed without a picture."""
        slots = self._mover.skip(now, self._schedule.interval(self.frame))
        self.progress.missed += max(1, slots)
        if not slots:
            self.log.lost(self.frame)
            if self._was_last(now):
                return
        self.handle(PhaseEvent.MISSED, now)

"""A timelapse as the loop sees it: the frames of a `FrameCycle`, which an operator may pause and a STOP may halt.

When a frame is due is asked of a formula each time, so an hour's lateness is as small as a second's.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

from teleop.core.axes import Motion
from teleop.core.errors import Interrupted
from teleop.core.events import ShutterResult, SourceEvent, TickEvent
from teleop.core.interfaces import Feedback
from teleop.core.operator_input import Command, Input
from teleop.core.setpoints import Demand, StateTarget
from teleop.core.timing import SAME_TIME, whole_ticks
from teleop.timelapse.compile import Timelapse
from teleop.timelapse.frame_cycle import FrameCycle
from teleop.timelapse.frame_log import FrameBook
from teleop.timelapse.movers import Mover
from teleop.timelapse.phases import TRANSITIONS, PhaseEvent, TimelapsePhase
from teleop.timelapse.progress import Progress

KEYS_PERIOD = 0.2  # s between two checks of the keys while nothing else happens
EXPOSING = (TimelapsePhase.EXPOSE, TimelapsePhase.POST, TimelapsePhase.FINISH)


class TimelapseSource:
    """Frames from `first` on.

    `progress` goes on counting where an earlier run of the same shoot left off. `keys` may pause it. `slot` is when
    the next frame is due, on the loop's clock; a run that follows another of the same shoot is given that of the other,
    and keeps to its rhythm. `begin` is when the first frame of this run is due.
    """

    resumable = pauses = quits = True

    def __init__(
        self,
        timelapse: Timelapse,
        mover: Mover,
        book: FrameBook,
        first: int,
        progress: Progress,
        slot: float = -math.inf,
        keys: Input | None = None,
    ) -> None:
        self._cycle = FrameCycle(timelapse, mover, book, first, progress)
        self._timelapse, self._mover, self._keys, self._schedule = timelapse, mover, keys, timelapse.slots
        self.progress, self.slot, self.begin = progress, slot, math.inf
        self._halted_before_begin = False

    @property
    def phase(self) -> TimelapsePhase:
        return self._cycle.phase

    def start(self, now: float, motion: Motion) -> None:
        self._set_out(now, motion, self._timelapse.delay if self._cycle.frame == 0 else 0.0)
        self.begin = self.slot

    def read(self, now: float, feedback: Feedback) -> tuple[Demand, Sequence[SourceEvent]]:
        self._check_keys(now)
        if self.phase is TimelapsePhase.SETTLE:
            self._cycle.settle_detector.update(feedback.readings)
        self._cycle.advance(now)
        self.progress.due = self._mover.when(self._cycle.due, now)
        demand = {axis: StateTarget(*state) for axis, state in self._mover.at(now).items()}
        return demand, self._cycle.shutter.take_events()

    def next_change(self, now: float) -> float:
        if self.phase is TimelapsePhase.OVER:
            return math.inf
        change = max(now, min(self._cycle.next_event(now), self._mover.next_motion(now)))
        return change if self._keys is None else min(change, now + KEYS_PERIOD)

    @property
    def busy(self) -> bool:
        """While the axes are halted: whether a picture is being taken."""
        return self._cycle.halted and self.phase in EXPOSING

    def pause(self, now: float) -> bool | None:  # noqa: ARG002 - between two frames, whenever that is
        self._cycle.asked_to_pause = self.progress.pausing = True
        return True

    def go_on(self) -> None:
        """After a pause that was asked for."""
        self._cycle.asked_to_pause = self.progress.pausing = False

    def suspend(self, now: float) -> None:
        """No shutter is pressed from `now` on. A frame that was begun and not pressed counts as not begun."""
        cycle = self._cycle
        cycle.halted, self._halted_before_begin = True, self._halted_before_begin or self.begin > now
        self.progress.due = math.inf
        if self.phase is TimelapsePhase.PREFOCUS:
            cycle.shutter.give_up()
        if self.phase is TimelapsePhase.EXPOSE and self._mover.next_motion(now) < cycle.shutter.exposed_at:
            self.progress.stopped.append(cycle.frame)
        if (self.phase, PhaseEvent.STOP) in TRANSITIONS and self.phase is not TimelapsePhase.POST:
            cycle.handle(PhaseEvent.STOP, now)

    def linger(self, now: float) -> Sequence[TickEvent]:
        """What ends the frame whose shutter was pressed before the axes were halted."""
        self._cycle.advance(now, but=TimelapsePhase.WAIT)
        return self._cycle.shutter.take_events()

    def resume(self, now: float, motion: Motion) -> None:
        """With the frame that is next, from rest at `motion`; meanwhile no slot has passed."""
        cycle = self._cycle
        cycle.halted = cycle.asked_to_pause = self.progress.pausing = False
        if self.phase is TimelapsePhase.OVER:
            return
        if self.phase is TimelapsePhase.WAIT:  # of a frame that got no picture while the axes were halted
            cycle.handle(PhaseEvent.STOP, now)
        cycle.handle(PhaseEvent.RESTART, now)
        self.slot = -math.inf
        self._set_out(now, motion)
        if self._halted_before_begin:
            self.begin, self._halted_before_begin = self.slot, False

    def on_shutter_result(self, result: ShutterResult) -> None:
        """Take the camera's answer to a press; it is written down at once."""
        self._cycle.shutter.on_result(result)

    def leave(self) -> None:
        """End the run: a frame that was begun and whose shutter was not pressed is known not to be shot."""
        if self.phase is TimelapsePhase.PREFOCUS:
            self._cycle.log.unshot(self._cycle.frame)

    def due_at(self, frame: int, now: float) -> float:
        """When a frame is due, on the loop's clock."""
        return self._mover.when(self._schedule.at(frame), now)

    def _set_out(self, now: float, motion: Motion, later: float = 0.0) -> None:
        """Approach the frame that is next, from rest at `motion`; it is shot in the first slot that can be met.

        Where no slot has been given, that is `later` s from now or when it can be.
        """
        cycle, mover = self._cycle, self._mover
        mover.approach(now, motion, cycle.frame)
        ready = mover.arrival + self._timelapse.phases.settle + cycle.lead + mover.run_up
        if self.slot == -math.inf:
            self.slot = whole_ticks(max(ready, now + later))
        interval = self._schedule.interval(cycle.frame)
        missed = max(0, math.ceil((ready - self.slot) / interval - SAME_TIME))
        self.progress.missed += missed
        self.slot += missed * interval
        mover.begin(self.slot, cycle.due)
        cycle.since = now

    def _check_keys(self, now: float) -> None:
        for press in self._keys.read(now).presses if self._keys is not None else ():
            match press.command:
                case Command.QUIT:
                    raise Interrupted(f"stopped by {press.by}" if press.by else "q pressed")
                case Command.PAUSE:
                    self._cycle.asked_to_pause = not self._cycle.asked_to_pause
                case Command.GO:
                    self.go_on()
        self.progress.pausing = self._cycle.asked_to_pause

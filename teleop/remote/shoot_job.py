"""A timelapse that a client has shot: the source of the pipeline as a job, over as many runs of the rig as it takes.

A STOP, and an operator who takes an axis of it, halt it away from its place; a pause comes between two frames. It goes
on when its console is gone and when control passes on: only `resume` and `abort` need a client. What ends it waits for
the picture that is being taken.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Sequence
from typing import Any

from teleop.core.axes import Axis, Motion
from teleop.core.errors import TeleopError
from teleop.core.events import ShutterResult, SourceEvent, Tick
from teleop.core.interfaces import Feedback
from teleop.core.setpoints import Demand
from teleop.monitors.tracking_error import TrackingErrorMonitor
from teleop.remote.jobs import Ended
from teleop.remote.shoot_state import shoot_state
from teleop.timelapse.compile import Timelapse
from teleop.timelapse.go_motion import mover_of
from teleop.timelapse.journal import Journal
from teleop.timelapse.phases import TimelapsePhase
from teleop.timelapse.so_far import settle_doubt, so_far
from teleop.timelapse.source import TimelapseSource


class ShootJob:
    """`owner` is the session that has it shot. `journal` is open until `close`, which waits for the disk.

    `lines` are for the operator, once.
    """

    def __init__(self, timelapse: Timelapse, owner: str, journal: Journal) -> None:
        self.title, self.owner = timelapse.title, owner
        self.ended: Ended = lambda _why: None
        self.close: Callable[[], object] = lambda: None
        self.journal, self._timelapse = journal, timelapse
        self.progress = so_far(timelapse, journal)
        self.lines: list[str] = []
        self.halted = ""  # why it is away from its place
        self._going = False
        self._end = ""  # why it ends, once the picture that is being taken is
        self._failure = ""  # why it ends now
        self._motion: Motion = {}
        self._slot = -math.inf  # when the frame that is next is due: a run that follows keeps the rhythm
        self.begin = math.inf  # when the first frame of the first run was due
        self.tracking = TrackingErrorMonitor(lambda: self.begin)
        self.prepare()

    def prepare(self) -> None:
        """Have it ready to begin, or to go on after a run of the rig that has failed; not in the control thread."""
        settle_doubt(self.journal, self.progress, "shoot", self.lines.append)
        mover = mover_of(self._timelapse, None)
        first = self.journal.next
        self._mover = mover
        self._source = TimelapseSource(self._timelapse, mover, self.journal, first, self.progress, self._slot)

    @property
    def axes(self) -> Collection[Axis]:
        return self._timelapse.limits

    @property
    def frames(self) -> int:
        return self._timelapse.frames

    def start(self, now: float, motion: Motion) -> None:
        self._motion = motion
        self._source.start(now, motion)
        if self.halted:
            self._source.suspend(now)

    def read(self, now: float, feedback: Feedback) -> tuple[Demand, Sequence[SourceEvent]]:
        """What goes wrong ends the job and not the run of the rig."""
        self._motion = feedback.motion
        try:
            if self.halted and self._going and self._rests and not self._source.busy:
                self.halted, self._going = "", False
                self._source.resume(now, feedback.motion)
            return ({}, self._source.linger(now)) if self.halted else self._source.read(now, feedback)
        except TeleopError as error:
            self._failure = str(error)
            self.halted = self.halted or self._failure
            return {}, ()

    @property
    def reached(self) -> float:
        """When the first frame of this run of the rig is due; inf as long as that is not known."""
        return self._source.begin

    def foreseen(self, time: float) -> Motion:
        return {} if self.halted else self._mover.foreseen(time)

    def done(self, tick: Tick) -> bool:
        self.begin = min(self.begin, self._source.begin)
        self.tracking.observe(tick)
        if self._failure or (self._end and not self._source.busy):
            raise TeleopError(self._failure or self._end)
        return self._source.phase is TimelapsePhase.OVER and self._rests

    def halt(self, now: float, why: str) -> bool:
        """Away from its place, and no shutter is pressed, until it is resumed: never over with that."""
        if not self.halted:
            self._source.suspend(now)
        self.halted, self._going = why, False
        return False

    def outranked(self, now: float, why: str) -> bool:
        if not self.halted:
            self.halt(now, why)
            self.lines.append(f"{self.title} pauses: {why}; resume it")
        return False

    def on_result(self, result: ShutterResult) -> None:
        """The camera's answer to a press."""
        self._source.on_shutter_result(result)

    def leave(self, now: float) -> None:
        """The run of the rig is over: what was begun and not pressed is known not to be shot."""
        self._source.leave()
        self.journal.catch_up()
        if self._source.begin < math.inf:
            self._slot = -math.inf if self.halted else self._source.due_at(self.journal.next, now)

    # --- the transport

    @property
    def paused(self) -> bool:
        return bool(self.halted) or self.progress.phase == "paused"

    def pause(self, now: float) -> None:
        """Between two frames, whenever that is."""
        if self.halted:
            self._going = False
        else:
            self._source.pause(now)

    def changing(self) -> bool:
        """Whether what was asked for last is still under way."""
        if self.halted:
            return self._going
        return self.progress.pausing != (self.progress.phase == "paused")

    def resume(self) -> None:
        if self.halted:
            self._going = True
        else:
            self._source.go_on()

    def abort(self, now: float, why: str) -> None:
        self.halt(now, why)
        self._end = why

    @property
    def _rests(self) -> bool:
        return all(not self._motion[axis].velocity and not self._motion[axis].acceleration for axis in self.axes)

    def state(self, now: float) -> dict[str, Any]:
        """For clients: how far it is at `now`."""
        return dict(shoot_state(self.title, self.progress, now, self.halted))

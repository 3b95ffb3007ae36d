"""A move that a client plays: the source of the pipeline as a job, with its transport; it may follow another's clock.

It pauses on its path where it can, and halts away from it where it must (a STOP, control passing on); either way it
goes on when it is asked to, from where it was. One that is `attended` pauses when its console is gone.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Sequence
from typing import Any

from teleop.core.axes import Axis, Motion
from teleop.core.errors import TeleopError
from teleop.core.events import SourceEvent, Tick
from teleop.core.interfaces import Feedback
from teleop.core.setpoints import Demand
from teleop.planner.chasing import Reference
from teleop.remote.follower import Follower
from teleop.remote.jobs import Ended
from teleop.remote.move_state import move_state
from teleop.sequence.common_start import CommonStart
from teleop.sequence.phases import SequencePhase
from teleop.sequence.source import SequenceSource


class NotNowError(TeleopError):
    """What the move cannot do at the moment, and why."""


class PlayJob:
    """`title` is the move's. `owner` is the session that has it played."""

    def __init__(
        self,
        title: str,
        owner: str,
        source: SequenceSource,
        attended: bool,
        ended: Ended,
        follower: Follower | None = None,
    ) -> None:
        self.title, self.owner, self.attended, self.ended = title, owner, attended, ended
        self.source, self.follower = source, follower
        self.halted = ""  # why it is away from its path
        self.left = False  # by its console: it was paused for that
        self._going = False
        self._motion: Motion = {}

    @property
    def axes(self) -> Collection[Axis]:
        return self.source.move.tracks

    def start(self, now: float, motion: Motion) -> None:
        self._motion = motion
        self.source.start(now, motion)
        if self.halted:
            self.source.suspend(now)

    def read(self, now: float, feedback: Feedback) -> tuple[Demand, Sequence[SourceEvent]]:
        self._motion = feedback.motion
        if self.halted and self._going and self._rests:
            self.halted, self._going = "", False
            self.source.resume(now, feedback.motion)
        if self.halted:
            return {}, ()
        if self.follower is not None:
            self.follower.step(self.source, now)
            if self.follower.stuck:
                self.halt(now, "the timecode is lost")
                return {}, ()
        return self.source.read(now, feedback)

    def done(self, tick: Tick) -> bool:
        return not self.halted and math.isinf(self.source.next_change(tick.time)) and self._rests_in(tick.motion)

    def halt(self, now: float, why: str) -> bool:
        """Away from its path, until it is resumed: never over with that."""
        if not self.halted:
            self.source.suspend(now)
        if isinstance(trigger := self.source.cycle.trigger, CommonStart):
            trigger.call_off()
        self.halted, self._going = why, False
        if self.follower is not None:
            self.follower.halt()
        return False

    def outranked(self, now: float, why: str) -> bool:  # noqa: ARG002 - it goes on beneath the hand
        return False

    def foreseen(self, time: float) -> Motion:
        return {} if self.halted else self.source.foreseen(time)

    # --- the transport; NotNowError says why not

    @property
    def paused(self) -> bool:
        return bool(self.halted) or (self.source.phase is SequencePhase.PLAYING and self.source.playback.paused)

    def changing(self, now: float) -> bool:
        """Whether what was asked for last is still under way."""
        return bool(self.halted and self._going) or (not self.halted and self.source.playback.changing(now))

    def pause(self, now: float, why: str = "paused") -> None:
        if self.halted:
            self._going = False
        elif self.source.phase is SequencePhase.PLAYING and not self.source.waiting:
            if self.follower is None:
                self.source.playback.pause(now)
            else:
                self.follower.pause(self.source, now)
        else:
            self.halt(now, why)

    def resume(self, now: float) -> None:
        self.left = False
        if self.halted:
            self._going = True
        elif self.source.waiting or self.source.phase is SequencePhase.ARMED:
            self.source.go()
        elif self.source.playback.paused or self.source.playback.changing(now):
            self.source.playback.resume(now)

    def speed(self, share: float, now: float) -> None:
        self.source.playback.speed(share, now)
        self._refuse()

    def seek(self, time: float, now: float) -> None:
        self._need_pause(now)
        self.source.playback.seek(time, now)

    def step(self, keys: int, now: float) -> None:
        self._need_pause(now)
        self.source.playback.step(keys, now)
        self._refuse()

    def to_start(self, now: float) -> None:
        self.seek(self.source.move.opening, now)

    def chase(self, reference: Reference, free: bool, now: float) -> None:
        """Follow the clock that has this place now; `free`: only begin with it, and go on by our own."""
        if self.follower is None:
            raise NotNowError(f"{self.title} is not played to be chased")
        if self.halted:
            raise NotNowError(f"it was halted ({self.halted}): resume it first")
        self.follower.follow(reference, free, now)
        self._refuse()

    def _need_pause(self, now: float) -> None:
        playback = self.source.playback
        if self.halted or not playback.paused or playback.changing(now):
            why = f"it was halted ({self.halted}): resume it first" if self.halted else "pause the move first"
            raise NotNowError(why)

    def _refuse(self) -> None:
        if self.source.playback.refusal:
            raise NotNowError(self.source.playback.refusal)

    @property
    def _rests(self) -> bool:
        return self._rests_in(self._motion)

    def _rests_in(self, motion: Motion) -> bool:
        return all(not motion[axis].velocity and not motion[axis].acceleration for axis in self.axes)

    def state(self, now: float) -> dict[str, Any]:
        """For clients: what it does at `now`."""
        return move_state(self.title, self.source, now, self.halted, self.attended)

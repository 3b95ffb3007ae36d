"""A move that follows another's clock, such as timecode: it begins with it, keeps to it, and stops when it is lost.

It is the trigger of its move, which waits at its start until the clock comes there. From then on `Playback.chase`
steers it; where it has paused, or begins late, it catches up along its path, or waits for the clock, or goes back along
its path to meet it.
"""

from __future__ import annotations

import math
from contextlib import ExitStack

from teleop.core.timing import PERIOD
from teleop.planner.chasing import Reference
from teleop.sequence.phases import SequencePhase
from teleop.sequence.source import SequenceSource

SILENT = 0.5  # s without a word of the clock, after which it is lost
LATE = 0.02  # s by which the clock may be past the start for the move to begin as it was written
JOIN = 0.3  # s before a place, from which on a move that rests there looks for a way to join
FAR = 5.0  # s that it waits for a clock that is behind; if it is further behind, the move goes back to meet it
AGAIN = 3.0  # s from one way back to the next


class Follower:
    """`follow` each time that the clock was read; `step` each tick, before the source is read.

    `stuck`: the clock is lost and no pause on the path keeps the limits, so that the move has to be halted.
    """

    again = True

    def __init__(self) -> None:
        self._reference: Reference | None = None
        self._heard = -math.inf
        self._free = False
        self._fires = self._joins = False
        self._sought = -math.inf
        self._pausing = self.stuck = False

    def follow(self, reference: Reference, free: bool, now: float) -> None:
        self._reference, self._free, self._heard = reference, free, now
        self._pausing = False

    def pause(self, source: SequenceSource, now: float) -> None:
        """Come to rest on the path, and follow nothing before the clock is heard again."""
        self._reference, self._pausing = None, True
        source.playback.pause(now)

    def halt(self) -> None:
        """The move is away from its path: it is not followed before it is heard again."""
        self._reference = None
        self._pausing = self.stuck = False

    # --- the trigger

    def open(self, stack: ExitStack) -> None: ...

    def arm(self, now: float) -> None: ...

    def fired(self, now: float) -> bool:  # noqa: ARG002
        return self._fires

    def waits_for(self, now: float) -> str:  # noqa: ARG002
        return "the timecode"

    # --- each tick

    def step(self, source: SequenceSource, now: float) -> None:
        reference, playback = self._reference, source.playback
        if reference is None:
            self.stuck = self._pausing and not playback.paused and not playback.changing(now)
            return
        if now - self._heard > SILENT:
            self._reference = None
            if source.phase is SequencePhase.PLAYING and (not playback.paused or playback.changing(now)):
                self.pause(source, now)  # also of one that is paused, and about to go on
            return
        place = reference.place(now)
        if source.phase is SequencePhase.ARMED:
            begins = place >= playback.opening - PERIOD / 2
            self._fires, self._joins = begins, begins and not self._free and place - playback.opening > LATE
        elif source.phase is SequencePhase.PLAYING and not source.waiting:
            self._fires = False
            if self._joins:  # it has begun in the tick before, and has not moved
                self._joins = False
                playback.freeze(now)
            self._play(source, reference, now)

    def _play(self, source: SequenceSource, reference: Reference, now: float) -> None:
        playback = source.playback
        if self._free or playback.changing(now):
            return
        if not playback.paused:
            playback.chase(reference, now)
            return
        here, code = playback.time(now), reference.place(now)
        if code >= here - JOIN:
            playback.chase(reference, now)
        elif here - code > FAR and now - self._sought > AGAIN:
            self._sought = now
            slow = 2 / max(playback.at_most, 0.1)  # s of a way back, for a second of the move
            playback.seek((code + 1.0 + slow * here) / (1 + slow), now)  # where the two meet

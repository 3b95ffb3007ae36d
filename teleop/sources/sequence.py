"""Plays a compiled performance: eases to its first keyframe, waits the preroll, then follows it on the loop's clock.

Nothing is decided on the way. Where the axes stand is known when the run starts, so the ease is compiled then, and from
there on the source only looks up where the axes have to be, at the pace that `Playback` keeps. The start is put on a
whole hundredth of a second, which is a tick, so that keyframes are met and not just passed between two ticks.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from concurrent.futures import Executor

from teleop.motion import Act, Axis, Demand, Follow, Limits, Motion
from teleop.planner.ease import ease
from teleop.planner.move import Move
from teleop.sources.playback import Playback
from teleop.sources.sequence_file import Performance

EASE_SHARE = 0.5  # of each axis's velocity, acceleration and jerk: on the way to the start nothing is in a hurry
_INSTANT = 1e-6  # s: two times on the loop's grid that are closer are the same


class SequenceSource:
    """`limits` are the axes', for the ease to the start and for changes of speed.

    `speed` is the share of the speed that the sequence was written for; PlanError says when the move does not allow it.
    `executor` searches for changes of it, a thread unless given.
    `begin` is when the performance's own time is zero, on the loop's clock; inf until the run has started.
    """

    def __init__(
        self,
        performance: Performance,
        limits: Mapping[Axis, Limits],
        speed: float = 1.0,
        executor: Executor | None = None,
    ) -> None:
        self._move, self._limits, self._preroll = performance.move, limits, performance.preroll
        keys = sorted({key.at for of_axis in performance.keys.values() for key in of_axis})
        self.playback = Playback(performance.move, limits, speed, keys, executor)
        self._cues = list(performance.cues)
        self._approach: Move | None = None
        self._approach_begin = self._approach_end = math.inf
        self.begin = math.inf

    def start(self, now: float, motion: Motion) -> None:
        targets = {axis: state.position for axis, state in self._move.start.items()}
        here = {axis: motion[axis] for axis in targets}
        self._approach = ease(here, targets, {axis: self._limits[axis] for axis in targets}, EASE_SHARE)
        self._approach_begin = now
        self._approach_end = now + math.ceil(self._approach.duration * 100) / 100
        self.begin = self._approach_end + math.ceil(self._preroll * 100 - _INSTANT) / 100
        self.playback.begin(self.begin)

    def read(self, now: float) -> tuple[Demand, Sequence[Act]]:
        elapsed = -math.inf
        if self._approach is not None and now < self.begin - _INSTANT:
            motion = self._approach.at(now - self._approach_begin)
        else:
            elapsed, motion = self.playback.at(now)
        due = [cue.action for cue in self._cues if cue.at <= elapsed + _INSTANT]
        del self._cues[: len(due)]
        return {axis: Follow(*state) for axis, state in motion.items()}, due

    def next_change(self, now: float) -> float:
        if now < self._approach_end - _INSTANT:
            return now
        if now < self.begin - _INSTANT:
            return self.begin
        if self.playback.changing(now):
            return now
        cue = self._cues[0].at if self._cues else math.inf
        return self.playback.when(min(self._move.next_motion(self.playback.time(now)), cue), now)

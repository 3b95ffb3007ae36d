"""Go-motion: rests between the shots as shoot-move-shoot does, and moves through each exposure.

Each run begins `RAMP` s before its frame is due. Where the frame cannot be shot then, the axes go back to where its run
begins, and it is due an interval later.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from concurrent.futures import Executor

from teleop.core.axes import Axis, Motion
from teleop.core.timing import SAME_TIME
from teleop.planner.go_motion import RAMP, ExposureRuns
from teleop.planner.rest_to_rest import rest_to_rest
from teleop.planner.trajectory import Move
from teleop.timelapse.budget import STEP_SHARE
from teleop.timelapse.compile import Timelapse
from teleop.timelapse.movers import GlideMover, Mover, StepMover
from teleop.timelapse.way import GENTLE, Way, approach


class GoMotionMover:
    """`runs` are those of the timelapse, through the exposure of each of its frames."""

    run_up, ramp = 0.0, RAMP

    def __init__(self, timelapse: Timelapse, runs: Mapping[Axis, ExposureRuns]) -> None:
        self._runs, self._limits, self._slots = runs, timelapse.limits, timelapse.slots
        self._settle = timelapse.phases.settle
        self._positions = timelapse.path.positions(timelapse.frames)
        self._way = Way(0.0, {})  # to where the run of the present frame begins
        self._base = math.inf  # when the shoot's own time is 0
        self._held = math.inf  # the same as it was before a pause
        self._frame, self._run = 0, Move({})

    @property
    def arrival(self) -> float:
        return self._way.arrival

    @property
    def meets_slot(self) -> bool:
        return self._way.arrival + self._settle <= self._pressed - RAMP + SAME_TIME

    def approach(self, now: float, motion: Motion, frame: int) -> None:
        self._base = math.inf
        self._prepare(frame)
        self._way = approach(now, motion, self._start, self._positions, frame, self._limits)

    def begin(self, slot: float, time: float) -> None:
        self._base = slot - time

    def at(self, now: float) -> Motion:
        return self._run.at(now - self._pressed) if self._is_running(now) else self._way.at(now)

    def foreseen(self, time: float) -> Motion:
        return self.at(time)

    def step(self, now: float, frame: int, spare: float) -> bool:
        way = self._run_out(now)
        self._prepare(frame)
        self._way = way
        if way.arrival <= now and all(way.end[axis].position == place for axis, place in self._start.items()):
            return False
        self._go_to_start(spare - (way.arrival - now))
        return True

    def next_motion(self, now: float) -> float:
        if now < self._way.arrival - SAME_TIME:
            return now
        if math.isinf(self._pressed) or not self.meets_slot:
            return math.inf
        return max(now, self._pressed + self._run.next_motion(now - self._pressed))

    def time(self, now: float) -> float:
        return now - self._base

    def when(self, time: float, now: float) -> float:  # noqa: ARG002 - it keeps the clock's pace
        return self._base + time

    def skip(self, now: float, seconds: float) -> int:
        self._turn_back(now)
        ready = self._way.arrival + self._settle + RAMP
        slots = max(1, math.ceil((ready - self._pressed) / seconds - SAME_TIME))
        self._base += slots * seconds
        return slots

    def pause(self, now: float) -> None:
        self._turn_back(now)
        self._held, self._base = self._base, math.inf

    def resume(self, now: float, time: float, lead: float) -> None:
        self._base = max(self._held, now + lead - time, self._way.arrival + self._settle + lead - time)

    @property
    def _pressed(self) -> float:
        """When the shutter is due, on the loop's clock: the time 0 of the run."""
        return self._base + self._slots.at(self._frame)

    @property
    def _start(self) -> Mapping[Axis, float]:
        """Where the run begins."""
        return {axis: float(of.starts[self._frame]) for axis, of in self._runs.items()}

    def _prepare(self, frame: int) -> None:
        self._frame, self._run = frame, Move({axis: of.track(frame) for axis, of in self._runs.items()})

    def _is_running(self, now: float) -> bool:
        """Whether the run has begun, and nothing else has since."""
        return self.meets_slot and now >= self._pressed - RAMP - SAME_TIME

    def _run_out(self, now: float) -> Way:
        """What is left of the run, if anything."""
        way = Way(now, self.at(now))
        if self._is_running(now) and now < self._pressed + self._run.duration:
            way.along(self._pressed, self._run)
        return way

    def _turn_back(self, now: float) -> None:
        """Where the run has begun, to its end and then to where it begins."""
        if self._is_running(now):
            self._way = self._run_out(now)
            self._go_to_start(0.0)

    def _go_to_start(self, spare: float) -> None:
        """From the end of the way so far to where the run begins, in `spare` s if that can be."""
        gentle = rest_to_rest(self._way.end, self._start, self._limits, GENTLE).duration
        self._way.on(self._start, self._limits, STEP_SHARE, min(gentle, max(0.0, spare)))


def mover_of(timelapse: Timelapse, executor: Executor | None = None) -> Mover:
    """What takes the axes through a timelapse; a glide's changes of speed are searched for by `executor`."""
    if timelapse.continuous:
        return GlideMover(timelapse, executor)
    return StepMover(timelapse) if timelapse.runs is None else GoMotionMover(timelapse, timelapse.runs)

"""One exposure of a go-motion as a job: from rest to rest, with a ramp of exactly 1 s on each side of the exposure."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence

from teleop.core.axes import Axis, Motion
from teleop.core.errors import TeleopError
from teleop.core.events import SourceEvent, Tick
from teleop.core.interfaces import Feedback
from teleop.core.setpoints import Demand, StateTarget
from teleop.planner.go_motion import RAMP, ExposureRuns
from teleop.planner.trajectory import Move
from teleop.remote.jobs import Ended

NEAR = 1e-4  # units from where the run begins


class GoMotionJob:
    """`runs` are each axis's, of one frame. Raises TeleopError for a run that the limits of an axis do not allow."""

    title = "go-motion"

    def __init__(self, owner: str, runs: Mapping[Axis, ExposureRuns], ended: Ended) -> None:
        self.owner, self.ended = owner, ended
        self._move = Move({axis: run.track(0) for axis, run in runs.items()})
        self._starts = {axis: float(run.starts[0]) for axis, run in runs.items()}
        self._pressed = 0.0
        for axis, run in runs.items():
            if over := run.over():
                raise TeleopError(f"go-motion: {axis} would exceed its {over} limit")

    @property
    def axes(self) -> Collection[Axis]:
        return self._starts

    def check_start(self, motion: Motion) -> None:
        """Raises TeleopError unless every axis rests where its run begins."""
        for axis, start in self._starts.items():
            state = motion[axis]
            if state.velocity or state.acceleration or abs(state.position - start) > NEAR:
                raise TeleopError(f"go-motion: {axis} must rest at {start:g} first")

    def start(self, now: float, motion: Motion) -> None:  # noqa: ARG002 - `check_start` has seen it
        self._pressed = now + RAMP

    def read(self, now: float, _feedback: Feedback) -> tuple[Demand, Sequence[SourceEvent]]:
        return {axis: StateTarget(*state) for axis, state in self._move.at(now - self._pressed).items()}, ()

    def done(self, tick: Tick) -> bool:
        rest = all(not tick.motion[axis].velocity for axis in self._starts)
        return rest and tick.time >= self._pressed + self._move.duration

    def halt(self, now: float, why: str) -> bool:  # noqa: ARG002 - it cannot be resumed
        return True

    outranked = halt

    def foreseen(self, time: float) -> Motion:
        return self._move.at(time - self._pressed)

"""What a client's commands do that send axes to places: goto, jog, focus, recenter, and one exposure of a go-motion."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping

from teleop.core.axes import Axis, Limits, Motion
from teleop.manual.operator import CENTERED
from teleop.manual.recall import at_rest, reachable
from teleop.planner.go_motion import ExposureRuns
from teleop.planner.shortest import shortest_seconds
from teleop.remote.asked import Asked, Refusal
from teleop.remote.go_motion_job import GoMotionJob
from teleop.remote.jobs import JobSource, WayJob
from teleop.remote.permission import Permission

JOG_TIME = 0.5  # s that a jog takes at least, unless it says otherwise
SLACK = 1e-6


class WayActions:
    """`recall` is how long the way to the center takes (s), `motion` is where the axes are."""

    def __init__(
        self,
        limits: Mapping[Axis, Limits],
        recall: float,
        jobs: JobSource,
        may: Permission,
        motion: Callable[[], Motion],
    ) -> None:
        self._limits, self._recall, self._jobs, self._may, self._motion = limits, recall, jobs, may, motion
        self.do: Mapping[str, Callable[[Asked, float], None]] = {
            "goto": lambda asked, _now: self.go("goto", asked, dict(asked["axes"]), asked.get("seconds")),
            "go_motion": self._go_motion,
            "jog": self._jog,
            "focus": lambda asked, _now: self.go("focus", asked, {Axis.FOCUS: asked["to"]}, asked.get("seconds")),
            "recenter": self._recenter,
        }

    def go(self, title: str, asked: Asked, targets: dict[Axis, float], seconds: float | None) -> None:
        """Send axes to places, in so many s or as soon as the limits allow. Raises Refusal."""
        self._may.begin()
        where = {axis: self._place(axis, to) for axis, to in targets.items()}
        if not where:
            raise Refusal(f"{title} has no axis of this rig")
        if asked.get("seconds") and not asked.get("stretch", False):
            self._refuse_haste(title, where, asked["seconds"])
        speeds = asked.get("speeds")
        if speeds and seconds:
            raise Refusal(f"{title}: give seconds or speeds, not both")
        asked.accept()
        self._jobs.begin(WayJob(title, asked.command.session, where, seconds, asked.end, speeds))

    def _go_motion(self, asked: Asked, now: float) -> None:  # noqa: ARG002 - every action gets it
        self._may.begin()
        before, places, after = asked["before"], asked["axes"], asked["after"]
        if not before.keys() == places.keys() == after.keys():
            raise Refusal("go-motion: axes, before and after must name the same axes")
        for axis, place in places.items():
            self._place(axis, place)
        shape = asked["blur"], asked["exposure"]
        runs = {
            axis: ExposureRuns.once(before[axis], places[axis], after[axis], *shape, self._limits[axis])
            for axis in places
        }
        job = GoMotionJob(asked.command.session, runs, asked.end)
        job.check_start(self._motion())
        asked.accept()
        self._jobs.begin(job)

    def _refuse_haste(self, title: str, where: Mapping[Axis, float], seconds: float) -> None:
        """Raises Refusal where the limits do not allow it in the time that was asked for."""
        least = shortest_seconds(self._motion(), where, self._limits)
        if seconds < least - SLACK:
            least = math.ceil(least * 100) / 100  # what is named is long enough
            raise Refusal(f"{title} in {seconds:g} s is too short: the limits of this rig need {least:.2f} s")

    def _place(self, axis: Axis, to: float) -> float:
        """Where an axis goes that is sent to `to`; raises Refusal for one that cannot."""
        if axis not in self._limits or axis.is_stick:
            raise Refusal(f"{axis} is not an axis of this rig that can be sent to a place")
        limits = self._limits[axis]
        if not limits.minimum - SLACK <= to <= limits.maximum + SLACK:
            raise Refusal(f"{axis}: {to:g} is outside the soft limits ({limits.minimum:g}..{limits.maximum:g})")
        return reachable(to, limits, self._motion()[axis].position)

    def _jog(self, asked: Asked, now: float) -> None:  # noqa: ARG002 - every action gets it
        axis, job = asked["axis"], self._jobs.job
        if axis not in self._limits or axis.is_stick:
            raise Refusal(f"{axis} is not an axis of this rig that can be jogged")
        limits = self._limits[axis]
        if isinstance(job, WayJob) and job.title == "jog" and set(job.axes) == {axis}:
            start = job.targets[axis]
        else:
            start = at_rest(self._motion()[axis], limits).position
        target = min(max(start + asked["by"], limits.minimum), limits.maximum)
        if target == start:
            raise Refusal(f"{axis} is at its soft limit")
        self._may.begin()
        asked.accept()
        seconds = asked.get("within", JOG_TIME)
        self._jobs.begin(WayJob("jog", asked.command.session, {axis: target}, seconds, asked.end))

    def _recenter(self, asked: Asked, now: float) -> None:  # noqa: ARG002
        targets = {axis: 0.0 for axis in CENTERED if axis in self._limits}
        self.go("recenter", asked, targets, asked.get("seconds", self._recall))

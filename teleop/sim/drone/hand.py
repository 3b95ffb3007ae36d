"""A hand that turns and lifts a simulated drone whose motors are off, as a commissioning asks for."""

from __future__ import annotations

import math
from dataclasses import dataclass

from teleop.sim.drone.flight import Pose

Place = tuple[float, float, float, float]  # roll, pitch and yaw in rad, height in m
_REST: Place = (0.0, 0.0, 0.0, 0.0)


@dataclass
class Hand:
    """Where it holds the drone, against how that stands; it moves at constant speed from `since` to `until` (s)."""

    before: Place = _REST
    target: Place = _REST
    since: float = -math.inf
    until: float = -math.inf

    def move(self, now: float, target: Place, seconds: float) -> None:
        """To `target` within so many seconds."""
        self.before, self.target, self.since, self.until = self._at(now), target, now, now + seconds

    def held(self, pose: Pose, now: float) -> Pose:
        """The pose of a drone that would be at `pose` without the hand."""
        roll, pitch, yaw, height = self._at(now)
        rates = self.rates(now)
        return pose._replace(
            roll=pose.roll + roll,
            pitch=pose.pitch + pitch,
            yaw=math.remainder(pose.yaw + yaw, math.tau),
            height=pose.height + height,
            climb=pose.climb + rates[3],
            yaw_rate=pose.yaw_rate + rates[2],
        )

    def rates(self, now: float) -> Place:
        """How fast it moves: of roll, pitch and yaw in rad/s, up in m/s."""
        if not self.since <= now < self.until:
            return _REST
        seconds = self.until - self.since
        roll, pitch, yaw, height = (
            (end - begin) / seconds for begin, end in zip(self.before, self.target, strict=True)
        )
        return roll, pitch, yaw, height

    def _at(self, now: float) -> Place:
        if now >= self.until:
            return self.target
        share = (now - self.since) / (self.until - self.since)
        roll, pitch, yaw, height = (
            begin + share * (end - begin) for begin, end in zip(self.before, self.target, strict=True)
        )
        return roll, pitch, yaw, height

"""The motors as Dragonframe knows them: each is an axis of the rig, in whole steps from a zero of its own."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from teleop.config.exchange.dfmoco import DfmocoSection
from teleop.core.axes import Axis, Limits

RATE, SLOWEST, FASTEST = 5000, 100, 20000  # steps/s
JOG = 0.5  # s that a jog goes on after its command, until it comes to rest: a release that is lost ends it
SLACK = 1e-6  # units
EXACT = 1e-4  # units, as a state has them
NEAR_ANGLE, NEAR = 0.5, 0.02  # deg and share of focus: as near as a reading must be, as for every way of the rig


class Motor:
    """`limits` are None for an axis that the rig does not have: it stays where it is."""

    def __init__(self, axis: Axis, scale: float, limits: Limits | None) -> None:
        self.axis, self.scale, self.limits = axis, scale, limits
        self.rate = RATE
        self._zero = 0  # steps of the rig's own zero
        self._state: Mapping[str, Any] = {}

    def update(self, state: Mapping[str, Any]) -> None:
        """The newest state of the rig."""
        self._state = state.get("axes", {}).get(self.axis.value, {})

    @property
    def is_known(self) -> bool:
        """Whether it was measured at least once, or is none of the rig's."""
        return self.limits is None or self._state.get("measured") is not None

    @property
    def place(self) -> float:
        """Where it is commanded to be, in units."""
        return self._state.get("commanded") or 0.0

    def is_at(self, place: float) -> bool:
        """Whether it is commanded to be there, and was measured to be there by and by."""
        measured, near = self._state.get("measured"), NEAR_ANGLE if self.axis.is_angle else NEAR
        return abs(self.place - place) < EXACT and (measured is None or abs(measured - place) < near)

    @property
    def speed(self) -> float:
        """In steps/s."""
        return (self._state.get("speed") or 0.0) * self.scale

    @property
    def position(self) -> int:
        """In steps: as with the firmware, what is commanded."""
        return self.steps(self.place)

    @position.setter
    def position(self, steps: int) -> None:
        self._zero += steps - self.position

    def steps(self, place: float) -> int:
        return round(place * self.scale) + self._zero

    def target(self, steps: int) -> float:
        """The place that a number of steps is, in units."""
        return (steps - self._zero) / self.scale

    def set_rate(self, rate: int) -> None:
        self.rate = min(max(rate, SLOWEST), FASTEST)

    @property
    def fastest(self) -> float:
        """In unit/s."""
        return self.rate / self.scale

    def reaches(self, place: float) -> bool:
        limits = self.limits
        return limits is not None and limits.minimum - SLACK <= place <= limits.maximum + SLACK

    def jog(self, steps: int, share: float) -> tuple[float, float] | None:
        """Where a jog towards `steps` goes for now, and how fast, in units; None for one that is to stop.

        So far that it begins to come to rest in 0.5 s, as with the firmware: the next command takes it further.
        """
        limits, way = self.limits, self.target(steps) - self.place
        velocity = self.fastest * share
        if limits is None or not way or not velocity or self.speed * way < 0:
            return None
        velocity = min(velocity, limits.velocity)
        now = min(abs(self.speed) / self.scale, velocity)
        gain = min(JOG, (velocity - now) / limits.acceleration)
        reached = now + limits.acceleration * gain
        far = (now + reached) / 2 * gain + (JOG - gain) * reached + reached**2 / (2 * limits.acceleration)
        goal = self.place + math.copysign(min(far, abs(way)), way)
        return min(max(goal, limits.minimum), limits.maximum), velocity


def motors_of(section: DfmocoSection, limits: Mapping[Axis, Limits]) -> list[Motor]:
    axes = [Axis(name) for name in section.motors]
    return [
        Motor(axis, section.steps_per_degree if axis.is_angle else section.focus_steps, limits.get(axis))
        for axis in axes
    ]

"""Axes on their way to a position: a preset, the centre, or as many units on as a dial or a key has asked for.

All of it belongs to the input that asked, and stops with it. Targets are cut to the soft limits here as the planner
would, because "there" has to be said exactly; on an axis that turns for ever they are the nearest turn's.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

from teleop.motion import Axis, Goto, Limits, Motion, State, Wish
from teleop.planner.stop import stop_state
from teleop.sources.arming import Arming

THERE = 1e-6  # units


def reachable(target: float, limits: Limits, position: float) -> float:
    """Where an axis at `position` goes when it is sent to `target`."""
    if limits.continuous:
        return target + 360 * round((position - target) / 360)
    return min(max(target, limits.minimum), limits.maximum)


def _is_at(state: State, target: float) -> bool:
    return abs(state.position - target) < THERE and state.velocity == 0 and state.acceleration == 0


@dataclass(frozen=True)
class Recall:
    """Axes that arrive together at `targets`, `seconds` after `begun` or as soon after that as their limits allow."""

    title: str
    asker: Arming
    targets: Mapping[Axis, float]
    begun: float
    seconds: float

    def wishes(self) -> dict[Axis, Wish]:
        return {axis: Goto(target, self.seconds) for axis, target in self.targets.items()}

    def is_over(self, motion: Motion) -> bool:
        return all(_is_at(motion[axis], target) for axis, target in self.targets.items())

    @property
    def end(self) -> float:
        return self.begun + self.seconds


class Jog:
    """Axes moved on by steps: each has a target that further steps move on."""

    def __init__(self, limits: Mapping[Axis, Limits]) -> None:
        self._limits = limits
        self._targets: dict[Axis, tuple[float, Arming]] = {}

    def step(self, axis: Axis, units: float, state: State, asker: Arming) -> bool:
        """Move the target of an axis on from where it is, or from where the axis would come to rest.

        Returns whether a soft limit cut the step.
        """
        limits = self._limits[axis]
        rest = stop_state(state, limits.acceleration, limits.jerk, math.inf).position
        wanted = (self._targets[axis][0] if axis in self._targets else rest) + units
        target = min(max(wanted, limits.minimum), limits.maximum)
        self._targets[axis] = target, asker
        return target != wanted

    def slide(self, axis: Axis, share: float, asker: Arming) -> None:
        """Send an axis to so much (0..1) of the way between its soft limits; one that has none stays."""
        limits = self._limits[axis]
        if not limits.continuous:
            self._targets[axis] = limits.minimum + share * (limits.maximum - limits.minimum), asker

    def drop(self, axis: Axis) -> None:
        self._targets.pop(axis, None)

    def clear(self) -> None:
        self._targets.clear()

    def wishes(self, motion: Motion) -> dict[Axis, Wish]:
        """What is still to be done by askers that are still trusted; the rest is forgotten."""
        self._targets = {
            axis: (target, asker)
            for axis, (target, asker) in self._targets.items()
            if asker.trusted and not _is_at(motion[axis], target)
        }
        return {axis: Goto(target) for axis, (target, _) in self._targets.items()}

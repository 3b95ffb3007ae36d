"""Axes on their way to a position that an operator asked for by a press: a preset, or the center.

It belongs to the input that asked, and stops with it. Targets are cut to the soft limits here as the planner
would, because a recalled place has to be exact; on an axis that turns for ever they are the nearest turn's.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

from teleop.core.axes import Axis, Limits, Motion, State
from teleop.core.guard_stop import stop_state
from teleop.core.setpoints import PositionTarget, Setpoint
from teleop.manual.interlock import Interlock

THERE = 1e-6  # units


def reachable(target: float, limits: Limits, position: float) -> float:
    """Where an axis at `position` goes when it is sent to `target`."""
    if limits.continuous:
        return target + 360 * round((position - target) / 360)
    return min(max(target, limits.minimum), limits.maximum)


def at_rest(state: State, limits: Limits) -> State:
    """Where an axis ends that stops now as fast as its limits allow."""
    return stop_state(state, limits.acceleration, limits.jerk, math.inf)


def is_at(state: State, target: float) -> bool:
    return abs(state.position - target) < THERE and state.velocity == 0 and state.acceleration == 0


@dataclass(frozen=True)
class Recall:
    """Axes that arrive together at `targets`, `seconds` after `begun` or as soon after that as their limits allow."""

    title: str
    asker: Interlock
    targets: Mapping[Axis, float]
    begun: float
    seconds: float

    def setpoints(self) -> dict[Axis, Setpoint]:
        return {axis: PositionTarget(target, self.seconds) for axis, target in self.targets.items()}

    def is_over(self, motion: Motion) -> bool:
        return all(is_at(motion[axis], target) for axis, target in self.targets.items())

    @property
    def end(self) -> float:
        return self.begun + self.seconds

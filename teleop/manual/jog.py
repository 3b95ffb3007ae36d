"""Axes moved on by steps (keys, wheels, dials) and sent to places by sliders.

A step moves the target of its axis on. A terminal repeats a held key thirty times a second and a wheel clicks as fast
as it is turned, so the steps are not simply added up: a target is never further ahead of where the axis could come to
rest than one step. Steps that come within HELD_WITHIN of each other are a key that is held, or a wheel that is turned:
when the next one does not come in that time, the axis stops as fast as its limits allow. A step on its own is made in
full.

All of it belongs to the input that asked, and stops with it. Steps keep to the speed range, as sticks do; a slider does
not, because the axis is to be where the slider is.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from teleop.core.axes import Axis, Limits, Motion, State
from teleop.core.setpoints import PositionTarget, Setpoint, VelocityTarget
from teleop.manual.interlock import Interlock
from teleop.manual.recall import at_rest, is_at

HELD_WITHIN = 0.15  # s: the slowest usual repeats of a held key come 0.09 s apart, taps of one finger 0.16 s and more
_SLACK = 1e-6  # units


@dataclass
class _Target:
    """Where an axis is sent, and by whom; `last` is when a step last moved it on (s), `sign` which way.

    `held`: steps follow each other closely. `stops`: they have ended, and the axis comes to rest where it can.
    """

    position: float
    asker: Interlock
    last: float
    sign: float
    slides: bool = False
    held: bool = False
    stops: bool = False


class Jog:
    """Axes moved on by steps; `limits` are theirs."""

    def __init__(self, limits: Mapping[Axis, Limits]) -> None:
        self._limits = limits
        self._targets: dict[Axis, _Target] = {}

    def step(self, axis: Axis, units: float, state: State, asker: Interlock, now: float, click: float = 0.0) -> bool:
        """Move the target of an axis on by `units`, of which one step is `click` (0: all of it).

        Returns whether a soft limit cut the step.
        """
        limits, before = self._limits[axis], self._targets.get(axis)
        rest, one = at_rest(state, limits).position, min(click or abs(units), abs(units))
        sign = 1.0 if units > 0 else -1.0
        several = abs(units) > one * (1 + 1e-9)
        start = rest if before is None or before.stops else before.position
        furthest = max(start * sign, rest * sign + one) * sign  # what an earlier, longer step has asked for stays
        wanted = min((start + units) * sign, furthest * sign) * sign
        target = min(max(wanted, limits.minimum), limits.maximum)
        held = several or (before is not None and before.sign == sign and now - before.last <= HELD_WITHIN)
        self._targets[axis] = _Target(target, asker, now, sign, held=held)
        return target != wanted

    def slide(self, axis: Axis, share: float, asker: Interlock, now: float) -> None:
        """Send an axis to so much (0..1) of the way between its soft limits; one that has none stays."""
        limits = self._limits[axis]
        if not limits.continuous:
            place = limits.minimum + share * (limits.maximum - limits.minimum)
            self._targets[axis] = _Target(place, asker, now, 0.0, slides=True)

    def drop(self, axis: Axis) -> None:
        self._targets.pop(axis, None)

    def clear(self) -> None:
        self._targets.clear()

    def setpoints(self, now: float, motion: Motion, share: float) -> dict[Axis, Setpoint]:
        """Setpoints of the targets whose inputs are still unlocked; the others are dropped.

        `share` is the most of its velocity that a step may give an axis.
        """
        demand: dict[Axis, Setpoint] = {}
        for axis, target in list(self._targets.items()):
            limits, state = self._limits[axis], motion[axis]
            if target.held and now - target.last > HELD_WITHIN and not target.stops:
                target.stops = abs(target.position - at_rest(state, limits).position) > _SLACK
                target.held = False
            rests = state.velocity == 0 and state.acceleration == 0
            if not target.asker.unlocked or (rests if target.stops else is_at(state, target.position)):
                del self._targets[axis]
            elif target.stops:
                demand[axis] = VelocityTarget(0.0)
            else:
                demand[axis] = PositionTarget(
                    target.position, velocity=None if target.slides else share * limits.velocity
                )
        return demand

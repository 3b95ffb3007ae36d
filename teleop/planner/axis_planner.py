"""One axis as the live planner keeps it: where it is, and what it may still do.

The invariant of live planning lives here: every committed state can be brought to rest by the guard stop without
leaving the limits; of a compiled move that turns right on a soft limit, it can be braked through its turn first. An
axis that starts outside its limits, or whose limits have just shrunk, has no such state, so its limits are widened to
what its own stop cannot avoid, and narrow again as it comes back. Outward motion is then impossible by the same rule
that guards a soft limit.
"""

from __future__ import annotations

import math

from teleop.core.axes import Axis, Limits, State
from teleop.core.guard_stop import brake_reach, brake_state, inevitable_velocity, stop_reach, stop_state

SLACK = 1e-8  # units; Ruckig's own tolerance on positions
INSET = 1e-7  # units inside the soft limit that a stick comes to rest, so that Ruckig's tolerance stays inside too
ROUNDED = 1 + 1e-9  # relative, what rounding may add to a limit
RESIDUE = 1e-9  # unit/s outward that is rounding, not motion
GENTLEST = 1e-3  # an operator's limit below this share of the axis's own would divide by zero


def _stopping_distance(velocity: float, acceleration: float, jerk: float) -> float:
    """More than any stop can need from at most `velocity`, the acceleration still rising included."""
    return velocity * ((velocity / acceleration + acceleration / jerk) / 2 + acceleration / jerk)


class AxisPlanner:
    """One axis' state, its limits as they are in force, and the gentler ones an operator asked for."""

    def __init__(self, axis: Axis, limits: Limits, state: State) -> None:
        self.axis = axis
        self.limits = limits
        self.fastest = limits.velocity
        self.state = State(*state)
        self._stop = limits.acceleration, limits.jerk  # of the guard stop: never more, or it would lengthen on the way
        self.now = self.gentle = self.guard = self._stop  # `now`: for this tick's ordinary plan
        self.narrow()

    def narrow(self) -> None:
        """Bring the limits in force as close to the axis's own as its state allows."""
        limits, (position, velocity, acceleration) = self.limits, self.state
        guard = max(limits.acceleration, abs(acceleration)), limits.jerk
        inevitable = inevitable_velocity(velocity, acceleration, limits.jerk)
        low, high = stop_reach(velocity, acceleration, *self._stop)
        self.low = min(limits.minimum, position + low)
        self.high = max(limits.maximum, position + high)
        # Where a step that ends inside may still reach: beyond a soft limit only if that is no longer to be helped.
        self._inner_low = self.low if low < 0.0 else limits.minimum
        self._inner_high = self.high if high > 0.0 else limits.maximum
        self.velocity = max(limits.velocity, abs(velocity), abs(inevitable))
        self.guard = guard
        self.gentle = self.now = guard
        # What a step that a reference asks for may have: velocity, acceleration, jerk.
        self.bounds = self.velocity * ROUNDED, guard[0] * ROUNDED, guard[1] * ROUNDED
        self.margin = self.gentle_margin = _stopping_distance(self.velocity, *guard)
        self.outside = (
            self.low < limits.minimum
            or self.high > limits.maximum
            or self.velocity > limits.velocity
            or guard[0] > limits.acceleration
        )
        self._clear()

    def _clear(self) -> None:
        """Between `clear_low` and `clear_high` no stop, however gentle, can reach a soft limit."""
        margin = math.inf if self.outside else max(self.margin, self.gentle_margin)
        self.clear_low, self.clear_high = self.low + margin, self.high - margin

    @property
    def rests(self) -> bool:
        return self.state[1] == 0.0 and self.state[2] == 0.0

    def holds(self, velocity: float) -> bool:
        """Whether it is at rest and stays: asked for no velocity, or for one into the soft limit that it lies on."""
        position, speed, rate = self.state
        if speed != 0.0 or rate != 0.0:
            return False
        if velocity > 0.0:
            return position >= self.high - 2 * INSET
        return velocity == 0.0 or (velocity < 0.0 and position <= self.low + 2 * INSET)

    def soften(self, acceleration: float | None, jerk: float | None) -> None:
        """Set `now` to an operator's limits, None being the axis's own, as long as the axis is inside them.

        Outside, Ruckig would first brake into them.
        """
        a, j = self.guard
        gentle = (
            a if acceleration is None else min(a, max(acceleration, GENTLEST * a)),
            j if jerk is None else min(j, max(jerk, GENTLEST * j)),
        )
        if gentle != self.gentle:
            self.gentle = gentle
            self.gentle_margin = _stopping_distance(self.velocity, *gentle)
            self._clear()
        _, speed, rate = self.state
        fastest = self.velocity * ROUNDED
        inside = abs(rate) <= gentle[0] and abs(inevitable_velocity(speed, rate, gentle[1])) <= fastest
        self.now = gentle if inside else self.guard

    def trips(self, state: State, gently: bool = False) -> int:
        """1 or -1 when a stop from `state` would pass the upper or lower soft limit, else 0.

        `gently` asks it of the operator's limits too, so that those are met before only the axis's own would do.
        """
        position, velocity, rate = state
        if self.outside:
            outward = inevitable_velocity(velocity, rate, self.guard[1])
            if position > self.limits.maximum and outward > RESIDUE:
                return 1
            if position < self.limits.minimum and outward < -RESIDUE:
                return -1
        lowest, highest = self.low, self.high
        if self.outside:
            lowest = min(self._inner_low, max(position, lowest))
            highest = max(self._inner_high, min(position, highest))
        tries = (self.now, self._stop) if gently and self.now is not self.guard else (self._stop,)
        for acceleration, jerk in tries:
            change = rate * rate / (2 * jerk)  # of velocity, while the acceleration goes to 0
            speed = abs(velocity) + change
            bound = speed * ((speed / acceleration + acceleration / jerk) / 2 + abs(rate) / jerk)  # on either reach
            down, up = velocity < -change, velocity > change  # and then it cannot turn on the way
            if (lowest if up else lowest + bound) < position < (highest if down else highest - bound):
                continue  # at a third of the cost of the exact reach
            low, high = stop_reach(velocity, rate, acceleration, jerk)
            if position + high > highest + SLACK:
                return 1
            if position + low < lowest - SLACK:
                return -1
        return 0

    def turns_inside(self, state: State) -> bool:
        """Whether the hardest braking from `state` keeps the soft limits: true of a move that turns on one."""
        position, velocity, rate = state
        acceleration, jerk = self.guard
        return (
            position + brake_reach(velocity, rate, acceleration, jerk) <= self.high + SLACK
            and position - brake_reach(-velocity, -rate, acceleration, jerk) >= self.low - SLACK
        )

    def guard_stop(self, seconds: float) -> State:
        """One step of what is always legal: the fastest stop.

        A move that turns on a soft limit is left no room to come to rest there: it is then braked through its turn.
        """
        position, velocity, rate = self.state
        low, high = stop_reach(velocity, rate, *self._stop)
        if position + high > self.high + SLACK:
            return brake_state(self.state, 1, *self.guard, seconds)
        if position + low < self.low - SLACK:
            return brake_state(self.state, -1, *self.guard, seconds)
        return stop_state(self.state, *self._stop, seconds)

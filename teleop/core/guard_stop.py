"""The guard stop: the fastest jerk-limited way to rest, in closed form.

The live planner may try anything as long as the state it ends in can still be stopped inside the soft limits; this
module says how far such a stop reaches and performs it. It is plain arithmetic on purpose: it is STOP and what
remains when a solver fails, so it has no case that can fail. From (v, a) the acceleration falls at -J to -peak, holds
there if peak is the limit A, and returns to 0 at +J; mirrored when the velocity that is left once the acceleration has
gone, v + a|a|/2J, is negative.
"""

from __future__ import annotations

import math
from collections.abc import Mapping

from teleop.core.axes import Axis, Limits, Motion, State

Phases = tuple[tuple[float, float], ...]  # (seconds, jerk in unit/s3), one after the other


def inevitable_velocity(velocity: float, acceleration: float, jerk: float) -> float:
    """The velocity (unit/s) reached when the acceleration is taken to 0 as fast as `jerk` allows."""
    return velocity + acceleration * abs(acceleration) / (2 * jerk)


def stop_phases(velocity: float, acceleration: float, max_acceleration: float, max_jerk: float) -> Phases:
    """The jerk over time of the fastest stop. An acceleration beyond its limit is first brought back to it."""
    sign = 1.0 if inevitable_velocity(velocity, acceleration, max_jerk) >= 0 else -1.0
    velocity, acceleration = sign * velocity, sign * acceleration
    peak = min(max_acceleration, math.sqrt(max(0.0, max_jerk * velocity + acceleration * acceleration / 2)))
    change = -peak - acceleration
    to_peak = abs(change) / max_jerk
    at_peak = velocity + (acceleration - peak) / 2 * to_peak
    hold = max(0.0, at_peak - peak * peak / (2 * max_jerk)) / peak if peak == max_acceleration else 0.0
    first = math.copysign(max_jerk, change)
    return ((to_peak, sign * first), (hold, 0.0), (peak / max_jerk, sign * max_jerk))


def stop_state(state: State, max_acceleration: float, max_jerk: float, seconds: float) -> State:
    """Where the fastest stop from `state` is after `seconds`; exactly at rest once it is over."""
    position, velocity, acceleration = state
    for duration, jerk in stop_phases(velocity, acceleration, max_acceleration, max_jerk):
        t = min(duration, seconds)
        position += t * (velocity + t * (acceleration / 2 + t * jerk / 6))
        velocity += t * (acceleration + t * jerk / 2)
        acceleration += t * jerk
        seconds -= t
        if seconds <= 0.0:
            return State(position, velocity, acceleration)
    return State(position)


def stop_reach(velocity: float, acceleration: float, max_acceleration: float, max_jerk: float) -> tuple[float, float]:
    """The lowest and highest displacement (units, <= 0 and >= 0) on the way of the fastest stop."""
    if velocity == 0.0 and acceleration == 0.0:
        return 0.0, 0.0
    mirrored = inevitable_velocity(velocity, acceleration, max_jerk) < 0
    if mirrored:
        velocity, acceleration = -velocity, -acceleration
    peak = min(max_acceleration, math.sqrt(max(0.0, max_jerk * velocity + acceleration * acceleration / 2)))
    jerk = max_jerk if acceleration < -peak else -max_jerk
    t = (-peak - acceleration) / jerk
    distance = t * (velocity + t * (acceleration / 2 + t * jerk / 6))
    at_peak = velocity + (acceleration - peak) / 2 * t
    ramp = peak * peak / (2 * max_jerk)
    if peak == max_acceleration and at_peak > ramp:
        distance += (at_peak * at_peak - ramp * ramp) / (2 * peak)
    distance += peak**3 / (6 * max_jerk * max_jerk)
    dip = 0.0
    if velocity < 0:
        t = (acceleration - math.sqrt(max(0.0, acceleration * acceleration + 2 * max_jerk * velocity))) / max_jerk
        dip = t * (velocity + t * (acceleration / 2 - t * max_jerk / 6))
    low, high = min(dip, distance), max(0.0, distance)
    return (-high, -low) if mirrored else (low, high)


def brake_reach(velocity: float, acceleration: float, max_acceleration: float, max_jerk: float) -> float:
    """How far (units, >= 0) an axis moving up goes on under the hardest braking, which is not at rest when it turns.

    The least any legal motion can manage; a stop that also ends at rest there needs a little more.
    """
    if velocity <= 0.0:
        return stop_reach(velocity, acceleration, max_acceleration, max_jerk)[1]
    t = (acceleration + math.sqrt(acceleration * acceleration + 2 * max_jerk * velocity)) / max_jerk
    t = min(t, max(0.0, (acceleration + max_acceleration) / max_jerk))
    left = velocity + t * (acceleration - t * max_jerk / 2)
    distance = t * (velocity + t * (acceleration / 2 - t * max_jerk / 6))
    return distance + max(0.0, left) ** 2 / (2 * max_acceleration)


def brake_state(state: State, side: int, max_acceleration: float, max_jerk: float, seconds: float) -> State:
    """Where the hardest braking of motion towards `side` (1 up, -1 down) is after `seconds`."""
    position, velocity, acceleration = (side * x for x in state)
    ramp = min(seconds, max(0.0, (acceleration + max_acceleration) / max_jerk))
    for t, jerk in ((ramp, -max_jerk), (seconds - ramp, 0.0)):
        position += t * (velocity + t * (acceleration / 2 + t * jerk / 6))
        velocity += t * (acceleration + t * jerk / 2)
        acceleration += t * jerk
    return State(side * position, side * velocity, side * acceleration)


def braked(motion: Motion, limits: Mapping[Axis, Limits], seconds: float) -> Motion:
    """Where every axis is `seconds` later, on the way to rest as fast as its own limits allow."""
    return {
        axis: stop_state(state, limits[axis].acceleration, limits[axis].jerk, seconds) for axis, state in motion.items()
    }


def longest_stop(motion: Motion, limits: Mapping[Axis, Limits]) -> float:
    """The time (s) in which the last axis can be at rest; an axis in a state without numbers does not count."""
    ramps = [_stop_time(state, limits[axis]) for axis, state in motion.items()]
    return max((ramp for ramp in ramps if math.isfinite(ramp)), default=0.0)


def _stop_time(state: State, limits: Limits) -> float:
    return sum(seconds for seconds, _ in stop_phases(*state[1:], limits.acceleration, limits.jerk))

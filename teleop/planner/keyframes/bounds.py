"""What no plan can do, found without a solver: necessary times, and by what the keys ask for more than the limits.

A rest to rest has its shortest time as a formula. Through keys, the mean value theorem holds: the k-th divided
difference of the positions, times k!, is the k-th derivative somewhere between them, whatever the move does there.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from teleop.core.axes import Limits
from teleop.planner.keyframes.program import HEADROOM, TOLERANCE
from teleop.planner.keyframes.segment import Segment
from teleop.planner.polynomial import Array

AT_REST = 3  # position, velocity and acceleration are known


def rest_to_rest(distance: float, limits: Limits) -> float:
    """The shortest time (s) over `distance` (units, >= 0) from rest to rest, within HEADROOM of the limits."""
    velocity, acceleration, jerk = (HEADROOM * each for each in (limits.velocity, limits.acceleration, limits.jerk))
    if distance >= velocity * _speeding_up(velocity, acceleration, jerk):
        return distance / velocity + _speeding_up(velocity, acceleration, jerk)
    if distance < 2 * acceleration**3 / jerk**2:
        return 4 * (distance / (2 * jerk)) ** (1 / 3)
    kick = acceleration * acceleration / jerk
    return 2 * _speeding_up((math.sqrt(kick * kick + 4 * acceleration * distance) - kick) / 2, acceleration, jerk)


def _speeding_up(velocity: float, acceleration: float, jerk: float) -> float:
    """Seconds to reach a velocity from rest."""
    if velocity * jerk < acceleration * acceleration:
        return 2 * math.sqrt(velocity / jerk)
    return velocity / acceleration + acceleration / jerk


def factors_needed(segment: Segment, limits: Limits, directed: bool = False) -> Array:
    """By what each interval, with its neighbors, exceeds V, A and J at least: (n, 3) of what the planner may use.

    A key at which the velocity is known too counts twice (0 where a `directed` segment turns), a rest three times.
    """
    allowed = [HEADROOM * each for each in (limits.velocity, limits.acceleration, limits.jerk)]
    count = len(segment.steps)
    at_rest = not np.any(segment.ends)
    if count == 1 and at_rest:
        step, duration = abs(float(segment.steps[0])), float(segment.durations[0])
        needed = (step / duration, 4 * step / duration**2, 32 * step / duration**3)
        return np.array([[each / most for each, most in zip(needed, allowed, strict=True)]])
    key = np.repeat(np.arange(count + 1), _known(segment, directed))
    times, differences = segment.times[key], segment.positions[key]
    factors = np.zeros((len(key) - 1, 3))
    for order, most in enumerate(allowed, start=1):
        if len(key) <= order:
            break
        spans = times[order:] - times[:-order]
        differences = np.divide(np.diff(differences) * order, spans, out=np.zeros_like(spans), where=spans > 0)
        ratios = np.abs(differences) / most
        for offset in range(order):  # each interval that the difference spans
            inside = factors[offset : offset + len(ratios), order - 1]
            np.maximum(inside, ratios, out=inside)
    return factors[np.diff(key) > 0]


def _known(segment: Segment, directed: bool) -> NDArray[np.intp]:
    """How much is known at each key (n + 1,): its position, with a velocity of 0, or at rest."""
    known = np.ones(len(segment.times), np.intp)
    if directed:
        way = np.sign(segment.steps)
        known[1:-1] += way[:-1] != way[1:]
    known[[0, -1]] = np.where(np.any(segment.ends != 0, axis=1), 1, AT_REST)
    return known


def least_time(segment: Segment, limits: Limits, interval: int) -> float:
    """The seconds that an interval needs whatever the others do: from rest to rest exactly, else more than that."""
    distance = abs(float(segment.steps[interval]))
    if len(segment.steps) == 1 and not np.any(segment.ends):
        return rest_to_rest(distance, limits)
    return distance / (HEADROOM * limits.velocity)


def is_beyond(segment: Segment, limits: Limits) -> bool:
    """Whether no solver need be asked: some key cannot be met in its time, whatever the way."""
    if len(segment.steps) == 1 and not np.any(segment.ends):
        least = rest_to_rest(abs(float(segment.steps[0])), limits)
        return least > float(segment.durations[0]) * TOLERANCE
    return bool(np.any(factors_needed(segment, limits) > TOLERANCE))

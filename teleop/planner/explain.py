"""Why keyframes cannot be met, in terms of what to change: the segment, the limit, by how much, and the time it needs.

An elastic programme finds the fewest limits that would have to give. The segments it blames are then lengthened one
after the other by bisection, each with the planner's own finest rule, the ones still to come left without limits:
so each time is true for the planner that will be asked again, and all of them together make the move possible.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from teleop.motion import Axis, Limits
from teleop.planner.findings import Finding
from teleop.planner.leg import Leg
from teleop.planner.quadratic import HEADROOM, Rule, least_factors, solve

FINEST = Rule(pieces=8, directed=False)
BLAMED = 1 + 1e-3  # a factor above this is a limit that gives, not the solver's tolerance
PRECISION = 0.005  # relative, of the shortest time
LONGEST = 2.0**20  # times the duration asked for: nothing that time could mend needs more
LIMITS = ("velocity", "acceleration", "jerk")


def explain(axis: Axis, leg: Leg, wheres: Sequence[str], limits: Limits) -> list[Finding]:
    """The findings of a leg that no rule solves; `wheres` (n + 1,) name its keys."""
    factors = least_factors(leg, limits, FINEST)
    if factors is None:
        factors = np.ones((len(leg.steps), 3))
    too_fast = np.abs(leg.steps) / (HEADROOM * limits.velocity * leg.durations)
    factors[:, 0] = np.maximum(factors[:, 0], too_fast)
    worst = factors.max(axis=1)
    blamed = _culprits(
        leg, limits, [i for i in np.argsort(-worst).tolist() if worst[i] > BLAMED or i == worst.argmax()]
    )
    findings = []
    lengthened = leg
    for position, segment in enumerate(blamed):
        shortest = _shortest(lengthened, segment, limits, frozenset(blamed[position + 1 :]))
        if shortest is not None:
            lengthened = lengthened.stretched(segment, shortest)
        limit = int(factors[segment].argmax())
        findings.append(
            Finding(
                axis,
                wheres[segment],
                wheres[segment + 1],
                LIMITS[limit],
                float(factors[segment, limit]),
                float(leg.durations[segment]),
                shortest,
            )
        )
    return findings


def _culprits(leg: Leg, limits: Limits, suspects: list[int]) -> list[int]:
    """The suspects, in order, without those whose limits can be kept after all once the others have more time."""
    guilty = set(suspects)
    for segment in reversed(suspects):
        others = frozenset(guilty - {segment})
        if others and solve(leg, limits, FINEST, others) is not None:
            guilty.discard(segment)
    return sorted(guilty)


def _shortest(leg: Leg, segment: int, limits: Limits, relaxed: frozenset[int]) -> float | None:
    """The least duration of `segment`, whole milliseconds up, with which the leg is possible."""

    def possible(duration: float) -> bool:
        return solve(leg.stretched(segment, duration), limits, FINEST, relaxed) is not None

    low = high = float(leg.durations[segment])
    while not possible(high):
        low, high = high, high * 2
        if high > LONGEST * leg.durations[segment]:
            return None
    while high > low * (1 + PRECISION):
        middle = math.sqrt(low * high)
        low, high = (low, middle) if possible(middle) else (middle, high)
    return math.ceil(high * 1000) / 1000

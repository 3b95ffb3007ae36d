"""A move that follows a clock which is not its own, such as timecode: one change of its pace at a time, each checked.

The place that it is to have is known as a line over our clock. A change leads from the present pace to that line, where
it goes on with the line's rate: a quintic in the move's own time, so that nothing is sudden, and the shortest one that
keeps every axis within its limits on the very stretch of the move that it happens on.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from teleop.core.axes import Axis, Limits
from teleop.planner.keyframes.findings import PlanError
from teleop.planner.polynomial import HERMITE
from teleop.planner.time_scaling import TimeScaling, at_most, keeps_limits
from teleop.planner.trajectory import Move

HEADROOM = 0.998  # of V, A and J: what checking each few ms can miss
STEP = 0.004  # s between two instants that are checked
FASTEST = 2.0  # times its own speed, on the average of a change
DURATIONS = (0.3, 0.4, 0.5, 0.65, 0.8, 1.0, 1.25, 1.5, 2.0, 3.0, 4.5, 7.0, 10.0, 15.0, 22.0, 33.0, 50.0)
"""How long a change may last (s), tried in this order."""


class Reference(NamedTuple):
    """The place that a move is to have: `at` (s of the move) at `time` (s, our clock), and `rate` s of it in a s."""

    at: float
    time: float
    rate: float

    def place(self, now: float) -> float:
        return self.at + self.rate * (now - self.time)


def catch_up(
    move: Move, limits: Mapping[Axis, Limits], pace: TimeScaling, reference: Reference, start: float
) -> TimeScaling:
    """From `pace` to the reference, from `start` on (s, our clock), as soon as the limits allow; never backwards.

    Raises PlanError where no change does.
    """
    here, rate, change = pace.at(start)
    rate_after = min(reference.rate, steady_limit(move, limits))
    for duration in DURATIONS:
        there = reference.place(start + duration)
        if not 0 <= there - here <= FASTEST * duration:
            continue
        ends = np.array(
            [here, rate * duration, change * duration**2, there, rate_after * duration, 0.0]
        )  # as `HERMITE` has them: of both ends, over the whole duration as 1
        coefficients = (HERMITE @ ends) / duration ** np.arange(6)
        scaling = TimeScaling(start, duration, tuple(coefficients.tolist()), rate_after)
        if _legal(move, limits, scaling):
            return scaling
    behind = reference.place(start) - here
    raise PlanError(f"the limits keep the move from following: it is {abs(behind):.2f} s {_side(behind)}")


def steady_limit(move: Move, limits: Mapping[Axis, Limits]) -> float:
    """The highest rate at which the whole move may be followed: its own at least."""
    return max(1.0, min(FASTEST, at_most(move, limits, HEADROOM)))


def _side(behind: float) -> str:
    return "behind" if behind > 0 else "ahead"


def _legal(move: Move, limits: Mapping[Axis, Limits], scaling: TimeScaling) -> bool:
    """Whether it never goes back, and every axis keeps V, A and J during the change."""
    clock = np.linspace(0.0, scaling.duration, int(scaling.duration / STEP) + 2)
    rate = np.polynomial.Polynomial(scaling.coefficients).deriv()(clock)
    return bool(rate.min() >= -1e-9) and keeps_limits(move, limits, scaling, clock, HEADROOM)

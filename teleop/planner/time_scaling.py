"""Speed override, pause, resume, stepping back and starting in mid move: the move's own path, at another scaling.

The move is read at its own time s instead of the clock's, so it never leaves its path; v = p' s',
a = p'' s'^2 + p' s'', j = p''' s'^3 + 3 p'' s' s'' + p' s'''. A steady rate is legal up to what the move's peaks
leave (`at_most`). A change of rate is not, in general, so it is searched for: ever longer changes are tried on the very
stretch of the move they would happen on until every axis keeps its limits there, and only that one is returned. The
search takes milliseconds, so it happens outside the tick: ask for a moment a little ahead, and take the answer, or not.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from teleop.core.axes import Axis, Limits, State
from teleop.core.timing import whole_ticks
from teleop.planner.keyframes.findings import PlanError
from teleop.planner.polynomial import Array
from teleop.planner.trajectory import Move

HEADROOM = 0.97  # of V, A and J: what checking at instants can miss, and every sample must still be a single step
SHORTEST = 0.25  # s, of a change of rate
RUN_UP = 1.0  # s, the shortest: it may take longer than a pause, for which an operator waits
LONGER = 1.25  # factor from one trial to the next
TRIALS = 40  # the last is half an hour long
SAMPLES = 2000  # instants at which a change is checked


class NoRunUp(PlanError):  # noqa: N818 - what there is not
    """A move cannot be joined at that time."""


@dataclass(frozen=True)
class TimeScaling:
    """The move's time over the clock's: a polynomial from `start` (s, clock) for `duration`, then a steady `rate`.

    `coefficients` are ascending, of the move's time in seconds over seconds since `start`.
    """

    start: float
    duration: float
    coefficients: tuple[float, ...]
    rate: float

    def at(self, now: float) -> tuple[float, float, float]:
        """The move's time, its rate and the change of the rate (1/s) at `now` (s, clock)."""
        t = max(0.0, now - self.start)
        beyond = max(0.0, t - self.duration)
        t = min(t, self.duration)
        time = rate = change = 0.0
        for coefficient in reversed(self.coefficients):
            change = change * t + 2 * rate
            rate = rate * t + time
            time = time * t + coefficient
        if beyond > 0.0:
            return time + self.rate * beyond, self.rate, 0.0
        return time, rate, change


def steady(time: float, rate: float, now: float) -> TimeScaling:
    """At the move's `time` now, and on at `rate`."""
    return TimeScaling(now, 0.0, (time, rate), rate)


def at_most(move: Move, limits: Mapping[Axis, Limits], headroom: float = HEADROOM) -> float:
    """The highest steady rate at which the whole move keeps its limits; inf for a move without motion."""
    rate = np.inf
    for axis, peaks in move.peaks().items():
        of_axis = limits[axis]
        for peak, limit, order in (
            (peaks.velocity, of_axis.velocity, 1),
            (peaks.acceleration, of_axis.acceleration, 2),
            (peaks.jerk, of_axis.jerk, 3),
        ):
            if peak > 0:
                rate = min(rate, (headroom * limit / peak) ** (1 / order))
    return float(rate)


def state_at(move: Move, scaling: TimeScaling, now: float) -> dict[Axis, State]:
    """Where every axis is at `now` (s, clock); scalar and quick, for the tick."""
    time, rate, change = scaling.at(now)
    return {axis: State(p, v * rate, a * rate * rate + v * change) for axis, (p, v, a) in move.at(time).items()}


def change_rate(
    move: Move, limits: Mapping[Axis, Limits], scaling: TimeScaling, rate: float, now: float
) -> TimeScaling:
    """To `rate` from `now` on, as soon as the limits allow: 0 pauses, negative goes back. `now` may lie ahead.

    Raises PlanError for a rate beyond `at_most`, and when no change however long will do.
    """
    most = at_most(move, limits)
    if abs(rate) > most:
        raise PlanError(f"the move allows at most {100 * most:.0f} % of its speed, not {100 * abs(rate):.0f} %")
    time, current, change = scaling.at(now)

    def attempt(duration: float) -> TimeScaling:
        # s' is the cubic with s' and s'' given at the start, `rate` and 0 at the end
        rise = rate - current
        square = (3 * rise / duration - 2 * change) / duration
        cube = (change - 2 * rise / duration) / duration**2
        return TimeScaling(now, duration, (time, current, change / 2, square / 3, cube / 4), rate)

    return _first_legal(move, limits, attempt)


def go_to(move: Move, limits: Mapping[Axis, Limits], scaling: TimeScaling, time: float, now: float) -> TimeScaling:
    """From a pause at `now` to a pause at the move's `time`, along its path, back or forth: stepping to a key.

    Raises PlanError while the move is running.
    """
    here, current, change = scaling.at(now)
    if current or change:
        raise PlanError("the move is running: pause it before stepping to a key")
    distance = time - here
    if distance == 0.0:
        return steady(time, 0.0, now)

    def attempt(duration: float) -> TimeScaling:
        shape = (10 / duration**3, -15 / duration**4, 6 / duration**5)
        return TimeScaling(now, duration, (here, 0.0, 0.0, *(distance * x for x in shape)), 0.0)

    shortest = 15 / 8 * abs(distance) / max(at_most(move, limits), 1.0)
    return _first_legal(move, limits, attempt, max(SHORTEST, shortest / LONGER))


def run_up(move: Move, limits: Mapping[Axis, Limits], time: float, rate: float) -> TimeScaling:
    """From rest on the move's path, beginning at 0 s, to `rate` just where the move's `time` is: to start in mid move.

    It lasts whole hundredths of a second, so that on the loop's grid `time` is met by a tick. Raises NoRunUp.
    """
    if all(state[1:] == (0.0, 0.0) for state in move.at(time).values()):
        return steady(time, rate, 0.0)

    def attempt(duration: float) -> TimeScaling:
        duration = whole_ticks(duration)
        begin = time - rate * duration / 2
        return TimeScaling(0.0, duration, (begin, 0.0, 0.0, rate / duration**2, -rate / (2 * duration**3)), rate)

    try:
        return _first_legal(move, limits, attempt, RUN_UP)
    except PlanError:
        raise NoRunUp(f"the move cannot start at {time:g} s: no run-up keeps its limits there") from None


def _first_legal(
    move: Move, limits: Mapping[Axis, Limits], attempt: Callable[[float], TimeScaling], duration: float = SHORTEST
) -> TimeScaling:
    for _ in range(TRIALS):
        scaling = attempt(duration)
        if keeps_limits(move, limits, scaling, np.linspace(0.0, scaling.duration, SAMPLES)):
            return scaling
        duration *= LONGER
    raise PlanError("no change of speed, however slow, keeps the limits here: stop instead")


def keeps_limits(
    move: Move, limits: Mapping[Axis, Limits], scaling: TimeScaling, clock: Array, headroom: float = HEADROOM
) -> bool:
    """Whether every axis keeps V, A and J (`headroom` of them) at these times (s, from where the change begins)."""
    whole = np.polynomial.Polynomial(scaling.coefficients)
    rate, change, jolt = (whole.deriv(order)(clock) for order in (1, 2, 3))
    for axis, (_, v, a, j) in move.sample(whole(clock)).items():
        of_axis = limits[axis]
        for value, limit in (
            (v * rate, of_axis.velocity),
            (a * rate**2 + v * change, of_axis.acceleration),
            (j * rate**3 + 3 * a * rate * change + v * jolt, of_axis.jerk),
        ):
            if np.abs(value).max() > headroom * limit:
                return False
    return True

"""How a simulated motor moves: a plan made when a command arrives, evaluated afterwards at any moment.

A plan is a short run of segments, each a closed form of time: a commanded velocity, reached through a first-order lag.
Constant speed, holding still and coasting to rest are the same form with nothing lagging. Stops, expiries and ends of
travel are found when the plan is made. So reading a motor changes nothing, no error accumulates however often it is
read, and six hours of rest cost as much as none.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from typing import NamedTuple

SETTLED = 60.0  # lags after which nothing of a decaying motion is left in a double: exp(-60) < 1e-26


class Segment(NamedTuple):
    """From `start` (s): velocity `target` plus an `excess` (unit/s) that dies away with the time constant `lag` (s)."""

    start: float
    position: float
    target: float = 0.0
    excess: float = 0.0
    lag: float = 1.0

    def at(self, time: float) -> tuple[float, float]:
        """Position and velocity."""
        if self.target == 0.0 == self.excess:
            return self.position, 0.0
        elapsed = time - self.start
        decay = math.exp(-elapsed / self.lag)
        travelled = self.target * elapsed + self.excess * self.lag * (1.0 - decay)
        return self.position + travelled, self.target + self.excess * decay


class Motor:
    """One motor between two stops, in any unit; times are seconds of one clock and never go back.

    `lag` is the time constant of its velocity in s, `minimum` and `maximum` the stops, infinite for none. A motor that
    is beyond a stop, because the stop was moved, can only move back. One that is `held` stands still and
    drops every command.
    """

    def __init__(self, position: float, lag: float, minimum: float = -math.inf, maximum: float = math.inf) -> None:
        self.minimum, self.maximum = minimum, maximum
        self.held = False
        self._lag = lag
        self._plan: list[Segment] = [Segment(-math.inf, position)]

    def at(self, time: float) -> tuple[float, float]:
        """Position and velocity at a time not before the last command."""
        return next(segment for segment in reversed(self._plan) if segment.start <= time).at(time)

    def cruise(self, now: float, velocity: float, until: float) -> None:
        """Follow `velocity` through the lag up to the time `until`, then coast to rest; against a stop, stand still."""
        if self.held:
            return
        stages = [(until, velocity), (math.inf, 0.0)] if until > now else [(math.inf, 0.0)]
        position, speed = self.at(now)
        low, high = min(self.minimum, position), max(self.maximum, position)
        self._plan = list(_follow(Segment(now, position, 0.0, speed, self._lag), stages, low, high))

    def coast(self, now: float) -> None:
        """Come to rest through the lag."""
        self.cruise(now, 0.0, now)

    def halt(self, now: float) -> None:
        """Stand still at once."""
        self._plan = [Segment(now, self.at(now)[0])]

    def hold(self, now: float, held: bool) -> None:
        """A hand holds it at once, or releases it."""
        self.held = held
        self.halt(now)

    def place(self, position: float) -> None:
        """It is there, at rest, and always was."""
        self._plan = [Segment(-math.inf, position)]

    def travel(self, now: float, target: float, duration: float) -> None:
        """Go to `target`, or the stop before it, at constant speed in `duration` > 0 s."""
        self.visit(now, [(target, duration)])

    def visit(self, now: float, stations: Iterable[tuple[float, float]]) -> None:
        """Travel to each target in turn, each in its own duration in s."""
        if self.held:
            return
        position, plan = self.at(now)[0], []
        for target, duration in stations:
            reached = self.clamp(target)
            plan.append(Segment(now, position, (reached - position) / duration))
            now, position = now + duration, reached
        self._plan = [*plan, Segment(now, position)]

    def ease(self, now: float, target: float, lag: float) -> None:
        """Go to `target` or the stop before it, fast at first and slower with the time constant `lag` in s."""
        if self.held:
            return
        position, reached = self.at(now)[0], self.clamp(target)
        approach = Segment(now, position, 0.0, (reached - position) / lag, lag)
        self._plan = [approach, Segment(now + SETTLED * lag, reached)]

    def clamp(self, target: float) -> float:
        """The nearest position between the stops."""
        return min(max(target, self.minimum), self.maximum)


def _follow(state: Segment, stages: Iterable[tuple[float, float]], low: float, high: float) -> Iterator[Segment]:
    """The segments from `state` through the stages (end in s, velocity), standing still where a stop is in the way."""
    time, (position, speed), lag = state.start, state.at(state.start), state.lag
    for end, velocity in stages:
        while time < end:
            segment = Segment(time, position, velocity, speed - velocity, lag)
            yield segment
            hit = _first_hit(segment, end, low, high)
            if hit is None:
                time = end
                if math.isfinite(end):
                    position, speed = segment.at(end)
                break
            time, position, direction = hit
            speed = 0.0
            if velocity * direction >= 0.0:  # pushed on against the stop, or no more pushed at all
                yield Segment(time, position)
                time = end


def _first_hit(segment: Segment, end: float, low: float, high: float) -> tuple[float, float, float] | None:
    """When, before `end`, the segment first passes a stop, where that is, and in which direction (-1 or 1)."""
    start, _, target, excess, lag = segment
    if target == 0.0:
        end = min(end, start + SETTLED * lag)
    left = -target / excess if excess else 0.0  # share of the excess that is left when the motor turns round
    turn = start - lag * math.log(left) if 0.0 < left < 1.0 else end
    for begin, finish in ((start, min(turn, end)), (min(turn, end), end)):
        for stop, sign in ((low, -1.0), (high, 1.0)):
            if sign * (segment.at(finish)[0] - stop) > 0.0:
                return _crossing(segment, begin, finish, stop, sign), stop, sign
    return None


def _crossing(segment: Segment, begin: float, finish: float, stop: float, sign: float) -> float:
    """The time at which a segment that moves one way from `begin` to `finish` passes `stop`."""
    while begin < (middle := (begin + finish) / 2) < finish:  # as long as there is a double between them
        if sign * (segment.at(middle)[0] - stop) > 0.0:
            finish = middle
        else:
            begin = middle
    return finish

"""A stretch of a simulated motor's motion in closed form: the drive, a second-order mode behind it, and backlash.

The drive's position is q(t) = position + target*t + excess*lag*(1 - exp(-t/lag)), t counted from `start`. A swing is
the exact solution of x'' + 2*d*w*x' + w*w*x = w*w*q(t). Backlash is the play operator: the load stays until a flank of
the gap reaches it, which depends on every turn of the shaft since the start and on nothing in between.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from itertools import chain
from typing import NamedTuple

SETTLED = 60.0  # lags after which nothing of a decaying motion is left in a double: exp(-60) < 1e-26
LOOKS = 16  # looks per period of a swing for its turns
STILL = 1e-12  # units: a swing with less is over


class Swing(NamedTuple):
    """A second-order mode, `frequency` in rad/s, and its position and velocity at the start of a segment."""

    frequency: float
    damping: float
    position: float
    velocity: float


class Play(NamedTuple):
    """Backlash of `half` a gap to either side, and where the load is at the start of a segment."""

    half: float
    load: float


class Segment(NamedTuple):
    """From `start` (s): velocity `target` plus an `excess` (unit/s) that dies away with the time constant `lag` (s)."""

    start: float
    position: float
    target: float = 0.0
    excess: float = 0.0
    lag: float = 1.0
    swing: Swing | None = None
    play: Play | None = None

    def at(self, time: float) -> tuple[float, float]:
        """Position and velocity of the load."""
        position, velocity = self.shaft(time)
        if self.play is None:
            return position, velocity
        load, half = self.load(time), self.play.half
        flank = load + math.copysign(half, velocity)
        return load, velocity if abs(position - flank) <= STILL else 0.0

    def drive(self, time: float) -> tuple[float, float]:
        """Position and velocity of what obeys the commands."""
        if self.target == 0.0 == self.excess:
            return self.position, 0.0
        elapsed = time - self.start
        decay = math.exp(-elapsed / self.lag)
        travelled = self.target * elapsed + self.excess * self.lag * (1.0 - decay)
        return self.position + travelled, self.target + self.excess * decay

    def shaft(self, time: float) -> tuple[float, float]:
        """Position and velocity behind the swing and before the backlash."""
        if self.swing is None:
            return self.drive(time)
        elapsed = time - self.start
        rate, turn = self._poles()
        forced, cosine, sine = self._parts()
        fade, decay = math.exp(-rate * elapsed), math.exp(-elapsed / self.lag)
        wave = cosine * math.cos(turn * elapsed) + sine * math.sin(turn * elapsed)
        slope = sine * turn * math.cos(turn * elapsed) - cosine * turn * math.sin(turn * elapsed)
        position = self._line(elapsed) - forced * decay + fade * wave
        return position, self.target + forced * decay / self.lag + fade * (slope - rate * wave)

    def load(self, time: float) -> float:
        """Where the load is, which the shaft takes along by the flanks of the gap."""
        position = self.shaft(time)[0]
        if self.play is None:
            return position
        half, load = self.play
        for turn in self.turns(time):
            reached = self.shaft(turn)[0]
            load = min(max(load, reached - half), reached + half)
        return min(max(load, position - half), position + half)

    def turns(self, end: float) -> Iterator[float]:
        """When, before `end`, the shaft turns round."""
        if self.swing is None:
            left = -self.target / self.excess if self.excess else 0.0  # share of the excess that is left then
            turn = self.start - self.lag * math.log(left) if 0.0 < left < 1.0 else end
            if turn < end:
                yield turn
            return
        time, forward = self.start, self.shaft(self.start)[1] > 0.0
        look = 2 * math.pi / self.swing.frequency / LOOKS
        while time < end and self.reach(time) > STILL:
            before, time = time, min(time + look, end)
            if (self.shaft(time)[1] > 0.0) != forward:
                yield _first(lambda at: (self.shaft(at)[1] > 0.0) != forward, before, time)  # noqa: B023 - used at once
                forward = not forward

    def first_beyond(self, low: float, high: float, end: float) -> tuple[float, float, float] | None:
        """When, before `end`, the shaft first passes a stop, where that is, and in which direction (-1 or 1)."""
        if self.target == 0.0:
            slowest = self.lag if self.swing is None else max(self.lag, 1.0 / self._poles()[0])
            end = min(end, self.start + SETTLED * slowest)
        begin = self.start
        for finish in chain(self.turns(end), [end]):
            if not self._may_pass(begin, end, low, high):
                return None
            position = self.shaft(finish)[0]
            for stop, sign in ((low, -1.0), (high, 1.0)):
                if sign * (position - stop) > (STILL if self.swing else 0.0):
                    return _first(lambda at: sign * (self.shaft(at)[0] - stop) > 0.0, begin, finish), stop, sign  # noqa: B023
            begin = finish
        return None

    def stopped(self, time: float, stop: float) -> Segment:
        """The same drive from `time` on, after the shaft has hit a stop."""
        assert self.swing is not None
        position, velocity = self.drive(time)
        swing = self.swing._replace(position=stop, velocity=0.0)
        play = self.play and self.play._replace(load=self.load(time))
        return Segment(time, position, self.target, velocity - self.target, self.lag, swing, play)

    def reach(self, time: float) -> float:
        """How far the shaft can be from its straight line, from `time` on."""
        elapsed = time - self.start
        decaying = math.exp(-elapsed / self.lag)
        if self.swing is None:
            return abs(self.excess) * self.lag * decaying
        forced, cosine, sine = self._parts()
        return abs(forced) * decaying + math.hypot(cosine, sine) * math.exp(-self._poles()[0] * elapsed)

    def _may_pass(self, time: float, end: float, low: float, high: float) -> bool:
        ends = self._line(time - self.start), self._line(end - self.start)
        return min(ends) - self.reach(time) < low or max(ends) + self.reach(time) > high

    def _line(self, elapsed: float) -> float:
        """Where the shaft is once nothing of the excess and of the swing is left."""
        behind = 2 * self.swing.damping * self.target / self.swing.frequency if self.swing else 0.0
        travelled = self.target * elapsed if self.target else 0.0
        return self.position + self.excess * self.lag - behind + travelled

    def _poles(self) -> tuple[float, float]:
        """The decay rate and the angular frequency of the swing."""
        assert self.swing is not None
        frequency, damping = self.swing[:2]
        return frequency * damping, frequency * math.sqrt(1.0 - damping * damping)

    def _parts(self) -> tuple[float, float, float]:
        """How much of the excess is seen behind the swing; the swing's own cosine and sine."""
        assert self.swing is not None
        frequency, damping, position, velocity = self.swing
        pole = 1.0 / self.lag
        squared = frequency * frequency
        forced = self.excess * self.lag * squared / (pole * pole - 2.0 * damping * frequency * pole + squared)
        rate, turn = self._poles()
        cosine = position - self._line(0.0) + forced
        return forced, cosine, (velocity - self.target - forced * pole + rate * cosine) / turn


def _first(passed: Callable[[float], bool], begin: float, finish: float) -> float:
    """The first time at which `passed` is true, which it is at `finish`, and was not before."""
    while begin < (middle := (begin + finish) / 2) < finish:  # as long as there is a double between them
        if passed(middle):
            finish = middle
        else:
            begin = middle
    return finish

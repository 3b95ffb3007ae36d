"""Pieces of a flight in which nothing is newly asked for: level flight and climb, each a closed form of time.

Horizontal vectors are complex numbers, so that flying a curve is one multiplication: real is north (or forward),
imaginary east (or right).
"""

from __future__ import annotations

import cmath
import math
from dataclasses import dataclass

GRAVITY = 9.81  # m/s2
LAG = 0.5  # s: time constant of a speed that the autopilot holds
CLIMB_LAG = 0.4  # s
REST_SPEED = 1e-9  # m/s


@dataclass(frozen=True)
class Level:
    """Level flight from `start` on: a velocity that goes from `first` to `last` with `lag`.

    Both are in a frame that points to `heading` at the start and turns by `turn` rad/s: the nose's, or north. `tilt`
    is the attitude where that is what was asked for: None means the one that the acceleration needs.
    """

    start: float = 0.0
    place: complex = 0j
    first: complex = 0j
    last: complex = 0j
    lag: float = LAG
    heading: float = 0.0
    turn: float = 0.0
    tilt: complex | None = None
    to_north: bool = False

    def frame(self, time: float) -> complex:
        return cmath.exp(1j * (self.heading + self.turn * (time - self.start)))

    def along(self, time: float) -> complex:
        """The velocity in the frame."""
        return self.last + (self.first - self.last) * math.exp(-(time - self.start) / self.lag)

    def velocity(self, time: float) -> complex:
        return self.along(time) * self.frame(time)

    def at(self, time: float) -> complex:
        seconds = time - self.start
        fade = 1j * self.turn - 1 / self.lag
        half = self.turn * seconds / 2
        steady = (
            seconds * cmath.exp(1j * half) * (math.sin(half) / half if half else 1.0)
        )  # cancels nothing, however small
        fading = (cmath.exp(fade * seconds) - 1) / fade
        way = self.last * steady + (self.first - self.last) * fading
        return self.place + way * cmath.exp(1j * self.heading)

    def acceleration(self, time: float) -> complex:
        """In the frame, what the autopilot does with the attitude alone."""
        return (self.last - self.first) / self.lag * math.exp(-(time - self.start) / self.lag)


@dataclass(frozen=True)
class Climb:
    """Height from `start` on: a climb that goes from `first` to `last` with `lag`, or a fall."""

    start: float = 0.0
    height: float = 0.0
    first: float = 0.0
    last: float = 0.0
    lag: float = CLIMB_LAG
    falling: bool = False

    def rate(self, time: float) -> float:
        seconds = time - self.start
        if self.falling:
            return self.first - GRAVITY * seconds
        return self.last + (self.first - self.last) * math.exp(-seconds / self.lag)

    def at(self, time: float) -> float:
        seconds = time - self.start
        if self.falling:
            return self.height + self.first * seconds - GRAVITY * seconds**2 / 2
        gone = (self.first - self.last) * self.lag * -math.expm1(-seconds / self.lag)
        return self.height + self.last * seconds + gone

    def touchdown(self, now: float) -> float:
        """When between `start` and `now` it comes down to the ground; inf for not yet."""
        high, low = self.start, now
        if not self.falling and self.first < 0 < self.last:  # the bottom of a descent that turns into a climb
            low = min(low, high + self.lag * math.log((self.last - self.first) / self.last))
        if low <= high or self.at(low) > 0 or self.rate(low) > REST_SPEED:
            return math.inf
        if not self.falling and self.first > 0 > self.last:  # the top of a climb that turns into a descent
            high += self.lag * math.log((self.first - self.last) / -self.last)
        for _ in range(60):
            middle = (high + low) / 2
            high, low = (middle, low) if self.at(middle) > 0 else (high, middle)
        return low

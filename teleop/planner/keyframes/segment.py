"""A segment: one axis from rest, through its keys, to rest, as arrays. An interval is what lies between two keys."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from teleop.planner.polynomial import Array

NEAR = 1e-6  # share of a segment: a ramp that ends nearer to a key, or to the other ramp's end, ends there


@dataclass(frozen=True, eq=False)
class Segment:
    """Times (n + 1,) in seconds and positions (n + 1,) in units of one axis; at rest at both ends only.

    `ramps` are the seconds in which it gets up to speed and comes to rest, None where that is left open. A window of a
    longer segment has `ends` (2, 2): velocity and acceleration at its first and at its last key.
    """

    times: Array
    positions: Array
    ramps: tuple[float, float] | None = None
    ends: Array = field(default_factory=lambda: np.zeros((2, 2)))

    @property
    def durations(self) -> Array:
        return np.diff(self.times)

    @property
    def steps(self) -> Array:
        return np.diff(self.positions)

    def stretched(self, interval: int, duration: float) -> Segment:
        """With one interval lasting `duration` and the later ones as they were."""
        later = self.times.copy()
        later[interval + 1 :] += duration - self.durations[interval]
        return replace(self, times=later)

    def part(self, first: int, last: int) -> Segment:
        """From one key to a later one, both rests, with as much of the ramps as there is time for."""
        times = self.times[first : last + 1]
        half = float(times[-1] - times[0]) / 2
        ramps = None if self.ramps is None else (min(self.ramps[0], half), min(self.ramps[1], half))
        return Segment(times, self.positions[first : last + 1], ramps)

    def window(self, first: int, last: int, states: Array) -> Segment:
        """From one key to a later one, moving there as `states` (n + 1, 2) say, velocity and acceleration by key."""
        return Segment(self.times[first : last + 1], self.positions[first : last + 1], None, states[[first, last]])

    def cuts(self) -> tuple[Array, NDArray[np.intp], Array]:
        """The intervals, cut where the ramps end: durations (k,), the interval of each, and the ramp that it lies in.

        That is given as its seconds, 0 between the ramps and inf for a segment that has none.
        """
        if self.ramps is None:
            return self.durations, np.arange(len(self.steps)), np.full(len(self.steps), np.inf)
        start, end = float(self.times[0]), float(self.times[-1])
        fast, slow = start + self.ramps[0], end - self.ramps[1]
        times = self.times
        for time in (fast, slow):
            if start < time < end and np.abs(times - time).min() > NEAR * (end - start):
                times = np.insert(times, np.searchsorted(times, time), time)
        middles = (times[:-1] + times[1:]) / 2
        ramps = np.where(middles < fast, self.ramps[0], np.where(middles > slow, self.ramps[1], 0.0))
        return np.diff(times), np.searchsorted(self.times, middles) - 1, ramps

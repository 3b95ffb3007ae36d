"""A segment: one axis from rest, through its keys, to rest, as arrays. An interval is what lies between two keys."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from teleop.planner.polynomial import Array

NEAR = 1e-6  # share of a segment: a ramp that ends nearer to a key, or to the other ramp's end, ends there
GAP = 0.03  # of a ramp: what is left beside it, to a key or to the other ramp's end, is too short for a piece
RESOLVED = 0.03  # of the time in which jerk alone would cross a segment's range: what happens in less, no solver sees


@dataclass(frozen=True, eq=False)
class Segment:
    """Times (n + 1,) in seconds and positions (n + 1,) in units of one axis; at rest at both ends only.

    `ramps` (n + 1, 2) are the seconds in which it slows down to each key and gets up to speed from it, 0 where it only
    passes through; None where all that is left open. A window of a longer segment has `ends` (2, 2): velocity and
    acceleration at its first and at its last key. `stray` (n,) is by how much an interval may leave the range of its
    two keys, in units, None for any distance. `urged` (n,) is what its velocities weigh beside their jerk, in 1/s^4.
    """

    times: Array
    positions: Array
    ramps: Array | None = None
    ends: Array = field(default_factory=lambda: np.zeros((2, 2)))
    stray: Array | None = None
    urged: Array | None = None

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

    def strays(self, directed: bool) -> Array:
        """`stray` (n,) of each interval, 0 for all where it has to be `directed`, inf where anything is."""
        if directed:
            return np.zeros(len(self.steps))
        return np.full(len(self.steps), np.inf) if self.stray is None else self.stray

    @property
    def is_loose(self) -> bool:
        """Whether every interval may leave its range by any distance: its keys are samples of a curve."""
        return self.stray is not None and bool(np.isinf(self.stray).all())

    def part(self, first: int, last: int) -> Segment:
        """From one key to a later one, both rests, with as much of the ramps as there is time for."""
        times = self.times[first : last + 1]
        ramps = None
        if self.ramps is not None:
            ramps = self.ramps[first : last + 1].copy()
            ramps[0, 1] = ramps[0, 1] or self.ramps[:, 1].max()
            ramps[-1, 0] = ramps[-1, 0] or self.ramps[:, 0].max()
            ramps[[0, -1]] = np.minimum(ramps[[0, -1]], float(times[-1] - times[0]) / 2)
        stray = None if self.stray is None else self.stray[first:last]
        return Segment(times, self.positions[first : last + 1], ramps, stray=stray)

    def window(self, first: int, last: int, states: Array) -> Segment:
        """From one key to a later one, moving there as `states` (n + 1, 2) say, velocity and acceleration by key."""
        stray = None if self.stray is None else self.stray[first:last]
        times, positions = self.times[first : last + 1], self.positions[first : last + 1]
        return Segment(times, positions, None, states[[first, last]], stray)

    def resolved(self, jerk: float) -> float:
        """The least seconds of a ramp: of a piece of it that is much shorter, the solver cannot hold the `jerk`."""
        return RESOLVED * float(np.cbrt(np.ptp(self.positions) / jerk))

    def cuts(self, near: float) -> tuple[Array, NDArray[np.intp], Array]:
        """The intervals, cut where ramps begin or end: durations (k,), the interval of each, and the ramp it lies in.

        That is given as its seconds, 0 between the ramps and inf for a segment that has none. A ramp that ends nearer
        than `near` (s), or GAP, to a key or to another ramp's end, ends there.
        """
        if self.ramps is None:
            return self.durations, np.arange(len(self.steps)), np.full(len(self.steps), np.inf)
        starts = np.stack([self.times - self.ramps[:, 0], self.times], axis=1).ravel()
        seconds = self.ramps.ravel()
        starts, seconds = starts[seconds > 0], seconds[seconds > 0]
        times = self._with(np.concatenate([starts, starts + seconds]), np.maximum(near, GAP * np.tile(seconds, 2)))
        middles = (times[:-1] + times[1:]) / 2
        ramp = np.maximum(np.searchsorted(starts, middles) - 1, 0)
        within = (starts[ramp] < middles) & (middles < starts[ramp] + seconds[ramp])
        return np.diff(times), np.searchsorted(self.times, middles) - 1, np.where(within, seconds[ramp], 0.0)

    def _with(self, others: Array, near: Array) -> Array:
        """The times of the keys, and of those others that are between them and not too `near` to one of all."""
        near = np.maximum(near, NEAR * float(self.times[-1] - self.times[0]))
        order = np.argsort(others)
        others, near = others[order], near[order]
        inside = (others > self.times[0]) & (others < self.times[-1])
        others, near = others[inside], near[inside]
        at = np.searchsorted(self.times, others)
        kept = np.minimum(others - self.times[at - 1], self.times[at] - others) > near
        others, near = others[kept], near[kept]
        others = others[np.diff(others, prepend=-np.inf) > near]
        return np.sort(np.concatenate([self.times, others]))

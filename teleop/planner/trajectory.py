"""A compiled move: one piecewise polynomial per axis, evaluated at any time.

Nothing is stored per sample, so a day's drift is as small as a second's. The control loop evaluates one instant per
tick with plain floats (a numpy call costs more than the arithmetic); previews and checks evaluate in arrays, chunk by
chunk.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from math import inf
from typing import Self

import numpy as np

from teleop.core.axes import Axis, State
from teleop.planner.keyframes.findings import LongRamp, Overshoot, Standstill
from teleop.planner.polynomial import HERMITE, Array, extremes

CHUNK = 1 << 15  # samples at a time: a megabyte an axis


@dataclass(frozen=True, slots=True)
class Peaks:
    """The extremes of one axis in continuous time: magnitudes in unit/s, unit/s2, unit/s3, positions in units."""

    velocity: float
    acceleration: float
    jerk: float
    minimum: float
    maximum: float


def _evaluate(coefficients: Array, t: Array, rows: Array) -> None:
    """Position to jerk into `rows` (4, m), of `coefficients` (6, m) ascending at local times `t` (m,)."""
    c0, c1, c2, c3, c4, c5 = coefficients
    rows[0] = c0 + t * (c1 + t * (c2 + t * (c3 + t * (c4 + t * c5))))
    rows[1] = c1 + t * (2 * c2 + t * (3 * c3 + t * (4 * c4 + t * 5 * c5)))
    rows[2] = 2 * c2 + t * (6 * c3 + t * (12 * c4 + t * 20 * c5))
    rows[3] = 6 * c3 + t * (24 * c4 + t * 60 * c5)


@dataclass(frozen=True, eq=False)
class Track:
    """One axis over time: pieces between `breaks` (n + 1,) in seconds, `coefficients` (n, 6) ascending in local time.

    Before its first break it rests at its first position, from its last break on at `end`, exactly.
    """

    breaks: Array
    coefficients: Array
    end: float
    _times: list[float] = field(init=False, repr=False)
    _pieces: list[list[float]] = field(init=False, repr=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "_times", self.breaks.tolist())
        object.__setattr__(self, "_pieces", self.coefficients.tolist())

    @classmethod
    def constant(cls, time: float, position: float) -> Track:
        return cls(np.array([time]), np.empty((0, 6)), position)

    @classmethod
    def through(cls, times: Array, states: Array) -> Self:
        """Quintics from each state to the next: `times` (n,) in s, rising, `states` (3, n), at rest in the last."""
        widths = np.diff(times)
        scale = np.array([np.ones_like(widths), widths, widths**2])
        ends = np.vstack([states[:, :-1] * scale, states[:, 1:] * scale])
        return cls(times, (HERMITE @ ends).T / widths[:, None] ** np.arange(6), float(states[0, -1]))

    @property
    def start(self) -> float:
        """The position before and at the first break, in units."""
        return self._pieces[0][0] if self._pieces else self.end

    def at(self, time: float) -> State:
        times = self._times
        if time >= times[-1]:
            return State(self.end)
        if time < times[0]:
            return State(self.start)
        i = bisect_right(times, time) - 1
        t = time - times[i]
        c0, c1, c2, c3, c4, c5 = self._pieces[i]
        return State(
            c0 + t * (c1 + t * (c2 + t * (c3 + t * (c4 + t * c5)))),
            c1 + t * (2 * c2 + t * (3 * c3 + t * (4 * c4 + t * 5 * c5))),
            2 * c2 + t * (6 * c3 + t * (12 * c4 + t * 20 * c5)),
        )

    def next_motion(self, time: float) -> float:
        """`time` while the axis moves then, later when it is about to, inf when it will not move again."""
        times = self._times
        for i in range(max(0, bisect_right(times, time) - 1), len(self._pieces)):
            if any(self._pieces[i][1:]):
                return max(time, times[i])
        return inf

    def sample(self, times: Array) -> Array:
        """Rows position, velocity, acceleration, jerk (4, m) at `times` (m,) in seconds, in any order."""
        rows = np.zeros((4, len(times)))
        index = np.searchsorted(self.breaks, times, side="right") - 1
        moving = (index >= 0) & (index < len(self.coefficients))
        if moving.all():
            _evaluate(self.coefficients.T.take(index, axis=1), times - self.breaks.take(index), rows)
            return rows
        rows[0] = np.where(index < 0, self.start, self.end)
        inside = np.empty((4, np.count_nonzero(moving)))
        index = index[moving]
        _evaluate(self.coefficients.T.take(index, axis=1), times[moving] - self.breaks.take(index), inside)
        rows[:, moving] = inside
        return rows

    @cached_property
    def _extremes(self) -> tuple[Array, Array]:
        return extremes(self.coefficients, np.diff(self.breaks))

    def fastest_at(self) -> float:
        """When it is fastest (s), to a hundredth of a piece; 0 where it never moves."""
        if len(self.coefficients) == 0:
            return 0.0
        widths = np.diff(self.breaks)
        least, greatest = self._extremes
        piece = int(np.maximum(-least[1], greatest[1]).argmax())
        times = self.breaks[piece] + widths[piece] * np.linspace(0, 1, 101)[:-1]
        return float(times[np.abs(self.sample(times)[1]).argmax()])

    def peaks(self) -> Peaks:
        """Exact extremes, from the zeros of the derivatives."""
        if len(self.coefficients) == 0:
            return Peaks(0.0, 0.0, 0.0, self.end, self.end)
        least, greatest = self._extremes
        velocity, acceleration, jerk = np.maximum(-least, greatest).max(axis=1).tolist()[1:]
        minimum, maximum = float(least[0].min()), float(greatest[0].max())
        return Peaks(velocity, acceleration, jerk, min(minimum, self.end), max(maximum, self.end))


@dataclass(frozen=True, eq=False)
class Move:
    """What every axis does over time; times are seconds from the move's own zero."""

    tracks: Mapping[Axis, Track]
    overshoots: tuple[Overshoot, ...] = ()
    long_ramps: tuple[LongRamp, ...] = ()
    standstills: tuple[Standstill, ...] = ()

    @property
    def remarks(self) -> tuple[Overshoot | LongRamp | Standstill, ...]:
        """What is not as the keys ask, although it is no error."""
        return (*self.overshoots, *self.long_ramps, *self.standstills)

    @cached_property
    def duration(self) -> float:
        """Seconds from 0 to where the last axis comes to rest."""
        return max((float(track.breaks[-1]) for track in self.tracks.values()), default=0.0)

    @cached_property
    def opening(self) -> float:
        """When the first axis begins to move: 0, or earlier for a move that is corrected."""
        return min([0.0, *(float(track.breaks[0]) for track in self.tracks.values())])

    def at(self, time: float) -> dict[Axis, State]:
        return {axis: track.at(time) for axis, track in self.tracks.items()}

    def next_motion(self, time: float) -> float:
        """`time` while an axis moves then, later when one is about to, inf when none will move again."""
        return min((track.next_motion(time) for track in self.tracks.values()), default=inf)

    @property
    def start(self) -> dict[Axis, State]:
        return self.at(0.0)

    @property
    def end(self) -> dict[Axis, State]:
        return self.at(self.duration)

    def sample(self, times: Array) -> dict[Axis, Array]:
        """Per axis (4, m) rows position, velocity, acceleration, jerk at `times` (m,)."""
        return {axis: track.sample(times) for axis, track in self.tracks.items()}

    def chunks(self, rate: float) -> Iterator[tuple[Array, dict[Axis, Array]]]:
        """(times, samples) at `rate` per second from 0 to the end, a bounded number at a time."""
        count = int(np.floor(self.duration * rate * (1 + 1e-12))) + 1
        for first in range(0, count, CHUNK):
            times = np.arange(first, min(first + CHUNK, count)) / rate
            yield times, self.sample(times)

    def peaks(self) -> dict[Axis, Peaks]:
        return {axis: track.peaks() for axis, track in self.tracks.items()}

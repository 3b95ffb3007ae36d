"""One axis from pass to pass: what it tries next, and the best it has met so far.

A trial that is worse is dropped, and half of it is tried from the best once more. Learning ends when the model promises
hardly more than is there, or when two trials in a row were worse.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from teleop.core.axes import Limits
from teleop.learning.basis import Basis
from teleop.learning.correction import Error
from teleop.learning.improve import Improver
from teleop.learning.response_model import STEP, fitted
from teleop.learning.room import Room, fits
from teleop.planner.offset_track import added
from teleop.planner.polynomial import Array
from teleop.planner.trajectory import Track

WORTH = 0.8  # of the present RMS: a promise of more than that is none
LEAST = 0.01  # units: a promise of less is none
NOISY = 1.6  # times the noise of the readings: an RMS of less is hardly anything else, and a trial may be worse
NEAR = 1.5 * STEP  # s from a reading: further away nothing is known
TRIALS = 2  # worse ones in a row, after which learning ends

Readings = tuple[Array, Array]  # times (m,) in s of the move, rising, and positions (m,) in units


class AxisLearner:
    """`track` is the plan; a `present` offset is one that is known already."""

    def __init__(self, track: Track, limits: Limits, edges: list[float], present: Track | None) -> None:
        self.track, self._limits = track, limits
        self._basis = Basis(edges)
        self._times = np.arange(edges[0], edges[-1] + STEP / 2, STEP)
        self._counts = ((self._times > -STEP / 2) & (self._times < track_end(track) + STEP / 2)).astype(float)
        self._improver = Improver(self._basis, Room(track, limits, self._basis), self._times)
        begin = np.zeros(self._basis.count) if present is None else self._basis.coefficients(present)
        self._best, self._base, self._next = begin, begin, begin
        self.best_error: Error | None = None
        self.best_pass = 0
        self._base_rms = math.inf
        self._worse = 0
        self.ended = ""  # why it learns no more

    @property
    def offset(self) -> Track:
        """For the next pass."""
        return self._basis.track(self._next)

    @property
    def best(self) -> Track:
        return self._basis.track(self._best)

    def learn(self, number: int, error: Error, readings: Readings, settled: bool = True) -> None:
        """A pass was played with `offset` and measured.

        One that was not `settled` can be the best, but tells nothing of the next: that is played with the same offset.
        """
        if self.best_error is None or error.rms < self.best_error.rms:
            self._best, self.best_error, self.best_pass = self._next, error, number
        if self.ended or not settled:
            return
        if error.rms < self._base_rms:
            self._base, self._base_rms, self._worse = self._next, error.rms, 0
            self._plan(error, readings)
        else:
            self._worse += 1
            if self._worse >= TRIALS:
                self._end("it does not help any more")
            else:
                self._next = (self._base + self._next) / 2

    def _plan(self, error: Error, readings: Readings) -> None:
        """The next trial, from what the best settled pass measured."""
        commanded = added(self.track, self._basis.track(self._base)).sample(self._times)[0]
        measured = np.interp(self._times, *readings)
        known = self._known(readings[0])
        taps, _ = fitted(commanded, measured, known)
        planned = self.track.sample(self._times)[0]
        better, promised = self._improver.better(self._base, planned - measured, taps, self._counts * known)
        noise = _noise(readings, self.track)
        if promised > WORTH * error.rms or error.rms - promised < LEAST or error.rms < NOISY * noise:
            self._end("there is nothing more to gain")
        elif not fits(added(self.track, self._basis.track(better)).peaks(), self._limits):
            self._end("the limits allow no more")
        else:
            self._next = better

    def _known(self, read_at: Array) -> NDArray[np.bool_]:
        """Where there is a reading: while a move rests, the gimbal is asked less often; before it, it rests too."""
        index = np.searchsorted(read_at, self._times)
        before, after = read_at[np.maximum(index - 1, 0)], read_at[np.minimum(index, len(read_at) - 1)]
        near = np.minimum(np.abs(self._times - before), np.abs(self._times - after)) <= NEAR
        return near | (self._times < read_at[0])

    def _end(self, reason: str) -> None:
        self.ended, self._next = reason, self._best


def _noise(readings: Readings, plan: Track) -> float:
    """The RMS of what in the errors differs from reading to reading, by their second differences."""
    errors = plan.sample(readings[0])[0] - readings[1]
    bends = np.diff(errors, n=2)
    return float(np.sqrt(np.mean(bends**2) / 6)) if len(bends) else 0.0


def track_end(track: Track) -> float:
    """When the axis comes to rest for good, in s."""
    return float(track.breaks[-1])

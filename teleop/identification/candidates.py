"""A bank of candidates for a response: each a dead time and a lag, with a Kalman filter for gain, drift and place.

How well a candidate foretells each reading is its likelihood. Nothing is decided by a threshold: a value that is asked
for is the mean over the candidates by their likelihood, so that it is vague while many are possible, and firm once few
are. All of them are computed at once, as arrays.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from teleop.identification.travel import Floats

GRID = 0.04  # deg: what the grid of 0.1 deg leaves, and a little noise
JITTER = 0.002  # s by which a reading's time is uncertain
MISFIT = 0.08  # of how far the candidates differ: no axis is exactly a lag and a dead time
WANDER, WANDER_SHARE = 0.008, 0.004  # deg a reading, and of the way: what no candidate explains
GAIN_DOUBT, DRIFT_DOUBT = 0.1, 0.6  # of an axis that nothing is known of
GAIN_WANDER, DRIFT_WANDER = 0.001, 0.01  # a reading
PLAUSIBLE = 4.0  # of log likelihood, below the best
DRIFTS = -2.0, 2.0  # deg/s
SLOW = 2.0  # deg/s: the noise of the readings is seen when little else is
OUTLIER = 25.0  # squares of the expected error: a reading further away counts no more against a candidate
TEMPER = 0.5  # no candidate is the truth, so each reading says less than it seems to
FORGET = 0.03  # of what was found, with each reading that tells candidates apart
NOISIEST = 0.2  # deg
USUAL, MOST_USUAL = 0.03, 0.5  # share of a reading's error in what is usual, and the most (deg) of that
LEAST = -60.0  # log likelihood, against the best: it must be able to come back


class Start(NamedTuple):
    """Gain and drift (deg/s) to begin with, how far from that they may be, and between which bounds the gain lies."""

    gain: float = 1.0
    drift: float = 0.0
    gain_doubt: float = GAIN_DOUBT
    drift_doubt: float = DRIFT_DOUBT
    gains: tuple[float, float] = (0.7, 1.4)


class Candidates:
    """`dead_times` and `lags` of each candidate, in s; `prior` are their log likelihoods before the first reading."""

    def __init__(self, dead_times: Floats, lags: Floats, prior: Floats, start: Start) -> None:
        self.dead_times, self.lags = dead_times, lags
        self.evidence = np.zeros_like(lags)  # log likelihoods without the prior
        self.places = np.zeros_like(lags)
        self._prior, self._start = prior, start
        self._noise = GRID**2
        self._usual = 0.0  # squared error of the best candidate
        self.surprise = 1.0  # a running mean of the squared error of the best, over what is expected
        self.reset(0.0)

    def reset(self, place: float) -> None:
        """Nothing is known but where the axis is."""
        nothing, start = np.zeros_like(self.lags), self._start
        self.evidence = nothing
        self.places, self.gains, self.drifts = nothing + place, nothing + start.gain, nothing + start.drift
        self._yy, self._gg, self._dd = nothing + GRID**2, nothing + start.gain_doubt**2, nothing + start.drift_doubt**2
        self._yg = self._yd = self._gd = nothing
        self.surprise = 1.0
        self._judge()

    def forget_prior(self, start: Start) -> None:
        self._prior, self._start = np.zeros_like(self._prior), start

    def place(self, place: float) -> None:
        """The axis is here now, wherever it was before; what was found of how it answers still holds."""
        self.places = np.zeros_like(self.places) + place

    @property
    def gain_doubts(self) -> Floats:
        return np.sqrt(self._gg)

    @property
    def drift_doubts(self) -> Floats:
        return np.sqrt(self._dd)

    def read(self, place: float, ways: Floats, rates: Floats, seconds: float) -> None:
        """A reading (deg), `seconds` after the one before, in which the candidates travelled `ways` at unit gain."""
        self._foretell(ways, seconds)
        speed = float(self.weights @ np.abs(rates))
        apart = MISFIT * float(np.std(ways))
        expected = self._yy + self._noise + (JITTER * speed) ** 2 + apart**2
        errors = place - self.places
        self._weigh(errors, expected)
        self._correct(errors, expected)
        if speed < SLOW:
            seen = min(float(self.weights @ errors) ** 2, NOISIEST**2)
            self._noise = max(GRID**2, self._noise + 0.05 * (seen - self._noise))

    def _foretell(self, ways: Floats, seconds: float) -> None:
        self.places = self.places + self.gains * ways + self.drifts * seconds
        yg, yd = self._yg + ways * self._gg + seconds * self._gd, self._yd + ways * self._gd + seconds * self._dd
        self._yy = self._yy + ways * (self._yg + yg) + seconds * (self._yd + yd)
        self._yy += WANDER**2 + (WANDER_SHARE * ways) ** 2
        self._yg, self._yd = yg, yd
        self._gg, self._dd = self._gg + GAIN_WANDER**2, self._dd + DRIFT_WANDER**2
        self._gg = np.minimum(self._gg, self._start.gain_doubt**2)

    def _weigh(self, errors: Floats, expected: Floats) -> None:
        squares, weights = np.minimum(errors**2 / expected, OUTLIER), self.weights
        off = errors - float(weights @ errors)
        apart = float(weights @ off**2) / float(weights @ expected)
        self._be_surprised(errors, expected)
        told = TEMPER * 0.5 * (squares + np.log(expected))
        evidence = (1 - FORGET * min(1.0, apart)) * self.evidence - told
        self.evidence = np.maximum(evidence - evidence.max(), LEAST)
        self._judge()

    def _be_surprised(self, errors: Floats, expected: Floats) -> None:
        """An axis that rings errs as much for a while, whatever the candidates differ by at the moment."""
        squares = np.minimum(errors**2 / (expected + self._usual), OUTLIER)
        self.surprise += 0.15 * (float(squares[self.plausible].min()) - self.surprise)
        least = float((errors[self.plausible] ** 2).min())
        self._usual += USUAL * (min(least, MOST_USUAL**2) - self._usual)

    def _judge(self) -> None:
        self.weights = _normalized(self.evidence + self._prior)
        self.plausible = self.evidence > self.evidence.max() - PLAUSIBLE

    def _correct(self, errors: Floats, expected: Floats) -> None:
        y, g, d = self._yy / expected, self._yg / expected, self._yd / expected
        self.places = self.places + y * errors
        self.gains, self.drifts = (
            np.clip(self.gains + g * errors, *self._start.gains),
            np.clip(self.drifts + d * errors, *DRIFTS),
        )
        self._gg, self._gd, self._dd = self._gg - g * self._yg, self._gd - g * self._yd, self._dd - d * self._yd
        self._yg, self._yd = (1 - y) * self._yg, (1 - y) * self._yd
        self._yy = (1 - y) * self._yy


def _normalized(logs: Floats) -> Floats:
    shares = np.exp(logs - logs.max())
    return shares / shares.sum()

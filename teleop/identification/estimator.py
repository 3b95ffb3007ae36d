"""Identifies one axis: its dead time, lag, gain and drift, from the speeds sent and the readings, as they come."""

from __future__ import annotations

import math
from collections import deque
from typing import NamedTuple

import numpy as np

from teleop.core.axes import Reading
from teleop.core.response import Response
from teleop.identification.candidates import Candidates, Start
from teleop.identification.travel import Floats, Travel

DEAD_TIMES = np.arange(0.0, 0.1601, 0.01)  # s
LAGS = np.array([0.01, 0.02, 0.03, 0.045, 0.06, 0.08, 0.1, 0.125, 0.15, 0.175, 0.2, 0.25])  # s
STEP = 0.006  # s: what the grid of candidates leaves
GAP = 0.5  # s without a reading, after which the axis may have been anywhere
SURPRISED = 10.0  # squares of the expected error, for several readings: this is another gimbal, or a hand
PRIOR_SHARE = 0.9  # how far a prior is believed before the first motion
PRIOR_DOUBT = 0.01  # s, at least
TRACK = 32  # readings that it is remembered for where they led
OFF, OFF_SHARE = 0.5, 0.3  # deg, and of the way: so far from where it was sent an axis still obeys
LEAST_GAIN = 0.5  # an axis that goes less far does not obey, however well that explains the readings
UNVERIFIED = 0.5  # of a drift that counts before an axis has moved
DRIFT = 1.0  # deg/s that a prior is believed of
SURE = 0.012  # s of doubt of the delay


class Ahead(NamedTuple):
    """Of each plausible candidate: its `weights`, `dead_times`, `lags`, `gains`, and where it is a dead time later."""

    weights: Floats
    dead_times: Floats
    lags: Floats
    gains: Floats
    drifts: Floats
    places: Floats


class ResponseEstimator:
    """`prior` is what was found before; `start` what is thought of gain and drift without it."""

    def __init__(self, prior: Response | None = None, start: Start = Start()) -> None:  # noqa: B008 - immutable
        self._start = start
        self.changed = False  # set when what was found no longer holds; whoever says so resets it
        self._travel = Travel(LAGS)
        self._candidates = _candidates(prior, start)
        self._reading: Reading | None = None
        self._then = np.zeros(len(DEAD_TIMES) * len(LAGS))
        self._track: deque[tuple[Reading, Floats]] = deque(maxlen=TRACK)
        self._prior, self._known = prior, False

    def sent(self, now: float, speed: float) -> None:
        """A speed (deg/s), as it left, is in force from `now` on."""
        self._travel.sent(now, speed)

    def read(self, reading: Reading) -> None:
        """A reading; one that was read before says nothing."""
        before = self._reading
        if before is not None and reading.time <= before.time:
            return
        places, rates = self._travel.at(reading.time - DEAD_TIMES)
        then, self._reading = places.ravel(), reading
        if before is None or reading.time - before.time > GAP:
            self._candidates.place(reading.position)  # what was found of the response still holds
        else:
            self._candidates.read(reading.position, then - self._then, rates.ravel(), reading.time - before.time)
        self._then = then
        self._track.append((reading, then))
        if self._candidates.surprise > SURPRISED:
            self._begin_anew(reading.position)
        if not self._known and self.sure:
            self._known = True
            self.changed |= self._prior is not None and not agree(self._prior, self.response)
            self._prior = None

    def suppose(self, prior: Response | None) -> None:
        """Begin anew, from another prior or from none."""
        self._candidates = _candidates(prior, self._start)
        if self._reading is not None:
            self._candidates.reset(self._reading.position)
        self._prior, self._known = prior, False

    def _begin_anew(self, place: float) -> None:
        """What was found no longer explains the readings."""
        self.changed |= self._known
        self._known, self._prior = False, None
        self._candidates.forget_prior(self._start)
        self._candidates.reset(place)

    @property
    def reading(self) -> Reading | None:
        """The last one."""
        return self._reading

    @property
    def known(self) -> bool:
        """Whether there is something to go by: a prior that still holds, or what was found since."""
        return self._prior is not None or self.sure

    @property
    def sure(self) -> bool:
        return self.response.delay_doubt < SURE

    @property
    def response(self) -> Response:
        of, weights = self._candidates, self._candidates.weights
        dead_time, lag = float(weights @ of.dead_times), float(weights @ of.lags)
        delays = of.dead_times + of.lags
        delay_doubt = math.sqrt(float(weights @ (delays - dead_time - lag) ** 2) + STEP**2)
        gain, drift = float(weights @ of.gains), float(weights @ of.drifts)
        gain_doubt = math.sqrt(float(weights @ (of.gain_doubts**2 + (of.gains - gain) ** 2)))
        drift_doubt = math.sqrt(float(weights @ (of.drift_doubts**2 + (of.drifts - drift) ** 2)))
        return Response(dead_time, lag, gain, drift, delay_doubt, gain_doubt, drift_doubt)

    def ahead(self, now: float) -> Ahead | None:
        """Where the likely candidates will be a dead time after `now`, if nothing is sent meanwhile that they feel."""
        of = self._candidates
        if self._reading is None:
            return None
        weights = of.weights
        likely = weights > 0.002 * weights.max()
        places, _ = self._travel.at(np.array([now]))
        soon = np.tile(places[0], len(DEAD_TIMES))
        where = of.places + of.gains * (soon - self._then) + of.drifts * (now + of.dead_times - self._reading.time)
        shares = weights[likely] / weights[likely].sum()
        drifts = of.drifts[likely] * (1.0 if self._known else UNVERIFIED)
        return Ahead(shares, of.dead_times[likely], of.lags[likely], of.gains[likely], drifts, where[likely])

    def obeys(self, since: float) -> bool | None:
        """Whether the readings after `since` (s) went where what was sent leads; None for too few of them."""
        seen = [each for each in self._track if each[0].time >= since]
        if len(seen) < 3:
            return None
        (first, then), (last, now), of = seen[0], seen[-1], self._candidates
        likely = of.plausible
        gains = np.maximum(of.gains[likely], LEAST_GAIN)
        ways = gains * (now - then)[likely] + of.drifts[likely] * (last.time - first.time)
        off = np.abs(last.position - first.position - ways)
        return bool((off <= OFF + OFF_SHARE * np.abs(ways)).any())

    def rests(self, now: float, side: int) -> tuple[Floats, Floats]:
        """Where each plausible candidate comes to rest if nothing more is sent than was by `now`, and its gain.

        `side` is the side (1 up, -1 down) for which the worst counts.
        """
        of = self._candidates
        assert self._reading is not None
        plausible = of.plausible
        to_come = self._travel.total(now) - self._then[plausible]
        gains = of.gains[plausible] + np.sign(to_come) * side * 1.5 * of.gain_doubts[plausible]
        late = now - self._reading.time + of.dead_times[plausible] + of.lags[plausible]
        rests = self._reading.position + gains * to_come + of.drifts[plausible] * late
        return rests, of.gains[plausible] + 1.5 * of.gain_doubts[plausible]


def _candidates(prior: Response | None, start: Start) -> Candidates:
    """One for each dead time and lag."""
    dead_times, lags = (each.ravel() for each in np.meshgrid(DEAD_TIMES, LAGS, indexing="ij"))
    return Candidates(dead_times, lags, _prior(prior, dead_times, lags), _start(prior, start))


def _prior(prior: Response | None, dead_times: Floats, lags: Floats) -> Floats:
    if prior is None:
        return np.zeros_like(lags)
    doubt = max(PRIOR_DOUBT, 2 * prior.delay_doubt) if math.isfinite(prior.delay_doubt) else 0.1
    off = (dead_times + lags - prior.delay) ** 2 / (2 * doubt**2) + (lags - prior.lag) ** 2 / (2 * (3 * doubt) ** 2)
    shares = np.exp(-off)
    return np.log(PRIOR_SHARE * shares / shares.sum() + (1 - PRIOR_SHARE) / len(lags))


def _start(prior: Response | None, start: Start) -> Start:
    """What is thought of gain and drift, with what was found before: a little less sure than it was."""
    if prior is None:
        return start
    gain_doubt, drift_doubt = max(0.03, 2 * prior.gain_doubt), max(0.2, 2 * prior.drift_doubt)
    drift = min(max(prior.drift, -DRIFT), DRIFT)
    return start._replace(
        gain=prior.gain,
        drift=drift,
        gain_doubt=min(gain_doubt, start.gain_doubt),
        drift_doubt=min(drift_doubt, start.drift_doubt),
    )


def agree(before: Response, now: Response) -> bool:
    """Whether two findings are of one gimbal."""
    delay_doubt = math.hypot(min(before.delay_doubt, 0.05), now.delay_doubt)
    gain_doubt = math.hypot(min(before.gain_doubt, 0.05), now.gain_doubt)
    return (
        abs(before.delay - now.delay) < 3 * delay_doubt + 0.01 and abs(before.gain - now.gain) < 3 * gain_doubt + 0.02
    )

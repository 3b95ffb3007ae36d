"""How far axes of several lags travel, at unit gain and without dead time, under the speeds that are sent.

A dead time only shifts this in time, so one history serves every candidate: `at` looks up the past. Between two
commands the motion is a closed form, so it does not matter how often it is looked at.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

HOLDS = 0.5  # s that a speed is obeyed: R SDK V2.5, section 2.3.4.2
KEPT = 256  # commands: 2.5 s at 100 Hz


class Travel:
    """`lags` are in s. `total` is the integral of what was sent: where every axis comes to rest if nothing follows."""

    def __init__(self, lags: Floats) -> None:
        self._lags = lags
        self._times = np.full(KEPT, -np.inf)
        self._speeds, self._totals = np.zeros(KEPT), np.zeros(KEPT)
        self._places, self._rates = np.zeros((KEPT, len(lags))), np.zeros((KEPT, len(lags)))
        self._last = -np.inf  # the time of the last command

    def sent(self, now: float, speed: float) -> None:
        """This speed is in force from `now` on."""
        if now - self._last > HOLDS and self._speeds[-1]:
            self._add(self._last + HOLDS, 0.0)
        self._add(now, speed)
        self._last = now

    def total(self, now: float) -> float:
        """The integral of the speeds until `now`."""
        if not np.isfinite(self._times[-1]):
            return 0.0
        return float(self._totals[-1] + self._speeds[-1] * min(max(0.0, now - self._times[-1]), HOLDS))

    def at(self, times: Floats) -> tuple[Floats, Floats]:
        """Places and rates at each of the times, a row for each."""
        rows = np.maximum(np.searchsorted(self._times, times, side="right") - 1, 0)
        return self._after(rows, np.where(np.isfinite(self._times[rows]), times - self._times[rows], 0.0))

    def _after(self, rows: NDArray[np.int_], elapsed: Floats) -> tuple[Floats, Floats]:
        passed = np.clip(elapsed, 0.0, None)[:, None]
        held = np.minimum(passed, HOLDS)
        places, rates = self._moved(self._places[rows], self._rates[rows], self._speeds[rows][:, None], held)
        return self._moved(places, rates, 0.0, passed - held)

    def _moved(self, places: Floats, rates: Floats, speed: Floats | float, passed: Floats) -> tuple[Floats, Floats]:
        decay = np.exp(-passed / self._lags)
        excess = rates - speed
        return places + speed * passed + excess * self._lags * (1 - decay), speed + excess * decay

    def _add(self, now: float, speed: float) -> None:
        places, rates = self.at(np.array([now]))
        total = self.total(now)
        for kept in (self._times, self._speeds, self._totals, self._places, self._rates):
            kept[:-1] = kept[1:]
        self._times[-1], self._speeds[-1], self._totals[-1] = now, speed, total
        self._places[-1], self._rates[-1] = places[0], rates[0]

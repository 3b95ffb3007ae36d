"""How much later than commanded an axis moves, from what was commanded and what was measured meanwhile.

The measured track is fitted, by least squares, with the commanded one shifted in time, scaled, and with an offset and a
drift of its own: a gimbal that turns at 95 % of its command, or slowly sinks, is not later for that. The shift that
leaves the least is the delay. Slow moves do not separate a lag from a dead time, and need not be.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from teleop.core.axes import Axis
from teleop.core.events import Tick

EARLIEST, LATEST = -0.1, 0.6  # s, the shifts that are tried; a profile's delay is 0.5 at most
STEPS = (0.01, 0.0005)  # s between them, first all of them, then around the best
BEND = 0.02  # s to either side, over which it is seen how much worse a shift is
FLAT = 1e-9  # of the square of the way, per s2: no worse, but for rounding


class Delay(NamedTuple):
    """`seconds` late, moving `scale` times as far as commanded; what is left unexplained is `rms` units.

    `doubt` is the standard error of the seconds, inf where every shift explains as much: a steady speed says nothing.
    """

    seconds: float
    scale: float
    rms: float
    doubt: float = 0.0


class Traces:
    """An observer that keeps what one axis was commanded and measured to do: pairs of s and units."""

    def __init__(self, axis: Axis) -> None:
        self.commanded: list[tuple[float, float]] = []
        self.measured: list[tuple[float, float]] = []
        self._axis = axis

    def observe(self, tick: Tick) -> None:
        self.commanded.append((tick.time, tick.motion[self._axis].position))
        reading = tick.reported.get(self._axis)
        if reading is not None and (reading.time, reading.position) not in self.measured[-1:]:
            self.measured.append((reading.time, reading.position))


def estimate(
    commanded: Sequence[tuple[float, float]], measured: Sequence[tuple[float, float]], begin: float, end: float
) -> Delay | None:
    """The delay by the readings between `begin` and `end`; None when these are too few, or nothing moved."""
    times, places = np.asarray(commanded, dtype=float).T
    read_at, read = np.asarray([each for each in measured if begin <= each[0] <= end], dtype=float).reshape(-1, 2).T
    if len(read) < 10 or np.ptp(read) == 0.0:
        return None

    def fit(shift: float) -> tuple[float, float]:
        """The sum of squares that a shift leaves, and the scale."""
        moved = np.interp(read_at - shift, times, places)
        model = np.stack([np.ones_like(read), read_at - begin, moved], axis=1)
        parts = np.linalg.lstsq(model, read, rcond=None)[0]
        return float(np.sum((model @ parts - read) ** 2)), float(parts[2])

    low, high, best = EARLIEST, LATEST, 0.0
    for step in STEPS:
        shifts = np.arange(low, high + step / 2, step)
        best = float(shifts[np.argmin([fit(shift)[0] for shift in shifts])])
        low, high = best - step, best + step
    left, scale = fit(best)
    curvature = (fit(best - BEND)[0] + fit(best + BEND)[0] - 2 * left) / BEND**2
    doubt = np.sqrt(2 * left / max(len(read) - 4, 1) / curvature) if curvature > FLAT * np.ptp(read) ** 2 else np.inf
    return Delay(best, scale, float(np.sqrt(left / len(read))), float(doubt))

"""Moves through exposures, one for each frame of an axis, so that a frame has the blur of a real move (go-motion).

For a frame with the places p0, p1, p2 of the frame before it, its own and the next one, and a blur b, the exposure
spans p1 - (p1 - p0) b .. p1 .. p1 + (p2 - p1) b, half of its time on each side: at mid exposure the axis is at p1.
A ramp of 1 s from rest comes before, one to rest after. The speed is constant but for the ramps and a stretch around
the middle, where it changes from that of one side to that of the other.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from teleop.core.axes import Limits
from teleop.planner.polynomial import HERMITE, Array, extremes
from teleop.planner.time_scaling import HEADROOM
from teleop.planner.trajectory import Track

RAMP = 1.0  # s from rest to the speed of the exposure, and back to rest
GENTLE = 0.5  # of acceleration and jerk, for the change of speed at the middle where there is time for it
SHORTEST_CHANGE = 0.1  # s on each side of the middle: ten ticks
STEEPEST = 3.0  # times the slower side's speed, that of the middle: with more the slower side would turn back
WHOLE = 1 + 1e-9  # of a limit, for rounding
PIECES = 6  # ramp, even, change, change, even, ramp


@dataclass(frozen=True, eq=False)
class ExposureRuns:
    """The runs of one axis: `places` (n,) are those of its frames in units, with those `before` and `after` each.

    `exposure` is more than 0, in s; `blur` is 0 .. 1.
    """

    before: Array
    places: Array
    after: Array
    blur: float
    exposure: float
    limits: Limits

    @classmethod
    def along(cls, places: Array, blur: float, exposure: float, limits: Limits) -> ExposureRuns:
        """Of frames one after the other: nothing comes before the first and after the last."""
        return cls(
            np.append(places[:1], places[:-1]), places, np.append(places[1:], places[-1:]), blur, exposure, limits
        )

    @classmethod
    def once(
        cls, before: float, place: float, after: float, blur: float, exposure: float, limits: Limits
    ) -> ExposureRuns:
        """Of one frame, with the places of the frame before it and of the next."""
        return cls(np.array([before]), np.array([place]), np.array([after]), blur, exposure, limits)

    def only(self, frames: Sequence[int]) -> ExposureRuns:
        """Those of some frames, by their numbers."""
        return replace(
            self, before=self.before.take(frames), places=self.places.take(frames), after=self.after.take(frames)
        )

    @cached_property
    def _steps(self) -> tuple[Array, Array]:
        """What the exposure spans before and after its middle (n,)."""
        return self.blur * (self.places - self.before), self.blur * (self.after - self.places)

    @cached_property
    def _speeds(self) -> tuple[Array, Array, Array]:
        """Before, at and after the middle (n,).

        The middle has their mean. Where one side rests or turns back, it is at rest, and where one is slow beside the
        other, it is slow too: so the axis never turns round on the way, nor passes a place where the move ends.
        """
        first, last = (step / (self.exposure / 2) for step in self._steps)
        slow = np.minimum(np.abs(first), np.abs(last))
        mean = np.minimum(np.abs(first + last) / 2, STEEPEST * slow)
        return first, np.where(first * last > 0, np.sign(first) * mean, 0.0), last

    @cached_property
    def starts(self) -> Array:
        """Where each run-up begins (n,), from rest, `RAMP` s before the exposure."""
        return self.places - self._steps[0] - self._speeds[0] * RAMP / 2

    @cached_property
    def ends(self) -> Array:
        """Where each run-out ends (n,), at rest, `RAMP` s after the exposure."""
        return self.places + self._steps[1] + self._speeds[2] * RAMP / 2

    @cached_property
    def _changes(self) -> Array:
        """How long the speed changes on each side of the middle (n,), in s."""
        first, middle, last = self._speeds
        change = np.maximum(np.abs(middle - first), np.abs(last - middle))
        least = np.maximum(
            np.sqrt(36 * change / (GENTLE * self.limits.jerk)), 4 * change / (GENTLE * self.limits.acceleration)
        )
        return np.clip(least, min(SHORTEST_CHANGE, self.exposure / 2), self.exposure / 2)

    @cached_property
    def _breaks(self) -> Array:
        """Of every run (n, PIECES + 1), in s since its shutter is pressed."""
        half, changes = self.exposure / 2, self._changes
        ones = np.ones_like(changes)
        return np.array(
            [
                -RAMP * ones,
                0 * ones,
                half - changes,
                half * ones,
                half + changes,
                self.exposure * ones,
                (self.exposure + RAMP) * ones,
            ]
        ).T

    @cached_property
    def _coefficients(self) -> Array:
        """Of every run (n, PIECES, 6), ascending in local time."""
        first, middle, last = self._speeds
        width, half = self._changes, self.exposure / 2
        bends = 4 * (middle - first), 4 * (last - middle)  # of the speed at the middle, over the width
        bend = np.where(bends[0] * bends[1] > 0, np.sign(bends[0]) * np.minimum(*np.abs(bends)), 0.0)
        nothing = np.zeros_like(width)
        before = _change(nothing, nothing, (middle - first) * width, bend * width, width)
        after = _change((middle - last) * width, bend * width, nothing, nothing, width)
        before[:, 0] += self.places - first * width
        before[:, 1] += first
        after[:, 0] += self.places
        after[:, 1] += last
        rows = np.zeros((len(width), PIECES, 6))
        rows[:, 0, 0], rows[:, 0, 3], rows[:, 0, 4] = self.starts, first / RAMP**2, -first / (2 * RAMP**3)
        rows[:, 1, 0], rows[:, 1, 1] = self.places - first * half, first
        rows[:, 2], rows[:, 3] = before, after
        rows[:, 4, 0], rows[:, 4, 1] = self.places + last * width, last
        rows[:, 5, 0], rows[:, 5, 1] = self.places + last * half, last
        rows[:, 5, 3], rows[:, 5, 4] = -last / RAMP**2, last / (2 * RAMP**3)
        return rows

    def over(self) -> str:
        """The limit that the first run would exceed, "" for none."""
        return next((name for name, shares in self.shares().items() if not shares[0] <= WHOLE), "")

    def track(self, frame: int) -> Track:
        """The run of a frame; its time 0 is when the shutter is pressed."""
        breaks = self._breaks[frame]
        lasts = np.diff(breaks) > 0  # not an even stretch that the change of speed leaves no time for
        return Track(
            np.append(breaks[:-1][lasts], breaks[-1]), self._coefficients[frame][lasts], float(self.ends[frame])
        )

    def shares(self) -> dict[str, Array]:
        """How much of each limit each run takes (n,), by the limit's name: more than 1 is too much."""
        count = len(self.places)
        least, greatest = extremes(self._coefficients.reshape(-1, 6), np.diff(self._breaks, axis=1).ravel() + _NO_TIME)
        peaks = np.maximum(-least, greatest).reshape(4, count, PIECES).max(axis=2) / HEADROOM
        low = least[0].reshape(count, PIECES).min(axis=1)
        high = greatest[0].reshape(count, PIECES).max(axis=1)
        limits = self.limits
        beyond = np.maximum(limits.minimum - low, high - limits.maximum)
        return {
            "soft": np.where(beyond > _NEGLIGIBLE, 1 + beyond, 0.0),
            "velocity": peaks[1] / limits.velocity,
            "acceleration": peaks[2] / limits.acceleration,
            "jerk": peaks[3] / limits.jerk,
        }


_NO_TIME = 1e-12  # s: the width of a piece that takes no time, so that it can be divided by
_NEGLIGIBLE = 1e-9  # units


def _change(speed: Array, bend: Array, speed_after: Array, bend_after: Array, width: Array) -> Array:
    """Quintics (n, 6) from nowhere to nowhere; speeds and their changes are times the width and its square."""
    nothing = np.zeros_like(width)
    return (HERMITE @ np.array([nothing, speed, bend, nothing, speed_after, bend_after])).T / width[
        :, None
    ] ** np.arange(6)

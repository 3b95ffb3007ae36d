"""The frames of a table on a sequence's clock: what a planned move is compared with."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from teleop.planner.polynomial import Array
from teleop.planner.trajectory import Track


class Deviation(NamedTuple):
    """The most that a track is off (units), and at which frame of the table, which has this time (s)."""

    size: float
    frame: int
    time: float


@dataclass(frozen=True, eq=False)
class TimedFrames:
    """One axis: `positions` (n,) in units at `times` (n,) in s, `numbers` as the `table` has them.

    Each is to be met within `tolerance` units.
    """

    table: str
    numbers: Sequence[int]
    times: Array
    positions: Array
    tolerance: float

    def moved(self, by: float, factor: float = 1.0) -> TimedFrames:
        """`by` s later, after all times are multiplied."""
        return replace(self, times=self.times * factor + by)

    def deviation(self, track: Track) -> Deviation:
        """Where the track is furthest off."""
        off = np.abs(track.sample(self.times)[0] - self.positions)
        worst = int(off.argmax())
        return Deviation(float(off[worst]), self.numbers[worst], float(self.times[worst]))

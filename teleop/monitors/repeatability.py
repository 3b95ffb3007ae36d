"""How far each pass of a move lay from the first, as commanded and as measured: what motion control is bought for.

Passes are compared at the move's own time, so a pause in one of them is no difference, and a pass that keeps the tick
grid is compared at the very same instants. Only the first pass is kept, as plain numbers: ten minutes of four axes are
8 MB. Of the others sums are kept.
"""

from __future__ import annotations

from array import array
from bisect import bisect_left
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

from teleop.core.axes import Axis, Motion
from teleop.core.events import Tick
from teleop.core.timing import SAME_TIME
from teleop.monitors.tracking_error import Score

Place = tuple[int, float]  # the pass, from 1, and the move's own time in s


@dataclass(frozen=True)
class Difference:
    """One axis of one pass against the first, in units."""

    commanded: Score = field(default_factory=Score)
    measured: Score = field(default_factory=Score)


class Trace:
    """One axis of the first pass: `times` in s, rising, and positions in units."""

    def __init__(self) -> None:
        self._times, self._positions = array("d"), array("d")

    def add(self, time: float, position: float) -> None:
        if not self._times or time > self._times[-1]:  # a step back along the path is no part of the pass
            self._times.append(time)
            self._positions.append(position)

    def at(self, time: float) -> float | None:
        """Where it was, between the two positions around `time`; None outside."""
        after = bisect_left(self._times, time - SAME_TIME)
        if after == len(self._times):
            return None
        if self._times[after] <= time + SAME_TIME:
            return self._positions[after]
        if after == 0:
            return None
        share = (time - self._times[after - 1]) / (self._times[after] - self._times[after - 1])
        return self._positions[after - 1] + share * (self._positions[after] - self._positions[after - 1])


class Repeatability:
    """An observer. `place` has the pass and where in the move, for a time of the loop; None outside a pass.

    `planned` is what counts as commanded, of a tick, where a correction was added to the motion.
    `passes` has the differences of the second and later passes, by number.
    """

    def __init__(
        self, place: Callable[[float], Place | None], planned: Callable[[Tick], Motion] = lambda tick: tick.motion
    ) -> None:
        self.passes: dict[int, Mapping[Axis, Difference]] = {}
        self._place, self._planned = place, planned
        self._commanded: dict[Axis, Trace] = {}
        self._measured: dict[Axis, Trace] = {}
        self._counted: dict[Axis, float] = {}

    def observe(self, tick: Tick) -> None:
        place = self._place(tick.time)
        if place is None:
            return
        for axis, state in self._planned(tick).items():
            self._see(self._commanded, axis, place, state.position)
        for axis, reading in tick.reported.items():
            then = self._place(reading.time)
            if axis in tick.motion and then is not None and reading.time != self._counted.get(axis):
                self._counted[axis] = reading.time
                self._see(self._measured, axis, then, reading.position)

    def _see(self, first: dict[Axis, Trace], axis: Axis, place: Place, position: float) -> None:
        number, time = place
        trace = first.setdefault(axis, Trace())
        if number == 1:
            trace.add(time, position)
            return
        then = trace.at(time)
        if then is not None:
            known = self.passes.setdefault(number, {axis: Difference() for axis in first})[axis]
            (known.commanded if first is self._commanded else known.measured).add(position - then)

"""Keys for all axes of a table by the frame, with a common run-up and run-out, as fast as the table says or slower."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from math import ceil

import numpy as np

from teleop.core.axes import Axis
from teleop.planner.keyframes.findings import PlanError
from teleop.planner.keyframes.frame_keys import Frames, Keys, Runs, Slack
from teleop.planner.keyframes.ramp import quickest
from teleop.planner.polynomial import Array

SLACKS = Slack(0.6, 0.9), Slack(0.6, 1.0), Slack(0.85, 1.0)
"""The noise may take most of the tolerance, the rest is for the curve between the keys; the planner needs a little more
of the limits than the smoothest positions."""
LEAST = Slack(0.95, 1.0)  # what has no way within that has none at all
GENTLY = (0.5, 0.9)  # of the limits, for a run-up or a run-out; the second where the first has no room
BEHIND = 0.5  # of the tolerance: an axis that falls behind less than that when it starts from rest needs no run-up
LONGEST = 64.0  # times slower: what is impossible then is no matter of speed
EXACT = 1.003  # by what a factor may be too large
SLOWER, TRIALS = 1.01, 60  # of a factor that the planner does not accept


@dataclass(frozen=True)
class FramesFit:
    """The keys of each axis, and how much slower than asked for the table is."""

    keys: Mapping[Axis, Keys]
    runs: Runs
    factor: float = 1.0


class TooFastError(PlanError):
    """A table that asks for more than the limits allow; `factor` times slower would do, None: no speed will.

    `share` is what it needs of `limit` ("velocity", "acceleration" or "jerk") of `axis` at the frame of index `place`.
    """

    def __init__(self, axis: Axis, limit: str, share: float, place: int, factor: float | None) -> None:
        super().__init__(f"{axis} needs {share:.2f} x its {limit} at frame {place}")
        self.axis, self.limit, self.share, self.place, self.factor = axis, limit, share, place, factor


class NoRoomError(PlanError):
    """An axis can get to speed before the table, or come to rest `after` it, neither within its soft limits nor in
    the time that it is given."""

    def __init__(self, axis: Axis, *, after: bool) -> None:
        super().__init__(f"{axis} has no room {'after' if after else 'before'} the frames")
        self.axis, self.after = axis, after


@dataclass(frozen=True)
class FrameFitter:
    """Fits `tables` of equally many frames, `rate` of them a second; `run_up` and `run_out` in s, None: as needed."""

    tables: Sequence[Frames]
    rate: float
    run_up: float | None = None
    run_out: float | None = None

    def fit(self, *, may_stretch: bool = False) -> FramesFit:
        """The keys; slower than asked for where it has to be and it `may_stretch`.

        Raises TooFastError and NoRoomError.
        """
        found = self._at(1.0)
        if found is not None:
            return found
        least = self._least_factor()
        if least == 1 and not may_stretch:
            self._check_room()
        slower = None if least is None else self._slower(least)
        if slower is None or not may_stretch:
            raise self._too_fast(slower.factor if slower else None)
        return slower

    def _at(self, factor: float) -> FramesFit | None:
        """The keys at so many times the duration, None where the limits do not allow them."""
        step = factor / self.rate
        for runs in dict.fromkeys(self._runs(step, gently) for gently in GENTLY):
            keys = {table.axis: _keys(table, step, runs) for table in self.tables}
            if all(of_axis is not None for of_axis in keys.values()):
                return FramesFit({axis: of_axis for axis, of_axis in keys.items() if of_axis}, runs, factor)
        return None

    def _runs(self, step: float, gently: float) -> Runs:
        seconds = (
            max(_ramp(table, free, end, step, gently) for table, free in self._free) if given is None else given
            for end, given in enumerate((self.run_up, self.run_out))
        )
        return Runs(*(ceil(each / step - 1e-6) for each in seconds))

    @cached_property
    def _free(self) -> Sequence[tuple[Frames, Array]]:
        return [(table, table.free(1 / self.rate)) for table in self.tables]

    def _least_factor(self) -> float | None:
        """The least factor at which the limits leave a way through all frames, run-up and run-out aside."""
        low, high = 1.0, 1.0
        while not self._leaves_a_way(high):
            low, high = high, 2 * high
            if high > LONGEST:
                return None
        while high > low * EXACT:
            middle = (low * high) ** 0.5
            low, high = (low, middle) if self._leaves_a_way(middle) else (middle, high)
        return high

    def _leaves_a_way(self, factor: float) -> bool:
        return all(table.smooth(factor / self.rate, LEAST, Runs(0, 0), (False, False)) is not None for table in self.tables)

    def _slower(self, factor: float) -> FramesFit | None:
        """The keys at a factor from this one on, the first at which the planner follows."""
        for _ in range(TRIALS):
            found = self._at(factor)
            if found is not None:
                return found
            factor *= SLOWER
        return None

    def _check_room(self) -> None:
        """Raises NoRoomError where only a run-up or a run-out is in the way."""
        step, runs = 1 / self.rate, self._runs(1 / self.rate, GENTLY[-1])
        for table in self.tables:
            if table.smooth(step, LEAST, runs) is None:
                raise NoRoomError(table.axis, after=table.smooth(step, LEAST, runs, (True, False)) is not None)

    def _too_fast(self, factor: float | None) -> TooFastError:
        """Where, and by how much, the frames ask for more than the limits allow: the greatest excess of all axes."""
        found = []
        for table, free in self._free:
            limits = table.limits
            for order, limit in enumerate(("velocity", "acceleration", "jerk"), 1):
                rate = np.abs(np.diff(free, order)) * self.rate**order
                if len(rate):
                    share = float(rate.max()) / getattr(limits, limit)
                    found.append((share ** (1 / order), share, limit, table.axis, int(rate.argmax())))
        _, share, limit, axis, place = max(found)
        return TooFastError(axis, limit, share, place, factor)


def _keys(table: Frames, step: float, runs: Runs) -> Keys | None:
    for slack in SLACKS:
        smooth = table.smooth(step, slack, runs)
        keys = None if smooth is None else table.keys(smooth, step, runs)
        if keys is not None:
            return keys
    return None


def _ramp(table: Frames, free: Array, end: int, step: float, gently: float) -> float:
    """Seconds in which an axis gets up to the speed of the first frame, or comes to rest from that of the last one."""
    if len(free) < 2:
        return 0.0
    speed = abs(float(free[1] - free[0] if end == 0 else free[-1] - free[-2])) / step
    ramp = quickest(speed, table.limits.scaled(gently))
    return 0.0 if speed * ramp / 2 <= BEHIND * table.tolerance else ramp

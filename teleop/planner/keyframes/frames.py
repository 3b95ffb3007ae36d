"""Keys for all axes of a table by the frame, with a common run-up and run-out, as fast as the table says or slower."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from math import ceil, inf

import numpy as np

from teleop.core.axes import Axis
from teleop.planner.keyframes.findings import PlanError
from teleop.planner.keyframes.frame_keys import Frames, Keys, Runs, Slack
from teleop.planner.keyframes.ramp import quickest

SLACKS = Slack(0.6, 0.9), Slack(0.6, 1.0), Slack(0.85, 1.0)
"""The noise may take most of the tolerance, the rest is for the curve between the keys; the planner needs a little more
of the limits than the smoothest positions."""
ANY = Slack(0.6, inf)
RUNS = (0.5, 3), (0.9, 3), (0.5, 0)
"""Run-ups and run-outs to be tried: the share of the limits that they may use, and how many frames next to the table
are at its speed already. Without those the first and the last frames are slower, as far as the tolerance allows."""
BEHIND = 0.5  # of the tolerance: an axis that falls behind less than that when it starts from rest needs no run-up
LONGEST = 64.0  # times slower: what is impossible then is no matter of speed
ROUNDS = 3  # of a factor and the run-up that it needs
HALVINGS = 5  # of what lies between the table's own speed and one that does in any case
LONGER = (1.0, 1.1, 1.25, 1.5)  # than what the peaks say


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
        if not may_stretch and self._leaves_a_way(1.0):
            self._check_room()
        slower = next((fit for factor in self._factors() if (fit := self._at(factor)) is not None), None)
        if slower is None or not may_stretch:
            raise self._too_fast(slower.factor if slower else None)
        return slower

    def as_asked(self) -> FramesFit | None:
        """The keys at the table's own speed, None where the limits do not allow them."""
        return self._at(1.0)

    def _at(self, factor: float) -> FramesFit | None:
        """The keys at so many times the duration, None where the limits do not allow them."""
        step = factor / self.rate
        if not self._leaves_a_way(factor):
            return None
        for runs in dict.fromkeys(self._runs(step, gently, steady) for gently, steady in RUNS):
            keys = {table.axis: _keys(table, step, runs) for table in self.tables}
            if all(of_axis is not None for of_axis in keys.values()):
                return FramesFit({axis: of_axis for axis, of_axis in keys.items() if of_axis}, runs, factor)
        return None

    def _runs(self, step: float, gently: float, steady: int) -> Runs:
        up, out = (
            max(_ramp(table, end, step, gently, steady) for table in self.tables) if given is None else given
            for end, given in enumerate((self.run_up, self.run_out))
        )
        return Runs(ceil(up / step - 1e-6), ceil(out / step - 1e-6), steady)

    def _factors(self) -> Iterator[float]:
        """Factors to be tried, rising.

        The curves of least jerk through keys without a thought of the limits need one that is known from their peaks;
        within the limits a little less may do.
        """
        high = 1.0
        for _ in range(ROUNDS):  # a slower table needs less of a run-up
            high *= max(1.0, *(self._excess(table, high, ANY) for table in self.tables))
        if not 1 < high < LONGEST:
            return
        low, most = 1.0, high
        for _ in range(HALVINGS):
            middle = (low * high) ** 0.5
            does = all(self._excess(table, middle, SLACKS[1]) <= 1 for table in self.tables)
            low, high = (low, middle) if does else (middle, high)
        yield from dict.fromkeys([high, *(most * more for more in LONGER)])

    def _excess(self, table: Frames, factor: float, slack: Slack) -> float:
        """How many times slower than with this factor the curve of least jerk has to be."""
        runs = self._runs(factor / self.rate, *RUNS[-1])
        smooth = table.smooth(factor / self.rate, slack, runs)
        if smooth is None:
            return inf
        return table.excess(smooth, table.places(smooth, runs, few=False), factor / self.rate)

    def _leaves_a_way(self, factor: float) -> bool:
        """Whether the limits leave a way through all frames, run-up and run-out aside."""
        step, none = factor / self.rate, Runs(0, 0)
        return all(table.smooth(step, SLACKS[-1], none, (False, False)) is not None for table in self.tables)

    def _check_room(self) -> None:
        """Raises NoRoomError where only a run-up or a run-out is in the way."""
        step, runs = 1 / self.rate, self._runs(1 / self.rate, *RUNS[-1])
        for table in self.tables:
            if table.smooth(step, SLACKS[-1], runs) is None:
                before = table.smooth(step, SLACKS[-1], runs._replace(out=0), (True, False))
                raise NoRoomError(table.axis, after=before is not None)

    def _too_fast(self, factor: float | None) -> TooFastError:
        """Where, and by how much, the frames ask for more than the limits allow: the greatest excess of all axes."""
        found = []
        for table in self.tables:
            limits, free = table.limits, table.free
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


def _ramp(table: Frames, end: int, step: float, gently: float, steady: int) -> float:
    """Seconds in which an axis gets up to the speed of the first frame, or comes to rest from that of the last one."""
    free = table.free
    if len(free) < 2:
        return 0.0
    speed = abs(float(free[1] - free[0] if end == 0 else free[-1] - free[-2])) / step
    ramp = quickest(speed, table.limits.scaled(gently))
    return 0.0 if speed * ramp / 2 <= BEHIND * table.tolerance else ramp + steady * step

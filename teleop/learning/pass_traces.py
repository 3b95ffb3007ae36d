"""What a pass measured, and whether it can teach: it was played as it is, without a stop, a pause or a trim."""

from __future__ import annotations

from array import array
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from teleop.core.axes import Axis
from teleop.core.events import Tick
from teleop.core.response import Response
from teleop.identification.estimator import agree
from teleop.learning.correction import Error
from teleop.planner.polynomial import Array
from teleop.planner.trajectory import Move, Track

AS_PLANNED = 1e-6  # units: what was commanded is that near to the move
INSTANT = 1e-6  # s
LONGEST_GAP = 0.3  # s between two readings, while an axis moves by more than
UNSEEN = 1.0  # units
SAMPLES = 20  # of a gap
CHANGED = "it was stopped, trimmed, or its speed was changed"

Place = tuple[int, float]  # the pass, from 1, and the move's own time in s


@dataclass(frozen=True)
class PassTraces:
    """`readings` by axis: times (m,) in s of the move, rising, and positions (m,).

    A pass that was `changed` teaches nothing. The axes that were `identified` in it answer otherwise in the next one.
    """

    number: int
    readings: Mapping[Axis, tuple[Array, Array]]
    changed: bool
    identified: Collection[Axis] = ()

    def error(self, axis: Axis, plan: Track) -> Error | None:
        """Against the plan, within the time of the move that is `plan`'s; None without a reading there."""
        times, positions = self.readings.get(axis, (np.empty(0), np.empty(0)))
        during = (times >= -INSTANT) & (times <= plan.breaks[-1] + INSTANT)
        times, positions = times[during], positions[during]
        if not len(times):
            return None
        error = plan.sample(times)[0] - positions
        worst = int(np.abs(error).argmax())
        return Error(len(error), float(np.sqrt(np.mean(error**2))), float(abs(error[worst])), float(times[worst]))

    def has_gaps(self, axis: Axis, plan: Track) -> bool:
        """Whether an axis moves far without a reading: too far to learn from."""
        end = float(plan.breaks[-1])
        times, _ = self.readings.get(axis, (np.empty(0), np.empty(0)))
        edges = np.concatenate([[0.0], times[(times > 0) & (times < end)], [end]])
        gaps = [(low, high) for low, high in pairwise(edges.tolist()) if high - low > LONGEST_GAP]
        ways = [np.ptp(plan.sample(np.linspace(*gap, SAMPLES))[0]) for gap in gaps]
        return max(ways, default=0.0) > UNSEEN


class PassObserver:
    """An observer. `place` has the pass and where in the move, for a time of the loop; None outside a pass.

    `move` is asked for the move that is played, `waits` whether it waits for the operator: then the axes rest.
    `responses` are those that the axes are corrected by, of the axes that are known surely enough.
    """

    def __init__(
        self,
        place: Callable[[float], Place | None],
        move: Callable[[], Move],
        waits: Callable[[], bool],
        responses: Callable[[], Mapping[Axis, Response]] = dict,
    ) -> None:
        self._place, self._move, self._waits, self._responses = place, move, waits, responses
        self._begin(0)

    def _begin(self, number: int) -> None:
        self._number, self._changed, self._known = number, False, dict(self._responses())
        self._last: tuple[float, float] | None = None  # the loop's time and the move's, of the tick before
        self._traces: dict[Axis, tuple[array[float], array[float]]] = {}

    def observe(self, tick: Tick) -> None:
        place = self._place(tick.time)
        if place is None:
            return
        number, time = place
        if number != self._number:
            self._begin(number)
        self._check(tick, time)
        for axis, reading in tick.reported.items():
            then = self._place(reading.time)
            if axis in tick.motion and then is not None:
                times, positions = self._traces.setdefault(axis, (array("d"), array("d")))
                if not times or then[1] > times[-1] + INSTANT:
                    times.append(then[1])
                    positions.append(reading.position)

    def _check(self, tick: Tick, time: float) -> None:
        """Notice what makes it another motion than the move's own."""
        planned = self._move().at(time)
        if any(abs(tick.motion[axis].position - state.position) > AS_PLANNED for axis, state in planned.items()):
            self._changed = True
        if self._last is not None and not self._waits():
            before, then = self._last
            self._changed |= abs((time - then) - (tick.time - before)) > INSTANT
        self._last = None if self._waits() else (tick.time, time)

    def taken(self, number: int) -> PassTraces:
        """What pass `number` measured; it is over."""
        own: Mapping[Axis, Sequence[array[float]]] = self._traces if number == self._number else {}
        readings = {axis: (np.array(times), np.array(positions)) for axis, (times, positions) in own.items()}
        now = self._responses()
        found = {axis for axis in now if axis not in self._known or not agree(self._known[axis], now[axis])}
        return PassTraces(number, readings, self._changed or number != self._number, found)

"""Whether legs have a plan: a search asks often, so each is asked for once, whatever its time and its axis."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping

from teleop.core.axes import Axis, Limits
from teleop.planner.keyframes.legs import Points, shortened

Asked = Callable[[Axis, Points], bool]


def same(axis: Axis, limits: Limits, points: Points) -> object:
    """What two legs share that have the same plan."""
    return limits, axis.unit, tuple(point._replace(time=round(point.time - points[0].time, 9)) for point in points)


class Possible:
    """`easy` tells of plans without overshoot, `tolerable` of others, soon and with few exceptions as `plan` does.

    Legs `refused` by that have none.
    """

    def __init__(
        self,
        limits: Mapping[Axis, Limits],
        easy: Asked,
        tolerable: Asked,
        plan: Asked,
        refused: Mapping[Axis, Iterable[Points]],
    ) -> None:
        self._limits, self._easy, self._tolerable, self._plan = limits, easy, tolerable, plan
        known = {same(axis, limits[axis], shortened(leg)[0]): False for axis, legs in refused.items() for leg in legs}
        self._known: dict[object, bool] = known
        self._overshooting: set[object] = set()
        self._planned: set[object] = set()

    def __call__(self, axis: Axis, points: Points) -> bool:
        """Whether there is a plan, as far as a search has to know."""
        leg = same(axis, self._limits[axis], points)
        if leg not in self._known:
            self._known[leg] = self._easy(axis, points)
            if not self._known[leg] and self._tolerable(axis, points):
                self._known[leg] = True
                self._overshooting.add(leg)
        return self._known[leg]

    def surely(self, axis: Axis, points: Points) -> bool:
        """Whether there is a plan: one that overshoots is planned. What that refuses, no search takes for possible."""
        leg = same(axis, self._limits[axis], points)
        if self(axis, points) and leg in self._overshooting - self._planned:
            self._known[leg] = self._plan(axis, points)
            self._planned.add(leg)
        return self._known[leg]

"""How well the devices followed in each pass of a move: the error of every reading, kept by pass."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from teleop.core.axes import Axis
from teleop.core.events import Tick
from teleop.monitors.tracking_error import Score, TrackingErrorMonitor

Place = tuple[int, float]  # the pass, from 1, and the move's own time in s
KEPT = 20  # passes


@dataclass(frozen=True)
class PassError:
    """One pass that is over; `axes` has the error (units) of each axis that was measured."""

    number: int
    axes: Mapping[Axis, Score]


class PassErrors:
    """An observer. `place` has the pass and where in the move, for a time of the loop; None outside a pass.

    `finished` are the last passes that are over, a new list after each.
    """

    def __init__(self, place: Callable[[float], Place | None]) -> None:
        self._place = place
        self._number = 0  # of the pass under way
        self._errors = TrackingErrorMonitor(lambda: float("-inf"), counts=self._counts)
        self.finished: list[PassError] = []

    def observe(self, tick: Tick) -> None:
        place = self._place(tick.time)
        if place is not None and place[0] != self._number:
            self.end()
            self._number = place[0]
        self._errors.observe(tick)

    def end(self) -> None:
        """What is under way is over."""
        if self._errors.scores:
            done = PassError(self._number, self._errors.scores)
            self.finished = [*self.finished, done][-KEPT:]
            self._errors.scores = {}

    def _counts(self, time: float) -> bool:
        place = self._place(time)
        return place is not None and place[0] == self._number

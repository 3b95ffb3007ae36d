"""Where a plan leads within the next tenths of a second.

A sequence says where it will be (`Foreseen`). What is commanded beyond that, such as an operator's trim, or all of a
live run, is a hand's doing: what it does next is anybody's guess, and its acceleration is taken to last.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from teleop.core.axes import Axis, Motion, State

Foreseen = Callable[[float], Motion]
"""Where the axes will be at a time of the loop's, if nothing is asked for meanwhile."""


class Outlook(NamedTuple):
    """One axis from `time` (s) on: what is foreseen of it, and the state (`rest`) that it has beside that."""

    axis: Axis
    time: float
    rest: State
    foreseen: Foreseen | None

    def at(self, ahead: float) -> State:
        """So many s later."""
        position, velocity, acceleration = self.rest
        rest = State(
            position + ahead * (velocity + ahead * acceleration / 2), velocity + ahead * acceleration, acceleration
        )
        if self.foreseen is None:
            return rest
        return State(*(a + b for a, b in zip(rest, self.foreseen(self.time + ahead)[self.axis], strict=True)))


def outlook(axis: Axis, time: float, state: State, foreseen: Foreseen | None) -> Outlook:
    """From a state that is commanded at `time`."""
    if foreseen is None or axis not in (planned := foreseen(time)):
        return Outlook(axis, time, state, None)
    return Outlook(axis, time, State(*(a - b for a, b in zip(state, planned[axis], strict=True))), foreseen)

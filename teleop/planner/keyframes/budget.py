"""How much work a refusal is worth: so much that it costs about as much as a plan of the same size.

Work is counted, not timed, so that the same file has the same findings on every machine.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

from teleop.core.axes import Axis
from teleop.planner.keyframes.keys import Key, Waypoint

CALL = 16  # pieces: what the call of a solver costs beside those that it solves
PIECES = 2, 8  # of an interval, by the planner's coarsest and finest rule
ROUNDS = 8  # programs of the coarsest size that a search for times takes, each twice as costly as a plan's
SMALL = 6000  # pieces: about half a second, which every refusal may take


@dataclass
class Budget:
    """Pieces that may still be solved; `spent` once something was not."""

    left: float
    spent: bool = False

    @classmethod
    def of(cls, keys: Mapping[Axis, Sequence[Key]], refused: Iterable[Sequence[Waypoint]]) -> Budget:
        """For these legs of these keys: all that it takes, or, where that is much, as much as a plan takes."""
        planned = sum(PIECES[0] * len(of_axis) + CALL for of_axis in keys.values())
        search = sum(2 * ROUNDS * searching(len(points) - 1) for points in refused if len(points) > 2)
        return cls(4 * SMALL) if search < SMALL else cls(planned)

    def take(self, pieces: float) -> bool:
        """Whether there is enough left; then it is taken."""
        if pieces > self.left:
            self.spent = True
            return False
        self.left -= pieces
        return True


def searching(intervals: int) -> int:
    """What one program of a search for the times of so many intervals costs."""
    return PIECES[1] * intervals + CALL

"""How much work a refusal is worth: so much that it costs about as much as a plan of the same size.

Work is counted, not timed, so that the same file has the same findings on every machine.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from teleop.core.axes import Limits
from teleop.planner.keyframes.bounds import is_beyond
from teleop.planner.keyframes.legs import Points, durations, segment_of, shortened
from teleop.planner.keyframes.windows import WHOLE, windows

CALL = 16  # pieces: what the call of a solver costs beside those that it solves
PIECES = 2, 8  # of an interval, by the planner's coarsest and finest rule
ROUNDS = 8  # programs of the finest size that a search for times takes, each a linear one twice as costly as a plan's
RULES = 5  # of the planner, the finest of them twice as costly as the mean
SINGLE = 2 * ROUNDS * (PIECES[1] + CALL)  # of a search for the time of one way from rest to rest
SMALL = 4500  # pieces: about half a second, which any refusal may take
PLANS, LEFT = 3, 1.5  # plans that a refusal may cost, and what is left of them where rules were tried in vain
ROOM = 3  # times what a search should take, for what has to be tried again


@dataclass
class Budget:
    """Pieces that may still be solved."""

    left: float

    @classmethod
    def of(cls, planned: Iterable[Points], refused: Iterable[tuple[Points, Limits]]) -> Budget:
        """For legs that were refused among all `planned`: what it takes, or where that is much, two plans of all.

        A long leg that the bounds refuse has cost nothing yet, another one more than a plan.
        """
        plan = sum(PIECES[0] * (len(points) - 1) + CALL for points in planned)
        through, single, long, spent = 0, set[object](), False, False
        for points, limits in refused:
            if len(shortened(points)[0]) > WHOLE + 1:
                long, spent = True, spent or not is_beyond(segment_of(points), limits)
            if len(points) == 2:
                single.add((round(abs(points[1].position - points[0].position), 9), round(durations(points)[0], 9)))
            else:
                through += sum(searching(b - a) for a, b in windows(shortened(points)[0], limits))
        if long:
            return cls((LEFT if spent else PLANS) * plan)
        return cls(ROOM * SMALL if through + SINGLE * len(single) < SMALL else 2 * plan)

    def take(self, pieces: float) -> bool:
        """Whether there is enough left; then it is taken."""
        if pieces > self.left:
            return False
        self.left -= pieces
        return True


def trying(intervals: int) -> int:
    """What it takes to try all the planner's rules on so many intervals."""
    fine = min(intervals, WHOLE)
    return PIECES[0] * (intervals - fine) + RULES * (PIECES[1] * fine + CALL) // 2


def searching(intervals: int) -> int:
    """What a search for the times of so many intervals takes."""
    return ROUNDS * (PIECES[1] * intervals + CALL)

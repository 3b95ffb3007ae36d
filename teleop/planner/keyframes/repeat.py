"""Loop and bounce, as keys: the repeated move is planned like any other, so its turns are no special case.

A turn is a key that is passed through: in a loop at the velocity of the way on, in a bounce at velocity 0 but without
pausing there, as the acceleration that ends one pass begins the next. Only a key that says `stop` or holds is a rest.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace
from enum import StrEnum
from math import remainder

from teleop.core.axes import Axis
from teleop.core.timing import SAME_TIME
from teleop.planner.keyframes.findings import PlanError
from teleop.planner.keyframes.planner import Key

TURN = 360.0  # deg
SAME_PLACE = 1e-6  # deg, of whole turns


class Repeat(StrEnum):
    """What follows the last key: the first one again, or the way back."""

    LOOP = "loop"
    BOUNCE = "bounce"


def repeated(
    keys: Mapping[Axis, Sequence[Key]], times: int, mode: Repeat, endless: Collection[Axis] = ()
) -> dict[Axis, list[Key]]:
    """The keys of `times` passes; a bounce counts the way there and the way back as two.

    A loop may end whole turns from where it began on the axes that are `endless`, and goes on from there. Raises
    PlanError for a loop of an axis that does not end where it began.
    """
    start = min(of_axis[0].at for of_axis in keys.values())
    end = max(of_axis[-1].at + of_axis[-1].hold for of_axis in keys.values())
    result = {}
    for axis, of_axis in keys.items():
        first, last = of_axis[0], of_axis[-1]
        advance = last.position - first.position if mode is Repeat.LOOP else 0.0
        if advance and (axis not in endless or abs(remainder(advance, TURN)) > SAME_PLACE):
            raise PlanError(
                f"{axis}, {last.where}: a loop must end where it began,"
                f" at {first.position:.6g}, not {last.position:.6g}"
            )
        passes = [
            _reversed(of_axis, start, end)
            if mode is Repeat.BOUNCE and number % 2
            else [replace(key, position=key.position + number * advance) for key in of_axis]
            for number in range(times)
        ]
        result[axis] = _joined(passes, end - start)
    return result


def _reversed(keys: Sequence[Key], start: float, end: float) -> list[Key]:
    return [
        replace(key, at=start + end - key.at - key.hold, arrive=key.leave, leave=key.arrive) for key in reversed(keys)
    ]


def _joined(passes: Sequence[Sequence[Key]], period: float) -> list[Key]:
    """The passes one after the other, with the two keys of a turn made one."""
    joined: list[Key] = []
    for number, keys in enumerate(passes):
        shifted = [replace(key, at=key.at + number * period) for key in keys]
        if joined and shifted[0].at <= joined[-1].at + joined[-1].hold + SAME_TIME:
            turn, again = joined.pop(), shifted.pop(0)
            joined.append(replace(turn, stop=turn.stop or again.stop, hold=turn.hold + again.hold, leave=again.leave))
        joined += shifted
    return joined

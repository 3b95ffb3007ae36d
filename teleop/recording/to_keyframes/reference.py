"""What keyframes are fitted to: where an axis was at every hundredth of a second, and where it rested.

Rests are found in what was commanded, where they are exact, also when the fit is to what was measured, which never
quite rests.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from teleop.config.documents.document import UnplayableError
from teleop.core.axes import Axis, Limits
from teleop.planner.polynomial import Array
from teleop.recording.reader import Take
from teleop.recording.replay import lead, recorded_move
from teleop.recording.to_keyframes.knots import knots
from teleop.recording.to_keyframes.rests import Span, aligned, even_ways, rests

GRID = 100  # places in a second: the loop's, and fine enough to be edited
GENTLER = 0.8  # of the limits: the stop that a take without an end is given must leave room for a planner
INSET = 3  # places from the ends of an even way to its corners: room for a planner with less than all of the limits


@dataclass(frozen=True, eq=False)
class Reference:
    """`positions` (n,) in units at every place of the grid; it begins and ends with a rest.

    `even` are the ways made at one speed, `knots` where the jerk jumps.
    """

    positions: Array
    rests: Sequence[Span]
    even: Sequence[Span]
    knots: Sequence[int] = ()

    def slackened(self, places: int) -> Reference:
        """With rests that are shorter by so many places where they can be: more time for the ramps between them."""
        last = len(self.positions) - 1
        shorter = [
            Span(rest.begin + places * (rest.begin > 0), rest.end - places * (rest.end < last))
            if rest.end - rest.begin > 3 * places
            else rest
            for rest in self.rests
        ]
        return replace(self, rests=shorter)

    def corners(self, begin: int, end: int) -> Sequence[int]:
        """The places between two where the speed ceases to be even, or begins to be."""
        found = []
        for way in self.even:
            whole = way.end - way.begin >= 3 * INSET
            found += [way.begin + INSET, way.end - INSET] if whole else [(way.begin + way.end) // 2]
        return [place for place in found if begin < place < end]


def references(take: Take, speed: float = 1.0, *, measured: bool = False) -> Mapping[Axis, Reference]:
    """Every axis of a take, played at `speed`; `measured`: where it was, else where it was commanded to be.

    Raises UnplayableError for an empty take, and for axes of which nothing was measured.
    """
    if not len(take.times):
        raise UnplayableError([f"{take.path}: is empty: the run ended before its first tick"])
    silent = [axis.value for axis in take.axes if not take.measured.get(axis, np.empty((2, 0))).size]
    if measured and silent:
        raise UnplayableError([f"{take.path}: {', '.join(silent)} was never measured; leave out --measured"])
    limits = {axis: of_axis.scaled(GENTLER) for axis, of_axis in take.about.limits.items()}
    move = recorded_move(take, limits)
    places = int(np.ceil(move.duration / speed * GRID - 1e-6)) + 1
    times = np.arange(places) / GRID * speed
    sampled = move.sample(times)
    still = aligned({axis: rests(rows[1], rows[2]) for axis, rows in sampled.items()})
    found = {}
    for axis, (position, velocity, acceleration, _) in sampled.items():
        positions = np.interp(times - lead(take), *take.measured[axis]) if measured else position
        found[axis] = Reference(positions, still[axis], even_ways(velocity, acceleration), knots(acceleration))
    return found


def too_fast(reference: Reference, limits: Limits, share: float, allowed: float) -> tuple[float, float] | None:
    """When (s), and how much (units), an axis gets ahead of all that `share` of its velocity can follow.

    None where it never gets ahead by more than twice what is `allowed`: late at the one end, early at the other.
    """
    places = np.arange(len(reference.positions)) / GRID
    for way in (1.0, -1.0):
        gained = way * reference.positions - share * limits.velocity * places
        ahead = gained - np.minimum.accumulate(gained)
        if ahead.max() > 2 * allowed:
            return float(places[ahead.argmax()]), float(ahead.max())
    return None
